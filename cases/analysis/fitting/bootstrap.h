// Intervals of fitted values. Around the best point a parabola is fitted to the loss of each trial. Drawing trials with
// replacement gives other sums of these parabolas, whose minima spread as the fitted values do (Efron, Annals of
// Statistics 7 (1979) 1).
#pragma once

#include <functional>
#include <vector>

#include "cases/analysis/fitting/minimizer.h"

namespace rigor::inline analysis {

struct BootstrapAxis {
  double low = 0, high = 1;  // of the 95 % interval, in the box
  bool is_curved = true;     // whether nearly all drawn sums have a minimum along this axis
};

struct Bootstrap {
  std::vector<BootstrapAxis> axes;
  std::vector<std::vector<double>> correlations;
};

// Calls `losses` for points in the box; it returns the loss of each trial at each point.
using LossesOfTrials = std::function<std::vector<std::vector<double>>(const std::vector<BoxPoint>& points)>;

Bootstrap bootstrap_around(const BoxPoint& best, const LossesOfTrials& losses, unsigned long seed);

}  // namespace rigor::inline analysis
