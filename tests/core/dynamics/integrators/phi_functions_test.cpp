#include "core/dynamics/integrators/phi_functions.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_integrators_phi_functions)

// phi_1(x) = (e^x - 1)/x and on, in extended precision; for |x| >= 1 the quotients lose at most four digits of it.
BOOST_AUTO_TEST_CASE(they_are_the_scalar_functions_of_the_eigenvalues) {
  for (const double x : {-300.0, -40.0, -3.0, -1.0, 1.0, 2.5, 12.0}) {
    const PhiFunctions phi = phi_functions(x * Mat12::Identity());
    long double expected = std::exp(static_cast<long double>(x)), factorial = 1;
    for (int k = 0; k <= 4; ++k) {
      // Each doubling of the argument may double the relative roundings: 2⁻⁵³ times 300 and the few of a product.
      BOOST_TEST(std::abs(phi[k](3, 3) - static_cast<double>(expected)) <=
                     1e-13 * std::max<double>(1, std::abs(static_cast<double>(expected))),
                 "phi_" << k << "(" << x << ") is " << phi[k](3, 3));
      BOOST_TEST(phi[k](3, 4) == 0);
      if (k > 0) factorial *= k;
      expected = (expected - 1 / factorial) / x;
    }
  }
}

BOOST_AUTO_TEST_CASE(the_exponential_of_an_oscillator_is_its_rotation) {
  const double angle = 97.2;
  Mat12 z = Mat12::Zero();
  z(0, 6) = angle, z(6, 0) = -angle;
  const PhiFunctions phi = phi_functions(z);
  BOOST_TEST(std::abs(phi[0](0, 0) - std::cos(angle)) < 1e-13);  // roundings, doubled eight times
  BOOST_TEST(std::abs(phi[0](0, 6) - std::sin(angle)) < 1e-13);
  BOOST_TEST(std::abs(phi[1](0, 6) - (1 - std::cos(angle)) / angle) < 1e-13);
}

BOOST_AUTO_TEST_CASE(of_nothing_they_are_the_inverse_factorials) {
  const PhiFunctions phi = phi_functions(Mat12::Zero());
  const double factorial[] = {1, 1, 2, 6, 24};
  for (int k = 0; k <= 4; ++k) BOOST_TEST((phi[k] - Mat12::Identity() / factorial[k]).norm() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
