// What a method of the core makes of a linear oscillator: whether the step size alone explains a blow-up.
#pragma once

#include <optional>
#include <string>

#include "cases/analysis/small_motions/small_motions.h"

namespace rigor::inline analysis {

// The factor by which the energy of the oscillator grows in each step of dt, in the long run. The named run of the core
// steps one body on a spring along its line, a hinge or a slider of that frequency and damping. A one-step method is
// known by the matrix of its step; the growth of another is measured over many steps. At most 1, but for roundings,
// where the method is stable. Nothing for a name that is no run of the core, or for a method without such joints.
std::optional<double> energy_growth(const std::string& core_run, ForceElement::Kind kind, const Oscillator& oscillator,
                                    double dt);

}  // namespace rigor::inline analysis
