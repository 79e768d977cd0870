// No impact adds energy. Newton's restitution can add it at several points of a mechanism, or with friction (Kane's
// paradox). The velocities then move only part of the way from those without restitution to those with it, (1 - s) V +
// s V', so that the kinetic energy equals that before the impacts.
#pragma once

#include <vector>

#include "core/dynamics/joints/joints.h"
#include "core/dynamics/model/system.h"

namespace rigor::inline dynamics {

// V·M V, twice the kinetic energy [J], of velocities (v, w) by body.
double twice_energy_of(const System& system, BodyColumns pose, const std::vector<Vec6>& velocities);

// Changes the velocities with restitution, at this pose, so that twice their energy is at most `most`. Returns the
// share s of the change that is left.
double limit_energy(const System& system, BodyColumns pose, double most, const std::vector<Vec6>& without,
                    std::vector<Vec6>& with);

}  // namespace rigor::inline dynamics
