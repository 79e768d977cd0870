#pragma once

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

struct SliderJoint {
  Vec3 axis;  // unit, in W at t = 0

  static constexpr JointDescriptor<SliderJoint> descriptor() {
    return {"slider",
            "b does not turn relative to a, and its centre moves along an axis that is fixed in a.",
            {{{"axis", JointVector::direction, &SliderJoint::axis}}},
            Lock::across | Lock::turns,
            FreeCoordinate::displacement};
  }
};

}  // namespace rigor::inline scene
