// Makes unit vectors from written vectors of any length.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

namespace rigor {

// Whether a vector of this squared length is a unit vector up to rounding. Such a vector stays unchanged: normalising
// it again could move its last bit, and a written file would then read back differently.
inline bool is_unit(double squared_length) { return std::abs(squared_length - 1) <= 2e-15; }

// The unit vector along a finite one of any length, itself if it is one already; none along zero. Scaled by the largest
// component first: of [1.7e308, 1.7e308] even the sum is beyond the largest number, and of [5e-324, 0] the squares are
// zero.
template <int N>
std::optional<Eigen::Vector<double, N>> unit_vector(const Eigen::Vector<double, N>& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return std::nullopt;
  if (is_unit(v.squaredNorm())) return v;
  return Eigen::Vector<double, N>((v / largest).normalized());
}

}  // namespace rigor
