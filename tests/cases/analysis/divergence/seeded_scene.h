// Scenes by number: bodies that fall onto the ground, and beside them a driven chain on hinges.
#pragma once

#include <cmath>
#include <random>

#include "tests/scenes.h"

namespace rigor::test {

// The same numbers with every library.
class SeededNumbers {
 public:
  explicit SeededNumbers(unsigned seed) : random_(seed) {}
  double between(double from, double to) { return from + (to - from) * static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t count) { return random_() % count; }
  bool coin() { return random_() % 2 == 0; }

 private:
  std::mt19937_64 random_;
};

inline Body seeded_body(SeededNumbers& n, int number) {
  const double mass = n.between(0.5, 2.5);
  Body out = body("body-" + std::to_string(number), mass, Vec3::Ones());
  const std::size_t kind = n.below(3);
  const Vec3 size(n.between(0.2, 0.4), n.between(0.2, 0.4), n.between(0.2, 0.4));
  out.shape = kind == 0   ? Shape(Box{size})
              : kind == 1 ? Shape(Sphere{size.x() / 2})
                          : Shape(Capsule{size.x() / 3, size.z()});
  out.inertia = mass * Mat3(Vec3(0.012, 0.015, 0.009 + 0.03 * size.y() * size.y()).asDiagonal());
  out.collides = true;
  out.position = {1.5 * number, 0, n.between(0.45, 0.85)};
  out.velocity = {n.between(-1, 1), n.between(-1, 1), n.between(-1, 0)};
  out.angular_velocity = {n.between(-3, 3), n.between(-3, 3), n.between(-3, 3)};
  return out;
}

// Links on hinges, from (-1.5, -2, 4) down. The second hinge may have limits.
inline void add_seeded_chain(SeededNumbers& n, Scene& scene) {
  Vec3 anchor(-1.5, -2, 4);
  double angle = n.between(-0.8, 0.8);
  int above = kWorld;
  for (std::size_t i = 0, links = 2 + n.below(2); i < links; ++i) {
    const double length = n.between(0.3, 0.6);
    const Vec3 along(std::sin(angle), 0, -std::cos(angle));
    Body link =
        body("link-" + std::to_string(i), n.between(0.5, 1.5), {0.02, 0.025, 0.015}, anchor + length / 2 * along);
    link.orientation = rotation_by(Vec3(0, -angle, 0));
    const int own = static_cast<int>(scene.bodies.size());
    scene.bodies.push_back(link);
    scene.joints.push_back({above, own, HingeJoint{anchor, Vec3::UnitY()}, "hinge-" + std::to_string(i)});
    if (i == 1 && n.coin())
      scene.joints.back().lower = -n.between(0.3, 1.3), scene.joints.back().upper = n.between(0.3, 1.3);
    above = own, anchor += length * along, angle += n.between(-0.5, 0.5);
  }
}

inline Scene seeded_scene(unsigned seed) {
  SeededNumbers n(seed);
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0, bodies = 2 + static_cast<int>(n.below(3)); i < bodies; ++i) scene.bodies.push_back(seeded_body(n, i));
  Body ground;
  ground.name = "ground", ground.shape = Plane{Vec3::UnitZ(), 0}, ground.fixed = ground.collides = true;
  scene.bodies.push_back(ground);
  add_seeded_chain(n, scene);
  Motor motor;
  motor.joint = static_cast<int>(n.below(scene.joints.size()));
  if (n.coin()) {
    motor.effort = n.between(-2, 2), motor.from = n.between(0, 0.3);
  } else {
    motor.servo = Servo{TimeTable::constant(n.between(-0.5, 0.5)), n.between(5, 25), n.between(0.2, 1.2)};
    motor.servo->most = n.between(2, 7);
  }
  scene.motors = {motor};
  scene.contact_default = {0, n.between(0.2, 0.8)};
  return scene;
}

}  // namespace rigor::test
