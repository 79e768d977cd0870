// Scenes whose motion has a closed form, each with what its truth is called.
#pragma once

#include <string>
#include <vector>

#include "tests/cases/judged.h"

namespace rigor::test {

struct SmoothScene {
  std::string truth, label;
  Scene scene;
  double duration;  // s
  bool keeps_energy = true;
};

inline Scene free_body(const Mat3& inertia, const Vec3& w_B, const Quat& orientation = Quat::Identity()) {
  Scene scene;
  scene.bodies = {body("top", 2, {1, 1, 1})};
  Body& top = scene.bodies[0];
  top.inertia = inertia;
  top.orientation = orientation.normalized();
  top.angular_velocity = matrix_of(top.orientation) * w_B;
  return scene;
}
inline Scene free_body(const Vec3& moments, const Vec3& w_B, const Quat& orientation = Quat::Identity()) {
  return free_body(Mat3(moments.asDiagonal()), w_B, orientation);
}

inline Scene thrown(Scene scene) {
  scene.gravity = {0.5, -0.25, -9.8};
  scene.bodies[0].position = {1, -2, 30}, scene.bodies[0].velocity = {3, 4, -1};
  return scene;
}

inline const Quat kTilted(0.4, -0.5, 0.6, 0.3);  // some attitude

// The moments about axes that are turned in B.
inline Mat3 turned_inertia(const Vec3& moments) {
  const Mat3 turned = Quat(0.9, 0.3, -0.2, 0.5).normalized().toRotationMatrix();
  const Mat3 inertia = turned * moments.asDiagonal() * turned.transpose();
  return 0.5 * (inertia + inertia.transpose());
}

// 2 kg on a spring of 50 N/m (5 rad/s) along x, its critical damping being 20 N s/m.
inline Scene oscillator(double damping) {
  Scene scene;
  scene.bodies = {body("mass", 2, {0.1, 0.2, 0.3}, {1.5, 0, 0})};
  scene.bodies[0].velocity = {2, 0, 0};
  scene.springs = {spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 50, 1.25, damping)};
  return scene;
}

// Along a line that the rounding of its numbers misses, of velocity and of gravity otherwise; pressed at times, so that
// what is beside the line grows.
inline Scene slanted_oscillator() {
  Scene scene = oscillator(0.5);
  const Vec3 line(0.1, 0.7, 0.3);
  scene.gravity = 3 * line;
  scene.bodies[0].position = 1.9 * line, scene.bodies[0].velocity = -2.3 * line;
  return scene;
}

inline Scene hanging_oscillator(double damping) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body post = body("post", 1, {1, 1, 1}, {1, 1, 3});
  post.fixed = true, post.orientation = Quat(0, 0, 0, 1);
  Body mass = body("mass", 2, {0.1, 0.2, 0.3}, {0.5, 1, 1});
  mass.angular_velocity = {0, 0, 4};
  scene.bodies = {post, mass};
  // After half a turn about z the hook of the post is 2 m above the mass.
  scene.springs = {spring(1, {0, 0, 0}, 0, {0.5, 0, 0}, 50, 1, damping)};
  return scene;
}

inline Scene spring_of_no_length() {
  Scene scene = oscillator(0.5);
  scene.springs[0].rest_length = 0;
  return scene;
}

inline Scene torqued() {
  Scene scene = thrown(free_body(Vec3(1, 2, 3), {0, 0, 1.5}));
  TimedForce push;
  push.body = 0, push.torque = {0, 0, 6}, push.from = 0.4, push.until = 1.7;
  scene.forces = {push};
  push.torque = {0, 0, -9}, push.from = 1.1, push.until = 3.3;
  scene.forces.push_back(push);
  return scene;
}

inline Scene torqued_from_rest() {
  Scene scene = free_body(turned_inertia({2, 2, 2}), {0, 0, 0}, kTilted);
  TimedForce push;
  push.body = 0, push.torque = {1, -2, 3};
  scene.forces = {push};
  return scene;
}

// The box of Peters and Hsu (2014), 10 kg, .1 x .4 x .9 m.
inline Vec3 box_moments() {
  const double a = 0.1, b = 0.4, c = 0.9;
  return 10.0 / 12 * Vec3(b * b + c * c, a * a + c * c, a * a + b * b);
}
inline Scene dzhanibekov_box() {
  Scene scene;
  scene.gravity = {0, 0, -9.8};
  scene.bodies = {body("box", 10, box_moments())};
  scene.bodies[0].velocity = {-2, 2, 8}, scene.bodies[0].angular_velocity = {0.1, 5, 0.1};
  return scene;
}

