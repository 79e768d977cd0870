// Where two features touch, and how that place moves: in closed form, from the motions of the two bodies.
#pragma once

#include "core/dynamics/contact/event/features/contact_features.h"

namespace rigor::inline dynamics {

struct ContactKinematics {
  Vec3 normal = Vec3::UnitX(), point = Vec3::Zero();  // unit, from b to a; m, midway between the surfaces; in W
  double gap = 0;                                     // m
  Vec3 normal_rate = Vec3::Zero(), point_rate = Vec3::Zero();  // 1/s, m/s
};

ContactKinematics contact_kinematics(const FeaturePair& features, const RigidMotion& a, const RigidMotion& b);

}  // namespace rigor::inline dynamics
