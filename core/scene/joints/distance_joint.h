#pragma once

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

struct DistanceJoint {
  Vec3 point_a, point_b;  // m, in the bodies' frames

  static constexpr JointDescriptor<DistanceJoint> descriptor() {
    return {"distance",
            "Two points keep the distance that they have at t = 0.",
            {{{"point_a", JointVector::point_of_a, &DistanceJoint::point_a},
              {"point_b", JointVector::point_of_b, &DistanceJoint::point_b}}}};
  }
};

}  // namespace rigor::inline scene
