#include "cases/analysis/change_point.h"

#include <algorithm>
#include <cmath>

namespace rigor {
namespace {

void find_changes(const std::vector<double>& values, std::size_t begin, double chance,
                  std::vector<std::size_t>& found) {
  const ChangePoint change = most_likely_change(values);
  if (change.chance > chance) return;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(change.index);
  find_changes({values.begin(), middle}, begin, chance, found);
  found.push_back(begin + change.index);
  find_changes({middle, values.end()}, begin + change.index, chance, found);
}

}  // namespace

ChangePoint most_likely_change(const std::vector<double>& values) {
  const std::size_t count = values.size();
  if (count < 2) return {};
  double sum = 0, largest = 0;
  ChangePoint found;
  // U_t from U_(t-1): the value that comes to the left side is compared with all others.
  for (std::size_t t = 0; t + 1 < count; ++t) {
    for (std::size_t j = 0; j < count; ++j) sum += (values[j] > values[t]) - (values[j] < values[t]);
    if (std::abs(sum) > largest) largest = std::abs(sum), found.index = t + 1;
  }
  const double n = static_cast<double>(count);
  found.chance = std::min(1.0, 2 * std::exp(-6 * largest * largest / (n * n * n + n * n)));
  return found;
}

std::vector<std::size_t> change_points(const std::vector<double>& values, double chance) {
  std::vector<std::size_t> found;
  find_changes(values, 0, chance, found);
  return found;
}

}  // namespace rigor
