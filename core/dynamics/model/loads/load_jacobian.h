// The derivative of each body's wrench from springs and timed forces with respect to each body's pose and velocity.
// Methods that solve for these need it.
#pragma once

#include <functional>

#include "core/dynamics/model/loads/loads.h"

namespace rigor::inline dynamics {

using Mat6 = Eigen::Matrix<double, 6, 6>;

// d wrench(row) / d motion(column). A wrench is (force, torque about the centre of mass), a change of pose
// (displacement [m], small rotation vector in W [rad]), a velocity (v, w); all in W.
struct WrenchDerivative {
  std::size_t row, column;
  Mat6 by_pose, by_velocity;
};

// Calls `visit` with every block that is not zero; the blocks of one pair (row, column) add up. Gravity has none.
void visit_load_jacobian(const Loads& loads, BodyColumns bodies, double t, double dt,
                         const std::function<void(const WrenchDerivative&)>& visit);

}  // namespace rigor::inline dynamics
