// A scene changed in one place after another: bodies, springs, forces, joints, contacts and what is around.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/joint_rates.h"
#include "core/scene/validate.h"
#include "tests/scenes.h"

namespace rigor::test {

struct Change {
  std::string what;
  std::function<void(Scene&)> make;
};

template <class Row>
inline void each_of(std::vector<Change>& changes, std::vector<Row> Scene::*rows, const Scene& scene,
                    const std::string& what, const std::function<void(Row&)>& make) {
  for (std::size_t i = 0; i < std::min<std::size_t>((scene.*rows).size(), 2); ++i)
    changes.push_back({what + " of row " + std::to_string(i), [=](Scene& s) { make((s.*rows)[i]); }});
}

inline void change_bodies(std::vector<Change>& changes, const Scene& scene) {
  const auto body = [&](const char* what, const std::function<void(Body&)>& make) {
    each_of<Body>(changes, &Scene::bodies, scene, what, make);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 unit = Vec3::Unit(axis);
    body("place", [=](Body& b) { b.position += 0.05 * unit; });
    body("velocity", [=](Body& b) { b.velocity += 0.3 * unit; });
    body("velocity, backwards", [=](Body& b) { b.velocity -= 0.3 * unit; });
    body("turning", [=](Body& b) { b.angular_velocity += 0.7 * unit; });
    body("orientation", [=](Body& b) { b.orientation = rotation_by(0.2 * unit) * b.orientation; });
    body("moment", [=](Body& b) { b.inertia(axis, axis) *= 1.3; });
    body("product of inertia", [=](Body& b) {
      const int next = (axis + 1) % 3;
      b.inertia(axis, next) += 0.1 * b.inertia(axis, axis), b.inertia(next, axis) = b.inertia(axis, next);
    });
  }
  body("velocity, at all", [](Body& b) { b.velocity.setZero(); });
  body("turning, at all", [](Body& b) { b.angular_velocity.setZero(); });
  body("mass", [](Body& b) { b.mass *= 2; });
  body("being fixed", [](Body& b) { b.fixed = !b.fixed; });
  body("collisions", [](Body& b) { b.collides = !b.collides && b.shape; });
  body("shape, a ball", [](Body& b) { b.shape = Sphere{0.2}; });
  body("shape, a box", [](Body& b) { b.shape = Box{{0.2, 0.3, 0.4}}; });
  changes.push_back({"another body", [](Scene& s) {
                       Body other = s.bodies[0];
                       other.name = "another", other.position += Vec3(20, 30, 40), other.fixed = false;
                       other.shape.reset(), other.collides = false, other.angular_velocity = {1, 2, 3};
                       s.bodies.push_back(other);
                     }});
  changes.push_back({"another ball that collides", [](Scene& s) {
                       Body other = test::body("another", 1, {1, 2, 3}, s.bodies[0].position + Vec3(3, 0.1, 0.2));
                       other.shape = Sphere{0.3}, other.collides = true, other.velocity = {-9, 0, 0};
                       s.bodies.push_back(other);
                     }});
}

inline void change_springs_and_forces(std::vector<Change>& changes, const Scene& scene) {
  const auto spring = [&](const char* what, const std::function<void(Spring&)>& make) {
    each_of<Spring>(changes, &Scene::springs, scene, what, make);
  };
  spring("stiffness", [](Spring& s) { s.stiffness *= 1.5; });
  spring("stiffness, at all", [](Spring& s) { s.stiffness = 0; });
  spring("stiffness that grows", [](Spring& s) { s.quadratic_stiffness = s.stiffness; });
  spring("damping", [](Spring& s) { s.damping += 0.5; });
  spring("damping, at all", [](Spring& s) { s.damping = 0; });
  spring("rest length", [](Spring& s) { s.rest_length += 0.1; });
  spring("a's point", [](Spring& s) { s.point_a += Vec3(0.03, 0.04, 0.05); });
  spring("b's point", [](Spring& s) { s.point_b += Vec3(0.03, 0.04, 0.05); });
  if (!scene.springs.empty()) changes.push_back({"no spring", [](Scene& s) { s.springs.clear(); }});
  changes.push_back({"another spring", [](Scene& s) {
                       s.springs.push_back(test::spring(kWorld, {1, 2, 3}, 0, Vec3::Zero(), 20, 1));
                     }});
  const auto force = [&](const char* what, const std::function<void(TimedForce&)>& make) {
    each_of<TimedForce>(changes, &Scene::forces, scene, what, make);
  };
  force("force", [](TimedForce& f) { f.force += Vec3(1, 2, 3); });
  force("torque", [](TimedForce& f) { f.torque += Vec3(1, 2, 3); });
  force("torque, twice", [](TimedForce& f) { f.torque *= 2; });
  force("point", [](TimedForce& f) { f.point += Vec3(0.1, 0.2, 0.3); });
  force("start", [](TimedForce& f) { f.from += 0.2; });
  force("end", [](TimedForce& f) { f.until = f.from + 0.3; });
  if (!scene.forces.empty()) changes.push_back({"no force", [](Scene& s) { s.forces.clear(); }});
  changes.push_back({"a force more", [](Scene& s) { s.forces.insert(s.forces.begin(), {0, {1, 2, 3}}); }});
  changes.push_back({"a torque more", [](Scene& s) {
                       s.forces.insert(s.forces.begin(), {0, Vec3::Zero(), {1, 2, 3}});
                     }});
  changes.push_back({"a force of nothing more", [](Scene& s) { s.forces.insert(s.forces.begin(), {0}); }});
  changes.push_back({"gravity, at all", [](Scene& s) { s.gravity.setZero(); }});
  changes.push_back({"gravity, twice", [](Scene& s) { s.gravity *= 2; }});
  changes.push_back({"gravity, backwards", [](Scene& s) { s.gravity = -s.gravity; }});
  changes.push_back({"gravity, aslant", [](Scene& s) { s.gravity += Vec3(1, 2, 3); }});
}

inline void change_joints(std::vector<Change>& changes, const Scene& scene) {
  if (scene.joints.empty()) {
    changes.push_back({"a joint", [](Scene& s) {
                         s.joints.push_back({kWorld, 0, BallJoint{s.bodies[0].position + Vec3(0.1, 0.2, 0.3)}});
                       }});
    return;
  }
  const auto joint = [&](const char* what, const std::function<void(Joint&)>& make) {
    each_of<Joint>(changes, &Scene::joints, scene, what, make);
  };
  joint("stiffness", [](Joint& j) { j.stiffness += 3; });
  joint("stiffness, at all", [](Joint& j) { j.stiffness = 0; });
  joint("stiffness that grows", [](Joint& j) { j.stiffness += 3, j.quadratic_stiffness = 2; });
  joint("damping", [](Joint& j) { j.damping += 0.3; });
  joint("damping, at all", [](Joint& j) { j.damping = 0; });
  joint("rest", [](Joint& j) { j.rest += 0.3; });
  joint("limits", [](Joint& j) { j.lower = -0.02, j.upper = 0.02, j.restitution = 0.5; });
  joint("limits, at all", [](Joint& j) { j.lower = -1e9, j.upper = 1e9; });
  joint("bodies, the other way round", [](Joint& j) { std::swap(j.a, j.b); });
  joint("axis", [](Joint& j) {
    if (auto* hinge = std::get_if<HingeJoint>(&j.type)) hinge->axis = (hinge->axis + Vec3(0.1, 0.2, 0.3)).normalized();
    if (auto* slider = std::get_if<SliderJoint>(&j.type))
      slider->axis = (slider->axis + Vec3(0.1, 0.2, 0.3)).normalized();
  });
  joint("anchor", [](Joint& j) {
    if (auto* hinge = std::get_if<HingeJoint>(&j.type)) hinge->anchor += Vec3(0.1, 0.2, 0.3);
    if (auto* ball = std::get_if<BallJoint>(&j.type)) ball->anchor += Vec3(0.1, 0.2, 0.3);
  });
  joint("type, fixed", [](Joint& j) { j.type = FixedJoint{}, j.stiffness = j.damping = j.rest = 0; });
  joint("type, ball", [](Joint& j) {
    if (const auto* hinge = std::get_if<HingeJoint>(&j.type)) j.type = BallJoint{hinge->anchor};
  });
  changes.push_back({"a joint less", [](Scene& s) { s.joints.pop_back(); }});
  changes.push_back({"a joint more", [](Scene& s) { s.joints.push_back(s.joints.front()); }});
  changes.push_back({"another ball joint", [](Scene& s) {
                       s.joints.push_back({kWorld, static_cast<int>(s.bodies.size()) - 1,
                                           BallJoint{s.bodies.back().position + Vec3(0.1, 0.2, 0.3)}});
                     }});
  changes.push_back(
      {"a motor more", [](Scene& s) { s.motors.emplace_back().joint = 0, s.motors.back().effort = 1.5; }});
}

inline void change_contacts(std::vector<Change>& changes, const Scene& scene) {
  const bool touches = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return b.collides; });
  if (!touches) return;
  for (const double friction : {0.0, 0.05, 0.3, 3.0, kInfiniteFriction}) {
    changes.push_back({fmt::format("friction {}", friction), [=](Scene& s) {
                         s.contact_default.friction = friction;
                         for (ContactPair& pair : s.contact_pairs) pair.law.friction = friction;
                       }});
  }
  for (const double restitution : {0.0, 0.4, 1.0}) {
    changes.push_back({fmt::format("restitution {}", restitution), [=](Scene& s) {
                         s.contact_default.restitution = restitution;
                         for (ContactPair& pair : s.contact_pairs) pair.law.restitution = restitution;
                       }});
  }
  changes.push_back({"another plane", [](Scene& s) {
                       Body wall;
                       wall.name = "wall", wall.fixed = wall.collides = true;
                       wall.shape = Plane{-Vec3::UnitX(), -s.bodies[0].position.x() - 0.7};
                       s.bodies.push_back(wall);
                     }});
}

