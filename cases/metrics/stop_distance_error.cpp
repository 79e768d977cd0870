// The relative error of the distance of a body that the truth brings to a stop: (found - expected) / expected, the
// largest magnitude over the bodies, at the end of the run. Creep after the stop counts.
#include <cmath>

#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/stop_distances.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_stop_distance_error(const JudgedRun& run) {
  std::string why_none;
  Measurement out;
  for (const Stop& stop : stops_of(run, why_none)) {
    const double value = std::abs(stop.found - stop.expected) / stop.expected;
    if (value >= out.value)
      out.value = value, out.worst = {stop.time, stop.body, "distance", stop.found, stop.expected};
    out.compared_until = stop.time;
  }
  if (!why_none.empty()) return {{}, why_none};
  return {out, ""};
}

}  // namespace

MetricRow stop_distance_error() {
  return {"stop_distance_error", "1", "error of the distance to a stop, relative to the true one",
          measure_stop_distance_error};
}

}  // namespace rigor::inline metric
