// Scenes and runs that the judge's tests share.
#pragma once

#include <boost/test/unit_test.hpp>
#include <functional>

#include "adapters/engines.h"
#include "cases/metrics/metric.h"
#include "cases/metrics/stability.h"
#include "cases/runner/simulate.h"
#include "core/engine/run_name.h"
#include "tests/scenes.h"

namespace rigor::test {

// Two cubes hung below each other by two springs each (the series, assignment 5, exercise 2-2).
inline Scene body_springs() {
  Scene scene;
  scene.gravity = {0, -9.8, 0};
  scene.bodies = {body("upper", 100, {1, 1, 1}, {0, 1.5, 0}), body("lower", 100, {1, 1, 1}, {0, 0.5, 0})};
  for (const double z : {0.12, -0.12}) {
    scene.springs.push_back(spring(kWorld, {0.12, 2, z}, 0, {0.12, 0.12, z}, 1e4, 0.38));
    scene.springs.push_back(spring(0, {-0.12, -0.12, z}, 1, {-0.12, 0.12, z}, 1e4, 0.76));
  }
  return scene;
}

// The course's thrown cube (assignment 5, exercise 1).
inline Scene thrown_cube() {
  Scene scene;
  scene.gravity = {0, -9.8, 0};
  Body cube = body("cube", 100, {1, 1, 1}, {-2.45, 0.5, 0});
  cube.orientation = Quat(0.1, 0.5, 0, 0).normalized();
  cube.velocity = {4.9, 4.9, 0}, cube.angular_velocity = {0, 10, 0};
  scene.bodies = {cube};
  return scene;
}

inline BodyTable truth_at(const Truth& truth, double t, std::size_t bodies) {
  BodyTable table(bodies);
  truth.at(t, table.columns());
  return table;
}

inline TruthSamples sampled(const Truth& truth, const Trajectory& trajectory, const Scene& scene, double kinetic) {
  TruthSamples samples;
  samples.largest_kinetic_energy = kinetic, samples.source = &truth;
  for (const Sample& sample : trajectory.samples) {
    samples.bodies.push_back(truth_at(truth, sample.time, scene.bodies.size()));
    samples.error.push_back(truth.error(sample.time));
  }
  return samples;
}

inline Settings core_method(const std::string& method) {
  Settings settings;
  settings.method = method;
  return settings;
}

// The core's contact=event lacks cylinders and ellipsoids.
inline bool takes_contact_by_events(const Scene& scene) {
  Settings settings = core_method("dormand-prince");
  settings.options["contact"] = "event";
  return why_unsupported(find_engine(engines(), "core").info(), settings, scene, 1e-3).empty();
}

// The truth itself as a run: what every metric must find nothing wrong with.
inline Trajectory played(const Truth& truth, const Scene& scene, double dt, int steps) {
  Trajectory trajectory{dt, {}};
  for (int n = 0; n <= steps; ++n) trajectory.samples.push_back({n * dt, truth_at(truth, n * dt, scene.bodies.size())});
  return trajectory;
}

inline MetricResult measured(const std::string& name, const JudgedRun& run) {
  for (const MetricRow& row : metrics()) {
    if (row.name == name) return row.measure(run);
  }
  BOOST_FAIL("no metric is called " + name);
  return {};
}

// A truth of one body that a test states as a formula, without an error of its own up to `good_until`.
class StatedTruth : public Truth {
 public:
  explicit StatedTruth(std::function<BodyState(double t)> state, double good_until = 1e9)
      : state_(std::move(state)), good_until_(good_until) {}
  void at(double t, MutableBodyColumns out) const override { out.set_body(0, state_(t)); }
  double error(double t) const override { return t <= good_until_ ? 0 : 1; }

 private:
  std::function<BodyState(double t)> state_;
  double good_until_;
};

inline auto says(const std::string& part) {
  return [part](const std::exception& e) {
    BOOST_TEST_CONTEXT(e.what()) { BOOST_TEST(std::string(e.what()).find(part) != std::string::npos); }
    return true;
  };
}

}  // namespace rigor::test
