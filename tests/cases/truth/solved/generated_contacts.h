// Generated scenes with contacts for tests of exact symmetries.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "cases/truth/solved/events/equivalent_scene.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

namespace rigor::test {

// One to four spheres, boxes and capsules above a tilted plane, and changes that leave the motion as it is.
class GeneratedContacts {
 public:
  explicit GeneratedContacts(unsigned seed) : random_(seed) {
    scene.gravity = {0, 0, -9.81};
    const int count = 1 + static_cast<int>(4 * share());
    for (int i = 0; i < count; ++i) add_body(i);
    scene.bodies.push_back(plane(Vec3(between(-0.2, 0.2), between(-0.2, 0.2), 1)));
    constexpr double kRestitutions[] = {0, 0, 0.3, 0.6, 0.9, 1}, kFrictions[] = {0, 0.2, 0.5, 0.9};
    scene.contact_default = {kRestitutions[static_cast<int>(6 * share())], kFrictions[static_cast<int>(4 * share())]};
  }

  std::vector<Equivalence> equivalences() {
    Equivalence units, mirrored, turned, reversed;
    units.length = std::pow(10, between(-1, 1)), units.time = 0.3 * std::pow(4 / 0.3, share());
    mirrored.is_mirrored = true, turned.turn = any_turn(), reversed.is_reversed = true;
    return {units, mirrored, turned, reversed};
  }

  Scene scene;

 private:
  double share() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * share(); }
  Vec3 any(double most) { return {between(-most, most), between(-most, most), between(-most, most)}; }
  Quat any_turn() { return Quat(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)).normalized(); }

  void add_body(int i) {
    const double kind = 3 * share();
    Shape shape = Sphere{between(0.1, 0.2)};
    if (kind > 1) shape = Box{{between(0.2, 0.4), between(0.2, 0.4), between(0.2, 0.4)}};
    if (kind > 2) shape = Capsule{between(0.08, 0.15), between(0.1, 0.3)};
    Body made = on_its_own("b" + std::to_string(i), shape, between(0.5, 4), any(0.7));
    made.position.z() = 0.5 + 0.75 * i + between(0, 0.2);
    made.orientation = any_turn();
    made.velocity = any(1.5), made.angular_velocity = any(2.5);
    scene.bodies.push_back(made);
  }

  std::mt19937_64 random_;
};

}  // namespace rigor::test
