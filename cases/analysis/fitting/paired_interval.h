// The interval of one fitted value where the parabolas of the bootstrap tell none, as on a rough loss. The value is
// fixed, the others are fitted again, and each trial's loss is compared with its own at the best point. The interval
// ends where the mean difference exceeds 0.98 of its standard error.
//
// Of losses (x - c_t)² with trials t this is 1.96 standard errors of the best x: the difference of a trial is
// (x - m) (x + m - 2 c_t), its mean (x - m)², and its deviation 2 |x - m| times that of c.
#pragma once

#include "cases/analysis/fitting/bootstrap.h"

namespace rigor {

struct PairedInterval {
  double low = 0, high = 1;                        // in the box
  bool is_low_open = false, is_high_open = false;  // the end of the range itself is within
};

PairedInterval paired_interval(const BoxPoint& best, std::size_t axis, const LossesOfTrials& losses);

}  // namespace rigor
