#pragma once

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

// It has three free coordinates: neither springs and dampers nor limits and motors act on it.
struct PlanarJoint {
  Vec3 anchor;  // m, in W at t = 0: a point of b that stays in the plane
  Vec3 normal;  // unit, in W at t = 0; fixed in a

  static constexpr JointDescriptor<PlanarJoint> descriptor() {
    return {"planar",
            "b slides in a plane of a and turns about the plane's normal.",
            {{{"anchor", JointVector::point, &PlanarJoint::anchor},
              {"normal", JointVector::direction, &PlanarJoint::normal}}},
            Lock::shift_z | Lock::tilt};
  }
};

}  // namespace rigor::inline scene
