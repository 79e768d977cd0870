#include "bench/reached.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <map>

#include "adapters/engines.h"
#include "cases/metrics/metric.h"
#include "cases/runner/simulate.h"

namespace rigor::bench {
namespace {

constexpr int kMostBodies = 1300;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// After one second by the core's adaptive method, whose error is far below that of any step timed here.
const BodyTable& truth_of(const SceneRow& row, int count) {
  static std::map<std::pair<std::string, int>, BodyTable> known;
  const auto [at, is_new] = known.try_emplace({row.name, count});
  if (!is_new) return at->second;
  const auto world = find_engine(engines(), "core").load(scene_of(row, count), {"dormand-prince", {}, Track::matched});
  for (long n = steps_in(1, row.dt); n > 0; --n) world->step(row.dt);
  Snapshot snapshot;
  world->read(snapshot);
  at->second = snapshot.bodies();
  return at->second;
}

double distance(BodyColumns a, BodyColumns b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d =
        std::max((a.position(i) - b.position(i)).norm(), angle_between(a.orientation(i), b.orientation(i)));
    if (!(d <= largest)) largest = d;
  }
  return largest;
}

struct Measured {
  const char *name, *metric;
};

Figures measured(std::initializer_list<Measured> wanted, double duration, const SceneRow& row, int count,
                 const Engine& engine, const Settings& settings) {
  const Scene& scene = scene_of(row, count);
  const Simulation run = simulate(engine, settings, scene, row.dt, duration, {.is_timed = false});
  Figures figures;
  for (const Measured& one : wanted) {
    const auto at =
        std::find_if(metrics().begin(), metrics().end(), [&](const MetricRow& r) { return r.name == one.metric; });
    if (run.not_finite) {
      figures.emplace_back(one.name, std::numeric_limits<double>::infinity());
    } else if (at != metrics().end()) {
      const MetricResult result =
          at->measure({.scene = scene, .trajectory = run.trajectory, .truth = nullptr, .leapfrog_stagger = 0});
      figures.emplace_back(one.name, result.measurement ? result.measurement->value : kNone);
    }
  }
  return figures;
}

double trajectory_error(const SceneRow& row, int count, const Engine& engine, const Settings& settings) {
  const auto world = engine.load(scene_of(row, count), settings);
  for (long n = steps_in(1, row.dt); n > 0; --n) world->step(row.dt);
  Snapshot snapshot;
  world->read(snapshot);
  return distance(snapshot.bodies(), truth_of(row, count).columns());
}

}  // namespace

Figures reached(const SceneRow& row, int count, const Engine& engine, const Settings& settings) {
  if (count > kMostBodies) return {};
  const Measured gap = {"joint_gap_m", "joint_gap"}, overlap = {"penetration_m", "penetration"};
  const auto over = [&](double duration, std::initializer_list<Measured> wanted) {
    return measured(wanted, duration, row, count, engine, settings);
  };
  switch (row.reached) {
    case Reached::energy:
      return over(1, {{"energy_error", "energy_drift"}});
    case Reached::penetration:
      return over(2, {overlap});
    case Reached::joint_gap:
      return over(1, {gap});
    case Reached::gap_and_overlap:
      return over(2, {gap, overlap});
    case Reached::trajectory:
      break;
  }
  return {{"error_m_rad", trajectory_error(row, count, engine, settings)}};
}

}  // namespace rigor::bench
