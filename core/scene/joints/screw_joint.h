#pragma once

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

// Neither springs and dampers nor limits and motors act on it.
struct ScrewJoint {
  Vec3 anchor;       // m, in W at t = 0: a point of the axis
  Vec3 axis;         // unit, in W at t = 0
  double pitch = 0;  // m per turn, not 0; below 0 the thread is left-handed

  static constexpr JointDescriptor<ScrewJoint> descriptor() {
    return {
        "screw",
        "b moves along the axis by the pitch with each turn about it.",
        {{{"anchor", JointVector::point, &ScrewJoint::anchor}, {"axis", JointVector::direction, &ScrewJoint::axis}}},
        {},
        FreeCoordinate::none,
        {"pitch", &ScrewJoint::pitch}};
  }
};

}  // namespace rigor::inline scene
