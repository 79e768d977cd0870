// Finds the step size that keeps an error in bounds.
#pragma once

#include <vector>

#include "cases/analysis/work_precision.h"

namespace rigor {

// The largest dt that keeps an error in bounds; 0 if no dt that was tried, or can be extrapolated to, does.
struct StepNeeded {
  double seconds = 0;
  bool is_extrapolated = false;
  bool operator<(const StepNeeded& other) const { return seconds < other.seconds; }
};

// Read off the straight line, in logarithms, through the cells; beyond the finest of them off the line through the last
// two, if the error falls there at all and no further than a factor of 30.
StepNeeded step_for(std::vector<ErrorPoint> points, double error);

}  // namespace rigor
