// Finds energy that drifts although nothing adds or removes it, and drift that only sampling shows.
#pragma once

#include "cases/analysis/diagnosis.h"

namespace rigor::inline analysis {

// The energy falls or rises. The value is the signed change as a share of the largest kinetic energy. `beside` is the
// change that the scheme alone makes, by a twin, or NaN. The cause is kGyroscopicTerm if the scheme without it keeps
// the energy.
inline constexpr const char* kEnergyDrifts = "energy";
inline constexpr const char* kGyroscopicTerm = "gyroscopic term";
// The energy is kept, but velocities are read a part of a step away from positions. The value is the drift that this
// shows, and `beside` the drift with both at one instant.
inline constexpr const char* kEnergyMisread = "sampling";

// Looks at a case's runs at one step, in the order of its cells.
std::vector<Diagnosis> energy_diagnoses(const CaseResult& result, const StepSize& dt);

// A metric with the sign of the found value less the expected one; NaN if the metric does not apply.
double signed_value(const std::map<std::string, MetricValue>& metrics, const std::string& name);

}  // namespace rigor::inline analysis
