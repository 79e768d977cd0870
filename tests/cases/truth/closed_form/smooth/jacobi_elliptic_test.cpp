#include "cases/truth/closed_form/smooth/jacobi_elliptic.h"

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_smooth_jacobi_elliptic)

namespace {

using Wide = boost::multiprecision::cpp_bin_float_50;

constexpr long double kRounding = 1.1e-19L;
constexpr long double kComplements[] = {1, 0.99L, 0.6L, 0.1L, 1e-2L, 1e-4L, 1e-7L};

// Boost's take the modulus, and lose half the digits to an arcsine near 1: fifty leave enough.
Wide modulus(long double complement) { return sqrt((1 - Wide(complement)) * (1 + Wide(complement))); }

}  // namespace

BOOST_AUTO_TEST_CASE(the_functions_agree_with_boosts_in_fifty_digits) {
  for (const long double complement : kComplements) {
    for (long double u = -7; u < 7; u += 0.37L) {
      Wide cn, dn;
      const Wide sn = boost::math::jacobi_elliptic(modulus(complement), Wide(u), &cn, &dn);
      const JacobiElliptic found = jacobi_elliptic(u, complement);
      BOOST_TEST_CONTEXT("k' = " << complement << ", u = " << u) {
        // Up to eight transformations, of some ten roundings each.
        BOOST_TEST(std::abs(found.sn - static_cast<long double>(sn)) < 80 * kRounding);
        BOOST_TEST(std::abs(found.cn - static_cast<long double>(cn)) < 80 * kRounding);
        BOOST_TEST(std::abs(found.dn - static_cast<long double>(dn)) < 80 * kRounding);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_quarter_period_and_the_argument_agree_with_boosts_first_integral) {
  for (const long double complement : kComplements) {
    const auto K = static_cast<long double>(boost::math::ellint_1(modulus(complement)));
    BOOST_TEST(std::abs(quarter_period(complement) - K) < 4 * kRounding * K);
    for (long double phi = -1.57L; phi <= 1.57L; phi += 0.157L) {
      const auto F = static_cast<long double>(boost::math::ellint_1(modulus(complement), Wide(phi)));
      const long double u = jacobi_argument(std::sin(phi), std::cos(phi), complement);
      // The cosine carries the rounding of phi, and near a quarter turn F is steep.
      BOOST_TEST(std::abs(u - F) < 1e-15L * (1 + std::abs(F)));
    }
  }
}

BOOST_AUTO_TEST_CASE(without_a_complement_the_functions_are_hyperbolic) {
  const JacobiElliptic limit = jacobi_elliptic(2, 0), near = jacobi_elliptic(2, 1e-12L);
  BOOST_TEST(limit.sn == std::tanh(2.0L));
  BOOST_TEST(limit.dn == 1 / std::cosh(2.0L));
  BOOST_TEST(std::abs(near.cn - limit.cn) < 80 * kRounding);
  BOOST_TEST(std::isinf(jacobi_argument(1, 0, 0)));
}

BOOST_AUTO_TEST_CASE(the_integral_agrees_with_a_general_quadrature) {
  boost::math::quadrature::tanh_sinh<long double> quadrature;
  for (const long double complement : {1.0L, 0.6L, 1e-2L, 1e-6L, 0.0L}) {
    for (const long double a : {0.01L, 0.5L, 0.99L}) {
      const DnQuadrature found(a, complement);
      for (const long double u : {0.3L, 2.0L, 5.0L}) {
        const auto slope = [&](long double x) { return 1 / (1 + a * jacobi_elliptic(x, complement).dn); };
        const long double expected = quadrature.integrate(slope, 0.0L, u);
        BOOST_TEST_CONTEXT("k' = " << complement << ", a = " << a << ", u = " << u) {
          BOOST_TEST(std::abs(found.mean() * u + found.waves(u) - found.waves(0) - expected) < 1e-16L);  // the other's
        }
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
