// CPU seconds that the steps of one simulated second take, without recording or judging them. A measured time: the only
// metric that another run of the same cell does not repeat to the last bit.
#include <cmath>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_cost(const JudgedRun& run) {
  if (run.trajectory.samples.size() < 2) return {{}, "the run has no finite step"};
  if (std::isnan(run.cpu_seconds)) return {{}, "the run's steps were not timed"};
  const double simulated = run.trajectory.samples.back().time;
  Measurement out;
  out.value = run.cpu_seconds / simulated;
  out.worst = {simulated, kWorld, "CPU time", run.cpu_seconds, 0};
  out.compared_until = simulated;
  return {out, ""};
}

}  // namespace

MetricRow cost() {
  return {.name = "cost",
          .unit = "s/s",
          .summary = "CPU seconds that the steps of one simulated second take",
          .measure = measure_cost,
          .needs = {},
          .is_compared = false};
}

}  // namespace rigor::inline metric
