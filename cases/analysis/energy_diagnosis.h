// Energy that is lost or gained without a cause, and energy that only seems to change.
#pragma once

#include "cases/analysis/diagnosis.h"

namespace rigor {

// It falls or rises: the value is by what share of the largest kinetic energy, with its sign; `beside` that of the
// scheme alone, repeated by a twin, or not a number; the cause kGyroscopicTerm where the scheme without it keeps it.
inline constexpr const char* kEnergyDrifts = "energy";
inline constexpr const char* kGyroscopicTerm = "gyroscopic term";
// The energy is conserved, but velocities are read a part of a step away from positions. The value is the apparent
// drift; `beside` is the drift with both at one instant.
inline constexpr const char* kEnergyMisread = "sampling";

// Of a case's runs at a step; in the order of its cells.
std::vector<Diagnosis> energy_diagnoses(const CaseResult& result, const StepSize& dt);

// A metric with the sign of found minus expected; NaN where it does not apply.
double signed_value(const std::map<std::string, MetricValue>& metrics, const std::string& name);

}  // namespace rigor
