// How far a body is from a pose of the truth, and how fast that changes as the truth is taken at a later instant.
#pragma once

#include "core/engine/body_table.h"

namespace rigor::inline metric {

struct PoseGap {
  Vec3 position;     // m, found - truth, in W
  Vec3 orientation;  // rad: 2 vec(q_truth⁻¹ q_found), in the truth's B; 2 sin(angle/2) long, so smooth at any angle
  Vec3 position_rate;     // m/s: -v
  Vec3 orientation_rate;  // rad/s: with d = q_truth⁻¹ q_found, d' = -½ w_B d for a truth that turns at w_B
};

inline PoseGap pose_gap(const BodyState& found, const BodyState& truth) {
  const Quat turn = truth.orientation.conjugate() * found.orientation.normalized();
  const Vec3 w_B = truth.orientation.conjugate() * truth.angular_velocity;
  return {found.position - truth.position, 2 * turn.vec(), -truth.velocity,
          -(turn.w() * w_B + w_B.cross(Vec3(turn.vec())))};
}

}  // namespace rigor::inline metric
