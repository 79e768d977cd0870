#include "bench/scenes.h"

#include <cmath>

namespace rigor::bench {
namespace {

Body body(int index, const Vec3& position) {
  Body b;
  b.name = "body " + std::to_string(index);
  b.mass = 1 + 0.1 * (index % 7);
  b.inertia = Vec3(0.1, 0.2, 0.25).asDiagonal();
  b.position = position;
  b.angular_velocity = {0.5 + 0.01 * (index % 11), -0.3, 0.2};
  return b;
}

// Tumbling bodies on their way, without gravity, so that nothing grows however long they are timed.
Scene free_bodies(int count) {
  Scene scene;
  for (int i = 0; i < count; ++i) {
    Body b = body(i, {0.5 * i, 0, 0});
    b.velocity = {0, 0.1 * (i % 5), 1};
    scene.bodies.push_back(b);
  }
  return scene;
}

// Bodies in a row, each held to the next off-centre, the ends to the world; every other one starts pushed aside.
Scene spring_chain(int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const double spacing = 0.5, arm = 0.1;
  for (int i = 0; i < count; ++i) {
    Body b = body(i, {spacing * (i + 1), 0, 0});
    b.velocity = {0, i % 2 ? 0.2 : -0.2, 0};
    scene.bodies.push_back(b);
  }
  for (int i = -1; i < count; ++i) {
    Spring s;
    s.a = i, s.b = i + 1 < count ? i + 1 : kWorld;
    s.point_a = i < 0 ? Vec3(arm, 0, 0) : Vec3(arm, 0, 0.02);
    s.point_b = s.b == kWorld ? Vec3(spacing * (count + 1) - arm, 0, 0) : Vec3(-arm, 0, 0.02);
    s.stiffness = 200;
    s.rest_length = spacing - 2 * arm;
    scene.springs.push_back(s);
  }
  return scene;
}

// Elastic spheres over the ground, in a square grid wide enough that they never meet; each starts at its own height.
Scene bouncing_spheres(int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_default = {1, kInfiniteFriction};
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i) {
    Body b = body(i, {0.5 * (i % side), 0.5 * (i / side), 0.3 + 0.05 * (i % 13)});
    b.inertia = 0.4 * b.mass * 0.01 * Mat3::Identity();
    b.angular_velocity.setZero();
    b.shape = Sphere{0.1};
    b.collides = true;
    scene.bodies.push_back(b);
  }
  Body ground;
  ground.name = "ground";
  ground.shape = Plane{Vec3::UnitZ(), 0};
  ground.fixed = ground.collides = true;
  scene.bodies.push_back(ground);
  return scene;
}

}  // namespace

const std::vector<SceneRow>& scenes() {
  static const std::vector<SceneRow> table = {
      {"bouncing-spheres", bouncing_spheres}, {"free-bodies", free_bodies}, {"spring-chain", spring_chain}};
  return table;
}

}  // namespace rigor::bench
