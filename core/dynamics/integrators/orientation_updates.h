// How the Euler schemes carry an orientation over a step with angular velocity w (in W):
//   matrix-additive         R <- R + dt [w]x R                 the course's first; R leaves the rotations
//   matrix-rodrigues        R <- exp(dt [w]x) R                the course's second, by Rodrigues' formula
//   quaternion-additive     q <- (q + dt/2 (0, w) q) / |...|   the course's third; the angle is 2 atan(|w| dt / 2)
//   quaternion-exponential  q <- exp(dt/2 (0, w)) q            exact for constant w
#pragma once

#include <string>
#include <vector>

#include "core/dynamics/kernels/kernels.h"
#include "core/engine/body_table.h"

namespace rigor::inline dynamics {

struct OrientationUpdate {
  std::string name;
  bool keeps_matrix;  // the state's orientation is R, and the quaternion follows from it
  void (*advance)(MutableBodyColumns state, std::size_t body, const Vec3& w, double dt);
  Turn turn = Turn::exponential;  // its name in the kernels, if it keeps no matrix
};

const std::vector<OrientationUpdate>& orientation_updates();           // alphabetical
const OrientationUpdate& orientation_update(const std::string& name);  // the name must be there

}  // namespace rigor::inline dynamics
