// Pettitt's test: levels that change, and noise that does not.
#include "cases/analysis/change_point.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

using namespace rigor;

namespace {

// Uniform noise of one part in ten, from a generator with the same numbers on every machine.
std::vector<double> noise(std::size_t count, unsigned long seed) {
  std::mt19937_64 engine(seed);
  std::vector<double> values(count);
  for (double& value : values) value = 1 + 0.1 * (static_cast<double>(engine() >> 11) * 0x1p-53);
  return values;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_analysis_change_point)

// By hand, of 1 1 1 5 5 5: U_3 = 3 × 3 = 9, and 2 exp(-6 × 81/(216 + 36)) = 0.2906.
BOOST_AUTO_TEST_CASE(the_statistic_is_pettitts) {
  const ChangePoint change = most_likely_change({1, 1, 1, 5, 5, 5});
  BOOST_TEST(change.index == 3u);
  BOOST_TEST(std::abs(change.chance - 2 * std::exp(-486.0 / 252)) < 1e-15);
}

BOOST_AUTO_TEST_CASE(steps_beyond_the_noise_are_found_where_they_are) {
  auto values = noise(60, 1);
  for (std::size_t i = 20; i < 60; ++i) values[i] *= 1.3;
  for (std::size_t i = 40; i < 60; ++i) values[i] *= 0.5;
  BOOST_TEST(change_points(values) == (std::vector<std::size_t>{20, 40}));
}

// At a chance of one in a hundred each; of a hundred series of noise alone a few may look changed: were it a matter of
// chance 0.01, more than 4 would have a probability of 0.4 %.
BOOST_AUTO_TEST_CASE(noise_alone_is_no_change) {
  int found = 0;
  for (unsigned long seed = 1; seed <= 100; ++seed) found += !change_points(noise(40, seed)).empty();
  BOOST_TEST(found <= 4);
}

BOOST_AUTO_TEST_CASE(an_outlier_and_few_values_are_no_change) {
  auto values = noise(30, 3);
  values[12] = 100;
  BOOST_TEST(change_points(values).empty());
  BOOST_TEST(change_points({}).empty());
  BOOST_TEST(change_points({1}).empty());
  BOOST_TEST(change_points({1, 2, 3, 4}).empty());
  BOOST_TEST(change_points(std::vector<double>(50, 1.0)).empty());
}

BOOST_AUTO_TEST_SUITE_END()
