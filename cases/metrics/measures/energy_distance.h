// Whether two samples come from one distribution: the energy distance of Székely and Rizzo (Energy statistics, J. Stat.
// Plan. Inference 143, 2013), with A = mean |x - y|, B = mean |x - x'| and C = mean |y - y'|,
//   D² = 2 A - B - C >= 0, zero only for equal distributions,
// given as the coefficient H = D² / 2 A in [0, 1], which no choice of unit changes; and how often a division of all
// points into two such samples by chance has a D² at least as large.
#pragma once

#include <cstdint>
#include <vector>

namespace rigor::inline metric {

using Points = std::vector<std::vector<double>>;  // points of one dimension each

struct EnergyTest {
  double coefficient = 0;  // H; 0 where all points are one
  double p_value = 1;
};

// Each sample has two points or more, and each point the same dimension.
EnergyTest energy_test(const Points& x, const Points& y, int permutations, std::uint64_t seed);

}  // namespace rigor::inline metric
