// Finds errors of contacts. Of impacts: restitution that does not converge, and overlap returned as speed. Of friction:
// a dependence on the direction, and bodies that creep. Of forces: growth as the step shrinks, a motion that they do
// not explain, and bodies that hover.
#pragma once

#include "cases/analysis/diagnosis.h"

namespace rigor::inline analysis {

// Bounces that do not improve at finer steps. The value is the largest error at a finer step.
inline constexpr const char* kUnconverged = "restitution";
// Speed after an impact that should leave none. The value is its share of the approach speed.
inline constexpr const char* kOverlapGivenBack = "overlap";
// Bodies that should all stop after the same distance do not. The value is the relative difference.
inline constexpr const char* kFrictionDirections = "friction";
// A contact force of bodies at rest that grows as dt shrinks. The value is the largest over the force at rest.
inline constexpr const char* kForceSpikes = "force-spikes";
// A body that should stand moves on to the end of the run. The value is its distance from its place [m].
inline constexpr const char* kCreeps = "creep";
// Bodies press on each other across a gap that falls with dt. The value is the mean gap under load at the coarsest step
// [m].
inline constexpr const char* kHovers = "hover";
// Contact forces that do not explain the motion. The value is what they leave [N], at the finest step.
inline constexpr const char* kForcesMissing = "contact-balance";

// One run and one topic in each, sorted by run.
std::vector<Diagnosis> contact_diagnoses(const CaseResult& result);

}  // namespace rigor::inline analysis
