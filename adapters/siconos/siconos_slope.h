// The derivative of a body's loads by its own motion, for Newton's method; the process of Siconos and its scheme
// replica share it. Siconos solves body by body, so the effect of one body's motion on another's load is left out.
#pragma once

#include <vector>

#include "core/dynamics/model/loads/load_jacobian.h"

namespace rigor::inline adapters {

// For each body: derivatives of (force in W, torque in B) by the velocities (v in W, w in B) at the end of a step to
// `t` [s]. The velocities move a body by `reach` [s] times themselves. `wrenches`: the loads there.
void load_slopes(const Loads& loads, BodyColumns state, const Wrenches& wrenches, double t, double reach,
                 std::vector<Mat6>& out);

}  // namespace rigor::inline adapters
