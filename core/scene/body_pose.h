#pragma once

#include "core/base/math.h"

namespace rigor::inline scene {

// Of a body in W, or of a shape in its body's frame B.
struct BodyPose {
  Vec3 position = Vec3::Zero();         // m
  Quat orientation = Quat::Identity();  // its own frame to the outer one
};

}  // namespace rigor::inline scene
