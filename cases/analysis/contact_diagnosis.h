// Finds errors of contacts: restitution that does not converge, overlap returned as speed, friction that depends on the
// direction.
#pragma once

#include "cases/analysis/diagnosis.h"

namespace rigor {

// Bounces that do not improve at finer steps. The value is the largest error at a finer step.
inline constexpr const char* kUnconverged = "restitution";
// Speed after an impact that should leave none. The value is its share of the approach speed.
inline constexpr const char* kOverlapGivenBack = "overlap";
// Bodies that should all stop after the same distance do not. The value is the relative difference.
inline constexpr const char* kFrictionDirections = "friction";

// One run and one topic in each, sorted by run.
std::vector<Diagnosis> contact_diagnoses(const CaseResult& result);

}  // namespace rigor
