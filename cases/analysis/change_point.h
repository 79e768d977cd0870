// Finds where a series changes its level by more than its noise explains.
#pragma once

#include <cstddef>
#include <vector>

namespace rigor::inline analysis {

// The shortest level. A change therefore needs six values, three before it and three after it.
inline constexpr std::size_t kShortestLevel = 3;

// Returns the index of the first value of each new level, in order.
//
// A split of the series is a change if the difference of the means of its two parts is large beside the noise times
// sqrt(1/n1 + 1/n2), for n1 values before the split and n2 after it. Each mean leaves out the one value that favours
// the change most, so a single outlier makes no change. There are two measures of the noise, each with its own
// threshold:
// - the pooled standard deviation within both parts, as in Student's t. It needs the fewest values.
// - the median of |x[i+1] - x[i]|, which further changes hardly enlarge. It finds steps that are taken back.
// If a split passes, the series is divided there and both parts are tested again.
//
// The thresholds hold for noise with an autocorrelation of up to 0.5 from one value to the next: a series of noise
// alone shows a change with a probability of at most 1 %. White noise shows one in less than 0.1 %.
// `least_noise`: a smaller noise is treated as this one, in the unit of the values.
std::vector<std::size_t> change_points(const std::vector<double>& values, double least_noise = 0);

}  // namespace rigor::inline analysis
