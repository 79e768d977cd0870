#include "cases/truth/distance.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_distance)

BOOST_AUTO_TEST_CASE(the_furthest_body_counts_and_what_is_no_number_is_infinitely_far) {
  BodyTable a(2), b(2);
  for (std::size_t i = 0; i < 2; ++i)
    a.columns().set_orientation(i, Quat::Identity()), b.columns().set_orientation(i, Quat::Identity());
  const auto apart = [&] { return distance_between(a.columns(), b.columns()); };
  BOOST_TEST(apart() == 0);
  b.columns().set_position(0, {0, 3, 4});
  BOOST_TEST(apart() == 5);
  b.columns().set_orientation(1, Quat(std::cos(0.25), 0, 0, std::sin(0.25)));
  BOOST_TEST(apart() == 5);
  b.columns().set_position(0, Vec3::Zero());
  BOOST_TEST(apart() == 0.5, boost::test_tools::tolerance(1e-15));
  for (const double broken : {std::nan(""), HUGE_VAL}) {
    b.columns().set_position(0, {0, broken, 0});
    BOOST_TEST(apart() == HUGE_VAL);
  }
}

BOOST_AUTO_TEST_SUITE_END()
