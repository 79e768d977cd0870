// Unit vectors of what people write, whatever its length.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace rigor {

// The unit vector along a finite one of any length; none along zero. Scaled by the largest component first: of
// [1.7e308, 1.7e308] even the sum is beyond the largest number, and of [5e-324, 0] the squares are zero.
template <int N>
std::optional<Eigen::Vector<double, N>> unit_vector(const Eigen::Vector<double, N>& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return std::nullopt;
  return Eigen::Vector<double, N>((v / largest).normalized());
}

}  // namespace rigor
