#include "bench/reached.h"

#include <algorithm>
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

double measured(const char* metric, const SceneRow& row, int count, const Engine& engine, const Settings& settings) {
  const auto at =
      std::find_if(metrics().begin(), metrics().end(), [&](const MetricRow& r) { return r.name == metric; });
  if (at == metrics().end()) return kNone;
  const double duration = row.reached == Reached::penetration ? 2 : 1;
  const Scene& scene = scene_of(row, count);
  const Simulation run = simulate(engine, settings, scene, row.dt, duration, {.is_timed = false});
  if (run.not_finite) return std::numeric_limits<double>::infinity();
  const MetricResult result =
      at->measure({.scene = scene, .trajectory = run.trajectory, .truth = nullptr, .leapfrog_stagger = 0});
  return result.measurement ? result.measurement->value : kNone;
}

}  // namespace

const char* reached_name(Reached what) {
  switch (what) {
    case Reached::trajectory:
      return "error_m_rad";
    case Reached::energy:
      return "energy_error";
    case Reached::penetration:
      return "penetration_m";
    case Reached::joint_gap:
      return "joint_gap_m";
  }
  return "";
}

double reached(const SceneRow& row, int count, const Engine& engine, const Settings& settings) {
  if (count > kMostBodies) return kNone;
  if (row.reached == Reached::energy) return measured("energy_drift", row, count, engine, settings);
  if (row.reached == Reached::penetration) return measured("penetration", row, count, engine, settings);
  if (row.reached == Reached::joint_gap) return measured("joint_gap", row, count, engine, settings);
  const auto world = engine.load(scene_of(row, count), settings);
  for (long n = steps_in(1, row.dt); n > 0; --n) world->step(row.dt);
  Snapshot snapshot;
  world->read(snapshot);
  return distance(snapshot.bodies(), truth_of(row, count).columns());
}

}  // namespace rigor::bench
