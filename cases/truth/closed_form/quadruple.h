// Quadruple-precision numbers for values that a closed form computes once from its scene. Differences of large sums
// would lose digits of a long double.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "cases/truth/closed_form/closed_form.h"

namespace rigor::inline truth {

using Quad = boost::multiprecision::cpp_bin_float_quad;
using QuadVec3 = Eigen::Matrix<Quad, 3, 1>;

inline Extended rounded(const Quad& number) { return number.convert_to<Extended>(); }

}  // namespace rigor::inline truth
