// Generated contact scenes, and exact symmetries of mechanics: relations that turn one scene into another whose motion
// follows from that of the first.
#pragma once

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/scene/turned.h"
#include "tests/core/dynamics/contact/contact_runs.h"

namespace rigor::test {

struct Relation {
  std::string name;
  std::function<Scene(const Scene&)> scene;
  double length = 1, time = 1;                                              // new units per old unit
  std::function<Vec3(const Vec3&)> back = [](const Vec3& x) { return x; };  // vectors of the related scene
  bool reverses_bodies = false;
  bool is_exact = false;  // in doubles: not even a rounding changes
};

// Masses stay; lengths and times are multiplied.
inline Scene in_other_units(Scene scene, double length, double time) {
  scene.gravity *= length / (time * time);
  for (Body& body : scene.bodies) {
    body.position *= length, body.velocity *= length / time, body.angular_velocity /= time;
    body.inertia *= length * length;
    if (auto* sphere = std::get_if<Sphere>(&*body.shape)) sphere->radius *= length;
    if (auto* box = std::get_if<Box>(&*body.shape)) box->size *= length;
    if (auto* capsule = std::get_if<Capsule>(&*body.shape)) capsule->radius *= length, capsule->length *= length;
    if (auto* plane = std::get_if<Plane>(&*body.shape)) plane->offset *= length;
  }
  return scene;
}

// x becomes -x. Boxes and capsules are their own mirror images.
inline Scene mirrored(Scene scene) {
  const auto flip = [](Vec3& polar) { polar.x() = -polar.x(); };
  flip(scene.gravity);
  for (Body& body : scene.bodies) {
    flip(body.position), flip(body.velocity);
    body.angular_velocity.y() = -body.angular_velocity.y(), body.angular_velocity.z() = -body.angular_velocity.z();
    body.orientation.y() = -body.orientation.y(), body.orientation.z() = -body.orientation.z();
    if (auto* plane = std::get_if<Plane>(&*body.shape)) flip(plane->normal);
  }
  return scene;
}

inline Scene with_bodies_reversed(Scene scene) {
  std::reverse(scene.bodies.begin(), scene.bodies.end());
  return scene;
}

inline std::vector<Relation> exact_relations() {
  const auto units = [](const std::string& name, double length, double time) {
    return Relation{name, [=](const Scene& scene) { return in_other_units(scene, length, time); }, length, time};
  };
  Relation lengths = units("lengths x 8", 8, 1), times = units("times x 4", 1, 4);
  lengths.is_exact = times.is_exact = true;
  const Quat turn = Quat(0.2, -0.5, 0.7, 0.4).normalized();
  return {lengths,
          times,
          units("lengths x 0.1", 0.1, 1),
          units("times x 0.3", 1, 0.3),
          units("lengths x 10, times x 2.7", 10, 2.7),
          {"turned", [=](const Scene& scene) { return turned(scene, turn); }, 1, 1,
           [=](const Vec3& x) -> Vec3 { return turn.conjugate() * x; }},
          {"mirrored", mirrored, 1, 1, [](const Vec3& x) { return Vec3(-x.x(), x.y(), x.z()); }},
          {"bodies in reverse order", with_bodies_reversed, 1, 1, [](const Vec3& x) { return x; }, true, true}};
}

// Up to four bodies, one above the other and turned at random, thrown onto an inclined floor.
inline Scene generated_contact_scene(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const auto vector = [&](double most) {
    return Vec3(between(-most, most), between(-most, most), between(-most, most));
  };
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const int count = 1 + static_cast<int>(random() % 4);
  double height = 0;
  for (int i = 0; i < count; ++i) {
    const double size = between(0.1, 0.3);
    Shape shape = Sphere{size};
    if (random() % 3 == 0)
      shape = Box{{2 * size, between(0.1, 0.6), between(0.1, 0.6)}};
    else if (random() % 2 == 0)
      shape = Capsule{0.5 * size, between(0.2, 0.6)};
    Body body = solid("body " + std::to_string(i), shape, {between(-0.1, 0.1), between(-0.1, 0.1), height + 0.5},
                      between(0.5, 4));
    height += 0.8;
    body.orientation = Quat(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)).normalized();
    body.velocity = vector(1), body.angular_velocity = vector(2);
    scene.bodies.push_back(body);
  }
  scene.bodies.push_back(floor_at(Vec3(between(-0.2, 0.2), between(-0.2, 0.2), 1).normalized()));
  const double restitutions[] = {0, 0, 0.3, 0.8}, frictions[] = {0, 0.3, 0.9};
  scene.contact_default = {restitutions[random() % 4], frictions[random() % 3]};
  return scene;
}

// The positions of the bodies after each step, in the units, axes and order of the scene before the relation.
inline std::vector<std::vector<Vec3>> motion_of(const Scene& scene, const Relation& relation, double dt, int steps,
                                                const std::string& integrator = "velocity-verlet") {
  const Scene related = relation.scene(scene);
  ContactRun run(related, "impulse", integrator);
  std::vector<std::vector<Vec3>> motion;
  const std::size_t count = scene.bodies.size();
  for (int step = 0; step < steps; ++step) {
    run.step(dt * relation.time);
    motion.emplace_back();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = relation.reverses_bodies ? count - 1 - i : i;
      motion.back().push_back(relation.back(run.state().position(at)) / relation.length);
    }
  }
  return motion;
}

}  // namespace rigor::test