// For moments (3, 4, 6), w = (2, w2, 1) is on the separatrix: 3 · 4 · (4 - 3) = 6 · 1 · (6 - 4).
inline std::vector<SmoothScene> tops() {
  std::vector<SmoothScene> rows = {
      {"asymmetric-top", "about the largest moment", free_body(Vec3(1, 2, 3), {0.5, 0.7, 4}), 20},
      {"asymmetric-top", "about the smallest moment", free_body(Vec3(1, 2, 3), {-4, 0.7, 0.5}, kTilted), 20},
      {"asymmetric-top", "axes in another order", free_body(Vec3(2.5, 1, 2), {1, -2, 0.3}, kTilted), 20},
      {"asymmetric-top", "full inertia, thrown", thrown(free_body(turned_inertia({1, 2, 2.5}), {3, -2, 1}, kTilted)),
       20},
      {"asymmetric-top", "pure spin, largest", free_body(Vec3(1, 2, 3), {0, 0, -4}, kTilted), 20},
      {"asymmetric-top", "pure spin, smallest", free_body(Vec3(1, 2, 3), {4, 0, 0}), 20},
      {"asymmetric-top", "pure spin, middle", free_body(Vec3(1, 2, 3), {0, 4, 0}), 20},
      {"asymmetric-top", "long", free_body(Vec3(1, 2, 3), 5 * Vec3(1e-3, 1, 1e-3)), 60},
      {"asymmetric-top", "near separatrix 1e-6", free_body(Vec3(1, 2, 3), {1e-6, 5, 1e-6}), 20},
      {"asymmetric-top", "near separatrix 1e-9", free_body(Vec3(1, 2, 3), {1e-9, 5, -1e-9}), 20},
      {"asymmetric-top", "nearly symmetric", free_body(Vec3(1, 1 + 1e-6, 2), {1, 2, 3}), 20},
      {"asymmetric-top", "thin rod", free_body(Vec3(1e-4, 1, 1.00005), {3, 0.2, 0.4}, kTilted), 20},
      {"asymmetric-top", "Dzhanibekov box", dzhanibekov_box(), 10},
      {"axisymmetric-top", "Kane's", free_body(Vec3(0.04, 0.04, 0.02), {2, 4, 6}), 20},
      {"axisymmetric-top", "disc", thrown(free_body(Vec3(2, 1, 1), {-5, 1, 2}, kTilted)), 20},
      {"axisymmetric-top", "full inertia", free_body(turned_inertia({1, 1, 1.8}), {1, 2, -3}, kTilted), 20},
      {"axisymmetric-top", "sphere", thrown(free_body(Vec3(2, 2, 2), {1, 2, 3}, kTilted)), 20},
  };
  for (const double x : {2.0, -2.0}) {
    for (const double y : {3.0, -3.0}) {
      for (const double z : {1.0, -1.0}) {
        rows.push_back({"asymmetric-top", "on the separatrix", free_body(Vec3(3, 4, 6), {x, y, z}), 4});
        rows.push_back({"asymmetric-top", "beside the separatrix", free_body(Vec3(3, 4, 6), {x, y, z * 1.0001}), 20});
        rows.push_back({"asymmetric-top", "inside the separatrix", free_body(Vec3(3, 4, 6), {x, y, z / 1.0001}), 20});
      }
    }
  }
  return rows;
}

inline std::vector<SmoothScene> smooth_scenes() {
  std::vector<SmoothScene> rows = tops();
  const std::vector<SmoothScene> others = {
      {"oscillator", "undamped", oscillator(0), 20},
      {"oscillator", "underdamped", oscillator(3), 20, false},
      {"oscillator", "critically damped", oscillator(20), 20, false},
      {"oscillator", "nearly critically damped", oscillator(20 + 1e-9), 20, false},
      {"oscillator", "overdamped", oscillator(60), 20, false},
      {"oscillator", "hanging from a body, spinning", hanging_oscillator(0), 20},
      {"oscillator", "hanging, damped", hanging_oscillator(4), 20, false},
      {"oscillator", "off its line by roundings", slanted_oscillator(), 2, false},
      {"oscillator", "through the anchor", spring_of_no_length(), 20, false},
      {"principal-torque", "two torques", torqued(), 5, false},
      {"principal-torque", "from rest", torqued_from_rest(), 5, false},
      {"projectile", "thrown cube", thrown_cube(), 10},
      {"projectile", "spinning", thrown(free_body(Vec3(1, 2, 3), {0, 0, -4}, kTilted)), 10},
  };
  rows.insert(rows.end(), others.begin(), others.end());
  return rows;
}

}  // namespace rigor::test
