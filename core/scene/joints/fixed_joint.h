#pragma once

#include "core/scene/joints/joint_descriptor.h"

namespace rigor::inline scene {

struct FixedJoint {
  static constexpr JointDescriptor<FixedJoint> descriptor() {
    return {"fixed", "b keeps its pose relative to a.", {}, Lock::shifts | Lock::turns};
  }
};

}  // namespace rigor::inline scene
