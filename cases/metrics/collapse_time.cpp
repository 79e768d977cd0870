// How long a structure built to stand (built_at_rest.h) stands: the first instant at which a body has moved by more
// than half its bounding radius, or the end of the run.
#include "cases/metrics/measures/built_at_rest.h"
#include "cases/metrics/metric.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_collapse_time(const JudgedRun& run) {
  const std::string why_not = why_not_built_at_rest(run);
  if (!why_not.empty()) return {{}, why_not};
  const double end = run.trajectory.samples.back().time;
  Measurement out;
  out.worst = collapse_of(run).value_or(Instant{end, kWorld, "displacement", 0, 0});
  out.value = out.worst.time, out.compared_until = end;
  return {out, ""};
}

}  // namespace

MetricRow collapse_time() {
  return {.name = "collapse_time",
          .unit = "s",
          .summary = "how long a structure built to stand stands; higher is better",
          .measure = measure_collapse_time,
          .needs = {},
          .higher_is_better = true};
}

}  // namespace rigor::inline metric
