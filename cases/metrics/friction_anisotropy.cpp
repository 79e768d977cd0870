// Friction that depends on the direction of sliding, for bodies whose true stopping distances are all equal. The value
// is the longest minus the shortest distance, relative to the true one. A friction pyramid brakes along its diagonal
// with the force of both its axes, sqrt(2) of the cone's, and gives 0.29.
#include <algorithm>
#include <cmath>

#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/stop_distances.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_friction_anisotropy(const JudgedRun& run) {
  std::string why_none;
  const std::vector<Stop> stops = stops_of(run, why_none);
  if (stops.size() < 2)
    return {{}, why_none.empty() ? "one body stops: there is nothing to compare it with" : why_none};
  const auto by_truth = [](const Stop& a, const Stop& b) { return a.expected < b.expected; };
  const auto by_run = [](const Stop& a, const Stop& b) { return a.found < b.found; };
  const auto [nearest, farthest] = std::minmax_element(stops.begin(), stops.end(), by_truth);
  constexpr double kAlike = 1e-9;  // of the distance
  if (farthest->expected - nearest->expected > kAlike * farthest->expected)
    return {{}, "the bodies' true distances to a stop are not the same"};
  const auto [shortest, longest] = std::minmax_element(stops.begin(), stops.end(), by_run);
  Measurement out;
  out.value = (longest->found - shortest->found) / longest->expected;
  const bool is_short = longest->expected - shortest->found > longest->found - longest->expected;
  const Stop& worst = is_short ? *shortest : *longest;
  out.worst = {worst.time, worst.body, "distance", worst.found, worst.expected};
  out.compared_until = worst.time;
  return {out, ""};
}

}  // namespace

MetricRow friction_anisotropy() {
  return {"friction_anisotropy", "1", "spread, over directions, of distances to a stop that should be the same",
          measure_friction_anisotropy};
}

}  // namespace rigor::inline metric
