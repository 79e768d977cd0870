// Each kind of joint between bodies of full inertia, in every order of its ends.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::test {

struct JointedScene {
  std::string name;
  Scene scene;
};

enum class Ends { two_bodies, swapped, from_world, to_world };
inline constexpr Ends kAllEnds[] = {Ends::two_bodies, Ends::swapped, Ends::from_world, Ends::to_world};

inline std::string name_of(Ends ends) {
  switch (ends) {
    case Ends::two_bodies:
      return "a to b";
    case Ends::swapped:
      return "b to a";
    case Ends::from_world:
      return "world to b";
    case Ends::to_world:
      return "b to world";
  }
  return "";
}

inline Body lopsided_body(const std::string& name, double mass, const Vec3& position, const Quat& orientation) {
  Body body;
  body.name = name, body.mass = mass, body.position = position, body.orientation = orientation.normalized();
  body.inertia << 0.10, 0.02, -0.01, 0.02, 0.14, 0.015, -0.01, 0.015, 0.12;
  body.inertia *= mass;
  return body;
}

// Bodies at rest, not in line with any axis; b is the last of them.
inline Scene with_joint(const decltype(Joint::type)& type, Ends ends) {
  Scene scene;
  const bool has_a = ends == Ends::two_bodies || ends == Ends::swapped;
  if (has_a) scene.bodies.push_back(lopsided_body("a", 2, {0.1, -0.2, 0.3}, {0.9, 0.1, -0.3, 0.2}));
  scene.bodies.push_back(lopsided_body("b", 1, {0.5, 0.2, -0.1}, {0.7, -0.4, 0.2, 0.5}));
  const int a = has_a ? 0 : kWorld, b = has_a ? 1 : 0;
  const bool b_first = ends == Ends::swapped || ends == Ends::to_world;
  Joint joint{b_first ? b : a, b_first ? a : b, type};
  if (auto* distance = std::get_if<DistanceJoint>(&joint.type); distance && b_first)
    std::swap(distance->point_a, distance->point_b);
  if (auto* universal = std::get_if<UniversalJoint>(&joint.type); universal && b_first)
    std::swap(universal->axis, universal->axis2);
  scene.joints = {joint};
  return scene;
}

// Falling, and turned about by torques that the joint must carry.
inline std::vector<JointedScene> jointed_scenes() {
  const Vec3 anchor(0.3, 0.1, 0.2), axis = Vec3(2, -1, 2) / 3, across = Vec3(1, 2, 0).normalized();
  const std::pair<const char*, decltype(Joint::type)> types[] = {
      {"ball", BallJoint{anchor}},
      {"cylindrical", CylindricalJoint{anchor, axis}},
      {"hinge", HingeJoint{anchor, axis}},
      {"slider", SliderJoint{axis}},
      {"fixed", FixedJoint{}},
      {"distance", DistanceJoint{{0.1, 0.05, -0.1}, {-0.1, 0.1, 0.05}}},
      {"universal", UniversalJoint{anchor, axis, across}}};
  std::vector<JointedScene> scenes;
  for (const auto& [name, type] : types) {
    for (const Ends ends : kAllEnds) {
      Scene scene = with_joint(type, ends);
      scene.gravity = {1, -9, 3};
      const int b = static_cast<int>(scene.bodies.size()) - 1;
      scene.forces = {{.body = b, .force = {1, 2, -1}, .torque = {0.4, -0.3, 0.5}, .point = {0.1, 0, 0.05}}};
      scenes.push_back({std::string(name) + ", " + name_of(ends), scene});
    }
  }
  return scenes;
}

// The largest distance and angle of a body from where the other has it.
inline double pose_difference(const BodyTable& one, const BodyTable& other) {
  double largest = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const BodyState a = one.columns().body(i), b = other.columns().body(i);
    largest = std::max({largest, (a.position - b.position).norm(), angle_between(a.orientation, b.orientation)});
  }
  return largest;
}

}  // namespace rigor::test
