#pragma once

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

// It has two free coordinates: neither springs and dampers nor limits and motors act on it.
struct CylindricalJoint {
  Vec3 anchor;  // m, in W at t = 0: a point of the axis
  Vec3 axis;    // unit, in W at t = 0

  static constexpr JointDescriptor<CylindricalJoint> descriptor() {
    return {"cylindrical",
            "The bodies share a line: b slides along the axis and turns about it.",
            {{{"anchor", JointVector::point, &CylindricalJoint::anchor},
              {"axis", JointVector::direction, &CylindricalJoint::axis}}},
            Lock::across | Lock::tilt};
  }
};

}  // namespace rigor::inline scene
