// Elementary functions of sums, products and roots alone, against long double's, which have eleven more bits.
#include "core/base/portable.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_base_portable)

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kTries = 100000;

double last_place(double x) { return std::nextafter(std::abs(x), kInfinity) - std::abs(x); }
// In units of the last place.
double error_of(double found, long double exact) {
  return static_cast<double>(std::abs(found - exact)) / last_place(static_cast<double>(exact));
}

double uniform(std::mt19937_64& random, double from, double to) {
  return from + (to - from) * std::generate_canonical<double, 53>(random);
}

}  // namespace

// The header promises one and a half units in the last place; 4 million points gave 0.83, 1.48 and 0.84.
BOOST_AUTO_TEST_CASE(sines_and_cosines_are_right_to_the_last_place_up_to_many_turns) {
  std::mt19937_64 random(1);
  for (const double range : {0.8, 3.2, 100.0, 1e6, 1e12}) {
    double largest = 0;
    for (int i = 0; i < kTries; ++i) {
      const double x = uniform(random, -range, range);
      largest = std::max({largest, error_of(portable::sin(x), std::sin(static_cast<long double>(x))),
                          error_of(portable::cos(x), std::cos(static_cast<long double>(x)))});
    }
    BOOST_TEST(largest < 1, range);
  }
  // Next to whole half turns the sine is what the subtraction leaves.
  for (double k = 1; k < 1e6; k = std::floor(1.7 * k) + 1)
    BOOST_TEST(error_of(portable::sin(k * M_PI), std::sin(static_cast<long double>(k * M_PI))) < 1, k);
}

BOOST_AUTO_TEST_CASE(an_angle_is_that_of_its_point_in_every_quadrant) {
  std::mt19937_64 random(2);
  double largest = 0;
  for (int i = 0; i < kTries; ++i) {
    const double x = uniform(random, -1, 1), y = uniform(random, -1, 1) * std::pow(10, uniform(random, -300, 3));
    largest = std::max(largest, error_of(portable::atan2(y, x), std::atan2(static_cast<long double>(y), x)));
  }
  BOOST_TEST(largest < 1.5);
  for (const double y : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, 5e-324, 1e308}) {
    for (const double x : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, 5e-324, 1e308}) {
      const double found = portable::atan2(y, x), expected = std::atan2(y, x);
      BOOST_TEST(std::abs(found - expected) <= last_place(expected), y << " " << x);
      BOOST_TEST(std::signbit(found) == std::signbit(expected), y << " " << x);
    }
  }
}

BOOST_AUTO_TEST_CASE(exponentials_are_right_from_the_least_number_to_the_largest) {
  std::mt19937_64 random(3);
  double largest = 0;
  for (int i = 0; i < kTries; ++i) {
    const double x = uniform(random, i % 2 ? -700 : -1, i % 2 ? 700 : 1);
    largest = std::max(largest, error_of(portable::exp(x), std::exp(static_cast<long double>(x))));
  }
  BOOST_TEST(largest < 1);
  BOOST_TEST(portable::exp(0) == 1);
  BOOST_TEST(portable::exp(-745.1) == std::exp(-745.1));
  BOOST_TEST(portable::exp(-800) == 0);
  BOOST_TEST(portable::exp(709.8) == kInfinity);
}

BOOST_AUTO_TEST_CASE(what_is_no_number_gives_none) {
  for (const double x : {kInfinity, -kInfinity, std::nan("")}) {
    BOOST_TEST(std::isnan(portable::sin(x)));
    BOOST_TEST(std::isnan(portable::cos(x)));
  }
  BOOST_TEST(std::isnan(portable::atan2(std::nan(""), 1)));
  BOOST_TEST(std::isnan(portable::atan2(1, std::nan(""))));
  BOOST_TEST(std::isnan(portable::exp(std::nan(""))));
  BOOST_TEST(portable::exp(-kInfinity) == 0);
  BOOST_TEST(portable::exp(kInfinity) == kInfinity);
  BOOST_TEST(std::abs(portable::sin(1e300)) <= 1);
}

BOOST_AUTO_TEST_SUITE_END()
