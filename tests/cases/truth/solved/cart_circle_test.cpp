// The circle that robots/cart-turns comes to, by hand: rolling without slip, and the balance of forces and moments.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "adapters/core/core_engine.h"
#include "cases/case/suite.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_cart_circle)

BOOST_AUTO_TEST_CASE(the_cart_comes_to_the_circle_of_its_balances) {
  const double m = 4.6, d = 0.02 * 4 / 4.6, b = 0.3, r = 0.05, c = 0.005;  // kg, m, N m s/rad
  double v = 0.45, w = 0.5;                                                // m/s of the axle's middle, rad/s
  for (int round = 0; round < 200; ++round) {
    v = r * (0.09 - r * m * w * w * d) / (2 * c);
    w = 0.01 / (c * b / r - 2 * r * m * v * d / b);
  }
  const Case cart = select_cases({"robots/cart-turns"}, default_suite_dir(), test::words()).front();
  const auto world = CoreEngine().load(cart.scene, {.method = "dormand-prince", .options = {{"contact", "event"}}});
  for (int n = 0; n < 25 * 30; ++n) world->step(1.0 / 30);  // in 25 s the start decays to 1e-5
  Snapshot end;
  world->read(end);
  const double turning = end.bodies().angular_velocity(0).z(), speed = end.bodies().velocity(0).norm();
  const auto kDecayed = boost::test_tools::tolerance(1e-4);
  BOOST_TEST(turning == w, kDecayed);
  BOOST_TEST(speed / turning == std::hypot(v / w, 0.02), kDecayed);  // the chassis's centre is 20 mm behind the axle
}

BOOST_AUTO_TEST_SUITE_END()
