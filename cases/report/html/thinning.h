// Selects samples of a series so that straight lines between them stay close to it. The method is top-down as by Ramer,
// Douglas and Peucker, largest deviation first. An impact or an extreme has the largest deviation of its interval and
// is thus selected early.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace rigor::inline report {

// The distance of sample i from the straight line between samples a and b, a < i < b; 1 is barely visible.
using Deviation = std::function<double(std::size_t i, std::size_t a, std::size_t b)>;

// A sample worth keeping, and how far the series strays from those before it in the list if it is left out.
struct KeptSample {
  std::size_t index;
  double deviation;
};

// The first of the samples between two that deviates most; the first of the two, by 0, if none does.
using WorstBetween = std::function<KeptSample(std::size_t first, std::size_t last)>;

// The first and the last of `count` samples, then the others by decreasing deviation while it exceeds 1, at most
// `limit` in all.
std::vector<KeptSample> ranked_samples(std::size_t count, std::size_t limit, const Deviation& deviation);
std::vector<KeptSample> ranked_samples(std::size_t count, std::size_t limit, const WorstBetween& worst_between);

// The indices of the first `number` of them, ascending.
std::vector<std::size_t> first_samples(const std::vector<KeptSample>& ranked, std::size_t number);

}  // namespace rigor::inline report
