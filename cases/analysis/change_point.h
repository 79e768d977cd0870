// Where a series changes its level, beyond what its own noise makes.
#pragma once

#include <cstddef>
#include <vector>

namespace rigor {

// Pettitt's test (A. N. Pettitt, Applied Statistics 28 (1979) 126): U_t = sum over i <= t < j of sign(x_j - x_i); the
// change is where |U_t| is largest, K, and as large by chance with the probability 2 exp(-6 K²/(T³ + T²)) at most. It
// asks for ranks alone, so that a single outlier is no change. `index`: of the first value of the new level.
struct ChangePoint {
  std::size_t index = 0;
  double chance = 1;
};
ChangePoint most_likely_change(const std::vector<double>& values);

// All of them at this chance of error each: where one is found, the series is parted there and both parts asked again.
inline constexpr double kChance = 0.01;
std::vector<std::size_t> change_points(const std::vector<double>& values, double chance = kChance);

}  // namespace rigor
