#pragma once

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

struct HingeJoint {
  Vec3 anchor;  // m, in W at t = 0
  Vec3 axis;    // unit, in W at t = 0

  static constexpr JointDescriptor<HingeJoint> descriptor() {
    return {
        "hinge",
        "The bodies share one point and one direction: b turns about the axis.",
        {{{"anchor", JointVector::point, &HingeJoint::anchor}, {"axis", JointVector::direction, &HingeJoint::axis}}},
        Lock::shifts | Lock::tilt,
        FreeCoordinate::angle};
  }
};

}  // namespace rigor::inline scene
