#include "cases/analysis/step_needed.h"

#include <algorithm>
#include <cmath>

namespace rigor {

StepNeeded step_for(std::vector<ErrorPoint> points, double error) {
  constexpr double kFurthest = 30, kFalls = 0.5;  // order
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.dt.seconds > b.dt.seconds; });
  std::size_t i = 0;
  while (i < points.size() && !(points[i].error <= error)) ++i;
  const bool is_beyond = i == points.size();
  if (is_beyond && i == 1) return {};
  if (is_beyond) --i;
  if (i == 0 || !(points[i].error > 0)) return {points[i].dt.seconds, false};
  const double slope =
      std::log(points[i - 1].error / points[i].error) / std::log(points[i - 1].dt.seconds / points[i].dt.seconds);
  const double seconds = points[i].dt.seconds * std::pow(error / points[i].error, 1 / slope);
  if (is_beyond && !(slope >= kFalls && seconds * kFurthest >= points[i].dt.seconds)) return {};
  return {seconds, is_beyond};
}

}  // namespace rigor
