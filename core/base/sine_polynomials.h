// cos y and sin y / y as polynomials in s = y², for 0 <= s <= 2.5: 1 + s times a polynomial of degree 7 that meets
// (cos y - 1)/s and (sin y / y - 1)/s at Chebyshev's points. That leaves 4e-17; with the roundings both are right to
// 3e-16.
#pragma once

namespace rigor {

inline constexpr double kLargestSquare = 2.5;

inline constexpr double kCosine[8] = {-0.5,
                                      0.041666666666666304,
                                      -0.001388888888885841,
                                      2.4801587291829438e-05,
                                      -2.755731768929377e-07,
                                      2.0876625841954573e-09,
                                      -1.146453049361302e-11,
                                      4.625701609891324e-14};
inline constexpr double kSineQuotient[8] = {-0.16666666666666666,   0.008333333333333314,   -0.0001984126984125376,
                                            2.7557319218837673e-06, -2.505210757580932e-08, 1.605897465969838e-10,
                                            -7.643886158204389e-13, 2.730402537561207e-15};

}  // namespace rigor
