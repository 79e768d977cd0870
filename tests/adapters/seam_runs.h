// Every engine, method and track, and the scenes that the seam's tests give them.
#pragma once

#include <boost/test/unit_test.hpp>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "core/engine/run_name.h"
#include "tests/scenes.h"
#include "tests/state_of.h"

namespace rigor {

struct Run {
  const Engine* engine;
  EngineInfo info;
  Settings settings;

  std::string name() const {
    return info.name + ":" + settings.method + (settings.track == Track::matched ? "@matched" : "@stock");
  }
  const MethodInfo& method() const { return method_of(info, settings); }
  std::unique_ptr<World> load(const Scene& scene) const { return engine->load(scene, settings); }
  bool supports(const Scene& scene, double dt) const { return why_unsupported(info, settings, scene, dt).empty(); }
};

inline std::vector<Run> all_runs() {
  std::vector<Run> runs;
  for (const auto& engine : engines()) {
    const EngineInfo info = engine->info();
    for (const MethodInfo& method : info.methods) {
      for (const Track track : {Track::matched, Track::stock})
        runs.push_back({engine.get(), info, {method.name, {}, track}});
    }
  }
  return runs;
}

// Calls the check for each run that supports the scene; at least one must, or the test has shown nothing.
inline void for_each_run(const Scene& scene, double dt, const std::function<void(const Run&)>& check) {
  int checked = 0;
  for (const Run& run : all_runs()) {
    if (!run.supports(scene, dt)) continue;
    BOOST_TEST_CONTEXT(run.name()) check(run);
    ++checked;
  }
  BOOST_TEST(checked > 0, "no engine supports the scene");
}

// Simbody's integrators with error control (all but one on the stock track) choose other steps if the same motion is
// described in another way. Two such runs differ by the requested accuracy, not by rounding.
inline bool chooses_steps(const Run& run) {
  if (run.info.name != "simbody") return false;
  return run.method().adaptive || (run.settings.track == Track::stock && run.settings.method != "semi-explicit-euler");
}

// For methods that choose their steps.
inline double accuracy_of(const Run& run) {
  if (run.settings.track == Track::stock) return 1e-3;
  return run.settings.method == "semi-explicit-euler-2" ? 1e-4 : 1e-9;
}

// The same, without two stock engines: btMultiBody damps every motion, and CPODES accepts errors of a thousandth.
inline void for_each_undamped_run(const Scene& scene, double dt, const std::function<void(const Run&)>& check) {
  for_each_run(scene, dt, [&](const Run& run) {
    if (run.name() != "bullet:multibody@stock" && run.name() != "simbody:cpodes@stock") check(run);
  });
}

inline BodyTable state_after(World& world, double dt, int steps) {
  for (int i = 0; i < steps; ++i) world.step(dt);
  return state_of(world);
}

using States = std::vector<BodyState>;

inline States states_of(const BodyTable& table) {
  States states;
  for (std::size_t i = 0; i < table.size(); ++i) states.push_back(table.columns().body(i));
  return states;
}

inline bool same_bits(const BodyTable& a, const BodyTable& b) {
  if (a.size() != b.size() || a.has_rotation() != b.has_rotation()) return false;
  for (int c = 0; c < (a.has_rotation() ? 22 : 13); ++c) {
    if (std::memcmp(a.columns().column(c), b.columns().column(c), a.size() * sizeof(double)) != 0) return false;
  }
  return true;
}

inline Mat3 full_inertia() {
  Mat3 inertia;
  inertia << 2.0, 0.3, -0.2, 0.3, 2.5, 0.1, -0.2, 0.1, 3.0;
  return inertia;
}

inline Body moving_body() {
  Body body;
  body.name = "body";
  body.mass = 3;
  body.position = {1, -2, 3};
  body.orientation = Quat(0.1, 0.5, -0.3, 0.8).normalized();
  body.velocity = {0.4, -0.1, 0.7};
  body.angular_velocity = {0.3, 0.9, -0.5};
  return body;
}

inline Scene scene_of(Body body, const Vec3& gravity = Vec3::Zero()) {
  Scene scene;
  scene.gravity = gravity;
  scene.bodies = {std::move(body)};
  return scene;
}

// The course's cube, hung off-centre from the world by a spring.
inline Scene hanging_cube() {
  Scene scene = test::fixed_spring();
  scene.springs[0].damping = 20;
  return scene;
}

inline Body ground(const Vec3& normal) {
  Body body;
  body.name = "ground";
  body.shape = Plane{normal, 0};
  body.fixed = body.collides = true;
  return body;
}

inline Body two_kilograms(const std::string& name, const Shape& shape, const Vec3& position) {
  Body body;
  body.name = name;
  body.mass = 2;
  body.shape = shape;
  if (!std::holds_alternative<Plane>(shape)) body.inertia = inertia_of(shape, body.mass);
  body.position = position;
  body.collides = true;
  return body;
}

// Spheres that fall onto the ground and each other.
inline Scene small_pile() {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0; i < 12; ++i) {
    const Vec3 position(0.15 * (i % 2) + 0.01 * i, 0.15 * (i / 2 % 2), 0.2 + 0.25 * (i / 4));
    scene.bodies.push_back(two_kilograms("ball " + std::to_string(i), Sphere{0.1}, position));
  }
  scene.bodies.push_back(ground({0, 0, 1}));
  scene.contact_default = {0.3, 0.5};
  return scene;
}

inline Scene top() {
  Body body = moving_body();
  body.inertia = full_inertia();
  return scene_of(body, {0, 0, -9.81});
}

}  // namespace rigor
