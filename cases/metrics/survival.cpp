// How long a run lasted: the instant at which it blew up according to its verdict (stability.h), or the end of the run.
#include <cmath>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_survival(const JudgedRun& run) {
  if (std::isnan(run.survived)) return {{}, "nobody judged the run's stability"};
  Measurement out;
  out.value = run.survived;
  out.worst = {run.survived, kWorld, "time", run.survived, run.duration};
  out.compared_until = run.survived;
  return {out, ""};
}

}  // namespace

MetricRow survival() {
  return {.name = "survival",
          .unit = "s",
          .summary = "how long the run lasts before it blows up; its whole duration if it does not",
          .measure = measure_survival,
          .needs = {},
          .higher_is_better = true};
}

}  // namespace rigor::inline metric
