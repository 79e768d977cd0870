#include "cases/report/html/thinning.h"

#include <algorithm>
#include <queue>

namespace rigor::inline report {
namespace {

// A interval between two kept samples and the sample in it that deviates most.
struct Interval {
  std::size_t first, last, worst;
  double deviation;
  bool operator<(const Interval& other) const { return deviation < other.deviation; }
};

Interval examined(std::size_t first, std::size_t last, const WorstBetween& worst_between) {
  const KeptSample worst = worst_between(first, last);
  return {first, last, worst.index, worst.deviation};
}

}  // namespace

std::vector<KeptSample> ranked_samples(std::size_t count, std::size_t limit, const Deviation& deviation) {
  return ranked_samples(count, limit, [&](std::size_t first, std::size_t last) {
    KeptSample worst{first, 0};
    for (std::size_t i = first + 1; i < last; ++i) {
      const double here = deviation(i, first, last);
      if (here > worst.deviation) worst = {i, here};
    }
    return worst;
  });
}

std::vector<KeptSample> ranked_samples(std::size_t count, std::size_t limit, const WorstBetween& worst_between) {
  std::vector<KeptSample> kept;
  if (count == 0) return kept;
  kept.push_back({0, 0});
  if (count == 1) return kept;
  kept.push_back({count - 1, 0});
  std::priority_queue<Interval> open;
  open.push(examined(0, count - 1, worst_between));
  while (!open.empty() && kept.size() < limit) {
    const Interval worst = open.top();
    open.pop();
    if (worst.deviation <= 1) break;
    kept.push_back({worst.worst, worst.deviation});
    open.push(examined(worst.first, worst.worst, worst_between));
    open.push(examined(worst.worst, worst.last, worst_between));
  }
  return kept;
}

std::vector<std::size_t> first_samples(const std::vector<KeptSample>& ranked, std::size_t number) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < std::min(number, ranked.size()); ++i) indices.push_back(ranked[i].index);
  std::sort(indices.begin(), indices.end());
  return indices;
}

}  // namespace rigor::inline report
