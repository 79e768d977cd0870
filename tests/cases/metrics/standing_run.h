// Runs that stand still, with reports of contacts that a test makes up.
#pragma once

#include <functional>

#include "core/dynamics/model/system.h"
#include "tests/cases/judged.h"

namespace rigor::test {

constexpr double kStandingDt = 0.01;  // s

// The scene stands still, and each step reports what `report` says of it.
inline Trajectory standing(const Scene& scene, int steps,
                           const std::function<std::vector<ReportedContact>(int)>& report) {
  Trajectory run{kStandingDt, {}, ContactRecords::kept};
  BodyTable table(scene.bodies.size());
  set_initial_state(scene, table.columns());
  for (int n = 0; n <= steps; ++n)
    run.samples.push_back({n * kStandingDt,
                           KeptBodies(std::as_const(table).columns()),
                           {},
                           n > 0 ? report(n) : std::vector<ReportedContact>()});
  return run;
}

inline TruthSamples same_as(const Trajectory& run) {
  TruthSamples truth;
  for (const Sample& sample : run.samples) truth.bodies.push_back(sample.bodies);
  truth.error.assign(run.samples.size(), 0.0);
  truth.largest_kinetic_energy = 1;
  return truth;
}

// With a truth that moves as the run does.
inline MetricResult result_of(const std::string& metric, const Scene& scene, const Trajectory& run) {
  const TruthSamples truth = same_as(run);
  return measured(metric, {scene, run, &truth, 0});
}

inline double value_of(const std::string& metric, const Scene& scene, const Trajectory& run) {
  const MetricResult result = result_of(metric, scene, run);
  BOOST_TEST_REQUIRE(result.measurement.has_value(), metric << ": " << result.not_applicable);
  return result.measurement->value;
}

}  // namespace rigor::test