// The same scene elsewhere, and turned.
inline void place_elsewhere(Scene& scene, const Quat& turn, const Vec3& by) {
  const auto put = [&](Vec3& point) { point = turn * point + by; };
  const auto turned = [&](Vec3& v) { v = turn * v; };
  turned(scene.gravity);
  for (Body& body : scene.bodies) {
    put(body.position), turned(body.velocity), turned(body.angular_velocity);
    body.orientation = (turn * body.orientation).normalized();
    auto* plane = body.shape ? std::get_if<Plane>(&*body.shape) : nullptr;
    if (plane) turned(plane->normal), plane->normal.normalize(), plane->offset += plane->normal.dot(by);
  }
  for (Spring& spring : scene.springs) {
    if (spring.a == kWorld) put(spring.point_a);
    if (spring.b == kWorld) put(spring.point_b);
  }
  for (Joint& joint : scene.joints) {
    if (auto* ball = std::get_if<BallJoint>(&joint.type)) put(ball->anchor);
    if (auto* hinge = std::get_if<HingeJoint>(&joint.type)) put(hinge->anchor), turned(hinge->axis);
    if (auto* slider = std::get_if<SliderJoint>(&joint.type)) turned(slider->axis);
    if (auto* cross = std::get_if<UniversalJoint>(&joint.type))
      put(cross->anchor), turned(cross->axis), turned(cross->axis2);
    if (auto* rod = std::get_if<DistanceJoint>(&joint.type)) {
      if (joint.a == kWorld) put(rod->point_a);
      if (joint.b == kWorld) put(rod->point_b);
    }
  }
  for (TimedForce& force : scene.forces) turned(force.force), turned(force.torque);
}

