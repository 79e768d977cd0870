// The functions of a matrix that exponential integrators are made of:
//   phi_0(z) = exp z,  phi_k(z) = integral over s from 0 to 1 of exp((1 - s) z) s^(k-1) / (k-1)!,
// so that phi_(k-1)(z) = 1/(k-1)! + z phi_k(z). (M. Hochbruck, A. Ostermann, Exponential integrators, Acta Numerica 19,
// 2010.)
#pragma once

#include <Eigen/Core>
#include <array>

namespace rigor::inline dynamics {

using Mat12 = Eigen::Matrix<double, 12, 12>;

// phi_0 to phi_4, by Taylor's series of the matrix over a power of two, doubled as often.
using PhiFunctions = std::array<Mat12, 5>;
PhiFunctions phi_functions(const Mat12& z);

}  // namespace rigor::inline dynamics
