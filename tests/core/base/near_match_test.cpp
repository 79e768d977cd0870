#include "core/base/near_match.h"

#include <boost/test/unit_test.hpp>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_base_near_match)

BOOST_AUTO_TEST_CASE(finds_the_word_that_was_meant) {
  const std::vector<std::string> known = {"explicit-euler", "implicit-midpoint", "rk4", "semi-implicit-euler"};
  BOOST_TEST(near_match("rk5", known).value() == "rk4");
  BOOST_TEST(near_match("explicit-eluer", known).value() == "explicit-euler");
  BOOST_TEST(near_match("Semi-Implicit-Euler", known).value() == "semi-implicit-euler");
}

BOOST_AUTO_TEST_CASE(offers_nothing_where_nothing_is_near) {
  const std::vector<std::string> known = {"rk4", "bullet"};
  BOOST_TEST(!near_match("unrelated", known).has_value());
  BOOST_TEST(!near_match("", {}).has_value());
  BOOST_TEST(!near_match(std::string(1'000'000, 'r'), known).has_value());
}

BOOST_AUTO_TEST_SUITE_END()
