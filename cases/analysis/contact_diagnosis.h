// Errors of contacts: restitution that does not converge, overlap returned as speed, friction that depends on the
// direction.
#pragma once

#include "cases/analysis/diagnosis.h"

namespace rigor {

// Bounces that are no better at a finer step; the value is the largest error of a finer one.
inline constexpr const char* kUnconverged = "restitution";
// After an impact that should leave none, a share of the speed that bodies met with: the value.
inline constexpr const char* kOverlapGivenBack = "overlap";
// Bodies that should all stop after the same way do not; the value is by what share of it they differ.
inline constexpr const char* kFrictionDirections = "friction";

// One run and one topic each, by run.
std::vector<Diagnosis> contact_diagnoses(const CaseResult& result);

}  // namespace rigor
