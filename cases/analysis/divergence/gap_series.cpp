#include "cases/analysis/divergence/gap_series.h"

#include <algorithm>
#include <set>

namespace rigor::inline analysis {
namespace {

constexpr std::size_t kGroupsOnEachSide = 200;  // a plot is some 700 pixels wide

// Adds the sample with the largest share of each group of [first, end).
void keep_largest(const std::vector<double>& shares, std::size_t first, std::size_t end, std::set<std::size_t>& kept) {
  if (first >= end) return;
  const std::size_t each = (end - first + kGroupsOnEachSide - 1) / kGroupsOnEachSide;
  for (std::size_t begin = first; begin < end; begin += each) {
    const auto from = shares.begin() + static_cast<long>(begin),
               to = shares.begin() + static_cast<long>(std::min(begin + each, end));
    kept.insert(static_cast<std::size_t>(std::max_element(from, to) - shares.begin()));
  }
}

}  // namespace

GapSeries gap_series(const MotionView& a, const MotionView& b, const Scene& scene, const PartingBounds& bounds,
                     double seconds_per_sample, const std::optional<Parting>& parting) {
  std::vector<double> shares;
  for (std::size_t n = 0; n < std::min(a.samples(), b.samples()); ++n)
    shares.push_back(share_at(a, b, scene, bounds, n).share);
  if (shares.empty()) return {};
  std::set<std::size_t> kept = {0, shares.size() - 1};
  const std::size_t middle = parting ? parting->sample : shares.size() / 2;
  if (parting) kept.insert({middle, middle - std::min<std::size_t>(middle, 1)});
  keep_largest(shares, 0, middle, kept);
  keep_largest(shares, middle, shares.size(), kept);
  GapSeries series;
  for (const std::size_t n : kept)
    series.time.push_back(seconds_per_sample * static_cast<double>(n)), series.share.push_back(shares[n]);
  return series;
}

}  // namespace rigor::inline analysis
