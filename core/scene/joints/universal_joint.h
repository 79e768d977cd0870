#pragma once

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

struct UniversalJoint {
  Vec3 anchor;  // m, in W at t = 0
  Vec3 axis;    // unit, in W at t = 0
  Vec3 axis2;   // unit, in W at t = 0

  static constexpr JointDescriptor<UniversalJoint> descriptor() {
    return {"universal",
            "The bodies share one point; axis is fixed in a, axis2 in b, and they stay at right angles.",
            {{{"anchor", JointVector::point, &UniversalJoint::anchor},
              {"axis", JointVector::direction, &UniversalJoint::axis},
              {"axis2", JointVector::direction, &UniversalJoint::axis2}}}};
  }

  // axis2 without its part along axis: exactly at right angles.
  Vec3 square_axis2() const { return (axis2 - axis2.dot(axis) * axis).normalized(); }
};

}  // namespace rigor::inline scene
