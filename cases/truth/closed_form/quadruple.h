// Numbers of quadruple precision, for what a closed form takes from its scene once: differences of large sums would
// lose a long double's digits.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "cases/truth/closed_form/closed_form.h"

namespace rigor {

using Quad = boost::multiprecision::cpp_bin_float_quad;
using QuadVec3 = Eigen::Matrix<Quad, 3, 1>;

inline Extended rounded(const Quad& number) { return number.convert_to<Extended>(); }

}  // namespace rigor
