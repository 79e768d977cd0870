// Measurements of a single body, shared by the adapter tests.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "adapters/engines.h"
#include "core/dynamics/model/energy.h"
#include "core/engine/run_name.h"

namespace rigor {

inline std::unique_ptr<World> load_run(const std::string& name, const Scene& scene) {
  const RunName run = parse_run_name(name, infos_of(engines()));
  return find_engine(engines(), run.engine).load(scene, run.settings);
}

// Empty if there is none of that name.
inline std::string setting(const SettingsInForce& settings, const std::string& name) {
  for (const auto& [key, value] : settings) {
    if (key == name) return value;
  }
  return "";
}

inline BodyState body_after(World& world, double dt, int steps) {
  for (int i = 0; i < steps; ++i) world.step(dt);
  Snapshot snapshot;
  world.read(snapshot);
  return snapshot.bodies().body(0);
}

// The free asymmetric top I = (1, 2, 3), spun at 5 rad/s about its unstable axis: it flips every 5.5 s, for ever.
inline Scene asymmetric_top() {
  Scene scene;
  Body body;
  body.name = "top";
  body.inertia = Vec3(1, 2, 3).asDiagonal();
  body.angular_velocity = 5 * Vec3(1e-3, 1, 1e-3);
  scene.bodies = {body};
  return scene;
}

// The share of the top's energy gained (lost, if negative) in 60 s at dt = 1/30.
inline double energy_gained_by_top(const std::string& run) {
  const Scene scene = asymmetric_top();
  const auto world = load_run(run, scene);
  Snapshot snapshot;
  world->read(snapshot);
  const double before = energy(scene, snapshot.bodies());
  for (int i = 0; i < 1800; ++i) world->step(1.0 / 30);
  world->read(snapshot);
  return energy(scene, snapshot.bodies()) / before - 1;
}

// A flat box on the ground z = 0, pushed off at `speed` in a direction given by its angle from x [rad].
inline Scene sliding_box(double speed, double direction, double friction, const Vec3& size = {0.4, 0.4, 0.2}) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body box;
  box.name = "box";
  box.shape = Box{size};
  box.inertia = inertia_of(*box.shape, box.mass);
  box.collides = true;
  box.position = {0, 0, 0.5 * size.z()};
  box.velocity = speed * Vec3(std::cos(direction), std::sin(direction), 0);
  Body ground;
  ground.name = "ground";
  ground.shape = Plane{{0, 0, 1}, 0};
  ground.fixed = ground.collides = true;
  scene.bodies = {box, ground};
  scene.contact_default = {0, friction};
  return scene;
}

// The ratio of the distances at which the box of sliding_box stops, found to expected: v^2 / (2 mu g).
inline double stop_distance_ratio(const std::string& run, double direction, double dt, double speed = 5,
                                  double friction = 0.5, const Vec3& size = {0.4, 0.4, 0.2}) {
  const double truth = speed * speed / (2 * friction * 9.81), time = speed / (friction * 9.81);
  const auto world = load_run(run, sliding_box(speed, direction, friction, size));
  return body_after(*world, dt, static_cast<int>(1.5 * time / dt)).position.head<2>().norm() / truth;
}

// A ball dropped onto the ground: how high it comes up the first time, over the 1.37 m it fell.
inline double first_apex(const std::string& run, double restitution, double dt) {
  Scene scene;
  scene.gravity = {0, -9.8, 0};
  Body ball;
  ball.name = "ball";
  ball.mass = 100;
  ball.shape = Sphere{0.1};
  ball.inertia = inertia_of(*ball.shape, ball.mass);
  ball.collides = true;
  ball.position = {0, 1.47, 0};
  Body ground;
  ground.name = "ground";
  ground.shape = Plane{{0, 1, 0}, 0};
  ground.fixed = ground.collides = true;
  scene.bodies = {ball, ground};
  scene.contact_default = {restitution, kInfiniteFriction};
  const auto world = load_run(run, scene);
  double falling = 0;
  BodyState state = body_after(*world, dt, 1);
  for (; state.velocity.y() < falling; state = body_after(*world, dt, 1))
    falling = state.velocity.y();  // until it hits
  double apex = 0.1;
  // An engine may brake it in one step and throw it up in a later one. No slower than it came is the next fall.
  for (double t = 0; t < 1.5 && state.velocity.y() > 0.9 * falling; t += dt, state = body_after(*world, dt, 1)) {
    apex = std::max(apex, state.position.y());
  }
  return (apex - 0.1) / 1.37;
}

}  // namespace rigor
