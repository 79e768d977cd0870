// Scenes of bodies on a plane and on a line, for the closed forms of contact.
#pragma once

#include "tests/cases/judged.h"

namespace rigor::test {

inline Body on_its_own(const std::string& name, const Shape& shape, double mass, const Vec3& position) {
  Body made = body(name, mass, Vec3::Ones(), position);
  made.inertia = inertia_of(shape, mass);
  made.shape = shape;
  made.collides = true;
  return made;
}

inline Body plane(const Vec3& normal = Vec3::UnitZ(), double offset = 0) {
  Body ground;
  ground.name = "ground";
  ground.shape = Plane{normal.normalized(), offset};
  ground.fixed = ground.collides = true;
  return ground;
}

// A plane that falls along x at `angle`, and the frame whose z is its normal and whose x points down the slope.
inline Mat3 slope_frame(double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix(); }

// A body that touches a slope, moving along it at `speed` (downhill), turning at `spin` about the slope's y.
inline Scene on_slope(const Shape& shape, double angle, double friction, double speed, double spin = 0) {
  const Mat3 R = slope_frame(angle);
  const auto* box = std::get_if<Box>(&shape);
  const double height = box ? box->size.z() / 2 : std::get<Sphere>(shape).radius;
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body mover = on_its_own("mover", shape, 2, R * Vec3(0, 0, height));
  mover.orientation = Quat(R);
  mover.velocity = R * Vec3(speed, 0, 0), mover.angular_velocity = R * Vec3(0, spin, 0);
  scene.bodies = {mover, plane(R.col(2))};
  scene.contact_default = {0, friction};
  return scene;
}

// Equal spheres of 1 kg and radius 0.5 m in a row along x, `gap` apart, the first one moving at 1 m/s.
inline Scene row_of_spheres(int count, double gap, double restitution) {
  Scene scene;
  for (int i = 0; i < count; ++i)
    scene.bodies.push_back(on_its_own("ball " + std::to_string(i), Sphere{0.5}, 1, {i * (1 + gap), 0, 0}));
  scene.bodies[0].position.x() -= 1;
  scene.bodies[0].velocity = {1, 0, 0};
  scene.contact_default = {restitution, 0};
  return scene;
}

// SimBenchmark's rolling test: 25 balls of 1 kg on a box of 10 kg that is pushed by 150 N at `angle` in the plane.
inline Scene pushed_box(double angle) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {plane(), on_its_own("box", Box{{8, 8, 0.4}}, 10, {0, 0, 0.2})};
  for (int i = 0; i < 25; ++i)
    scene.bodies.push_back(on_its_own("ball " + std::to_string(i), Sphere{0.2}, 1, {i % 5 - 2., i / 5 - 2., 0.6}));
  scene.contact_default = {0, 0.8};
  scene.contact_pairs = {{0, 1, {0, 0.4}}};
  TimedForce push;
  push.body = 1, push.force = 150 * Vec3(std::cos(angle), std::sin(angle), 0);
  scene.forces = {push};
  return scene;
}

}  // namespace rigor::test