inline void change_place(std::vector<Change>& changes) {
  const Vec3 away(0.75, -1.25, 0.5);
  changes.push_back({"being elsewhere", [=](Scene& s) { place_elsewhere(s, Quat::Identity(), away); }});
  const Quat quarter(std::sqrt(0.5), 0, std::sqrt(0.5), 0);
  changes.push_back({"being turned", [=](Scene& s) { place_elsewhere(s, quarter, Vec3::Zero()); }});
  changes.push_back(
      {"being elsewhere and aslant", [=](Scene& s) { place_elsewhere(s, rotation_by(Vec3(0.3, 0.5, 0.7)), away); }});
}

inline std::vector<Change> changes_of(const Scene& scene) {
  std::vector<Change> changes = {{"nothing", [](Scene&) {}}};
  change_bodies(changes, scene), change_springs_and_forces(changes, scene);
  change_joints(changes, scene), change_contacts(changes, scene), change_place(changes);
  return changes;
}

inline bool is_a_scene(const Scene& scene) {
  try {
    validate(scene);
  } catch (const InputError&) {
    return false;
  }
  return std::all_of(scene.joints.begin(), scene.joints.end(),
                     [&](const Joint& joint) { return why_rates_break(scene, joint).empty(); });
}

}  // namespace rigor::test
