// Each run's error beside the median run's, over all cases, at one step size.
#pragma once

#include <vector>

#include "cases/results/results.h"

namespace rigor::inline analysis {

struct RelativeError {
  std::size_t run = 0;
  std::size_t cases = 0;   // compared
  std::size_t failed = 0;  // of these, cells that blew up, crashed, timed out or are invalid
  double ratio = 0;        // the median over the cases of error / median run's error; infinite if that one failed
};

// A failed cell has an infinite error. Of an even count the worse of the two in the middle is the median. Reference
// methods (cell_error.h) get a ratio, but do not count for the median run. In the order of the runs; runs without any
// case are left out.
std::vector<RelativeError> relative_errors(const Results& results, const StepSize& dt);

// The distinct steps of all cases, from the coarsest to the finest.
std::vector<StepSize> distinct_steps(const Results& results);

}  // namespace rigor::inline analysis
