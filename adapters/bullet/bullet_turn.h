// How Bullet turns a body, or a ball joint, over a step: the exponential map, but by at most pi/4; a faster one turns
// by a quaternion with the sine and cosine of pi/4, the sine still multiplied by the whole of w.
#pragma once

#include <cmath>
#include <numbers>

#include "core/base/math.h"

namespace rigor::inline adapters::bullet {

inline constexpr double kLargestTurn = std::numbers::pi / 4;  // rad a step

inline Quat turn_of(const Vec3& w, double dt) {
  const double speed = w.norm();
  if (!(speed * dt > kLargestTurn)) return rotation_by(dt * w);
  const Vec3 axis = w * (std::sin(kLargestTurn / 2) * dt / kLargestTurn);
  return {std::cos(kLargestTurn / 2), axis.x(), axis.y(), axis.z()};
}

}  // namespace rigor::inline adapters::bullet
