// Two hanging rods with a joint of any kind between them, for the tests of engines with joints in trees.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor {

inline Body rod(const std::string& name, const Vec3& position) {
  Body body;
  body.name = name;
  body.mass = 1.5;
  body.inertia << 0.02, 0.004, -0.003, 0.004, 0.15, 0.002, -0.003, 0.002, 0.14;
  body.position = position;
  body.orientation = Quat(0.9, 0.1, -0.3, 0.2).normalized();
  return body;
}

// Two rods, the first hung from the world by a ball, the second from the first by `joint`, at rest.
inline Scene hung_by(const Joint& joint) {
  Scene scene;
  scene.gravity = {0.5, 0, -9.81};
  scene.bodies = {rod("upper", {0.5, 0, 0}), rod("lower", {1.5, 0.2, 0.1})};
  scene.joints = {{.a = kWorld, .b = 0, .type = BallJoint{{0, 0, 0}}}, joint};
  return scene;
}

// To hang the lower rod by.
inline std::vector<Joint> joints_of_each_kind() {
  const Vec3 anchor(1, 0.1, 0), axis = Vec3(0.2, 1, 0.3).normalized(), across = Vec3(1, -0.2, 0).normalized();
  return {{.type = BallJoint{anchor}},
          {.type = CylindricalJoint{anchor, axis}},
          {.type = HingeJoint{anchor, axis}, .stiffness = 3, .damping = 0.2, .rest = 0.3},
          {.type = SliderJoint{axis}, .stiffness = 40, .damping = 1.5, .rest = -0.1},
          {.type = FixedJoint{}},
          {.type = UniversalJoint{anchor, axis, axis.cross(across).normalized()}}};
}

}  // namespace rigor
