#pragma once

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

struct BallJoint {
  Vec3 anchor;  // m, in W at t = 0

  static constexpr JointDescriptor<BallJoint> descriptor() {
    return {
        "ball", "The bodies share one point.", {{{"anchor", JointVector::point, &BallJoint::anchor}}}, Lock::shifts};
  }
};

}  // namespace rigor::inline scene
