// Compares the energy distance with a second derivation, and the p-value with its promise: uniform if both samples come
// from one distribution, small if not.
#include "cases/metrics/measures/energy_distance.h"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_energy_distance)

namespace {

// Box and Muller, so that the numbers are the same with every library.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : random_(seed) {}
  double operator()() { return std::sqrt(-2 * std::log(even())) * std::cos(2 * std::numbers::pi * even()); }

 private:
  double even() { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53; }
  std::mt19937_64 random_;
};

Points sample(Normal& normal, int count, int dimension, double shift) {
  Points out(count, std::vector<double>(dimension));
  for (auto& point : out) {
    for (double& x : point) x = shift + normal();
  }
  return out;
}

// Mean |X - Y| of normal variables whose difference has this mean and deviation.
double mean_distance(double mean, double deviation) {
  const double z = mean / deviation, density = std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
  return 2 * deviation * density + mean * std::erf(z / std::sqrt(2.0));
}

}  // namespace

BOOST_AUTO_TEST_CASE(is_what_the_definition_says) {
  const Points x = {{0, 0}, {3, 4}}, y = {{0, 0}, {0, 1}, {6, 8}};
  // Computed by hand: mean |x - y| over the six pairs, |x - x'| over all four and |y - y'| over all nine.
  const double across = (0 + 1 + 10 + 5 + std::hypot(3, 3) + 5) / 6, within_x = 2 * 5 / 4.0,
               within_y = 2 * (1 + 10 + std::hypot(6, 7)) / 9;
  BOOST_TEST(energy_test(x, y, 9, 1).coefficient == (2 * across - within_x - within_y) / (2 * across),
             boost::test_tools::tolerance(1e-14));
  BOOST_TEST(energy_test(x, x, 99, 1).coefficient == 0, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(energy_test(x, x, 99, 1).p_value == 1);
}

BOOST_AUTO_TEST_CASE(tends_to_the_closed_form_of_two_normal_distributions) {
  Normal normal(1);
  const int count = 500, repeats = 20;
  const double shift = 1, across = mean_distance(shift, std::numbers::sqrt2);
  // A point's distance from itself counts among those within.
  const double within = (1 - 1.0 / count) * mean_distance(0, std::numbers::sqrt2);
  const double expected = (2 * across - 2 * within) / (2 * across);
  double found = 0;
  for (int k = 0; k < repeats; ++k)
    found += energy_test(sample(normal, count, 1, 0), sample(normal, count, 1, shift), 1, 1).coefficient / repeats;
  // The means' difference, 1, is known to sqrt(2 / n) of n points, and the coefficient goes by its square: three
  // deviations.
  BOOST_TEST(std::abs(found - expected) < 3 * 2 * std::sqrt(2.0 / (count * repeats)) * expected,
             found << " " << expected);
}

BOOST_AUTO_TEST_CASE(its_p_value_is_even_where_nothing_differs) {
  Normal normal(2);
  const int trials = 400, permutations = 99;
  std::vector<double> p_values;
  for (int k = 0; k < trials; ++k)
    p_values.push_back(energy_test(sample(normal, 16, 2, 0), sample(normal, 16, 2, 0), permutations, 100 + k).p_value);
  std::sort(p_values.begin(), p_values.end());
  double farthest = 0;  // Kolmogorov's: from an even distribution, but for the steps of 1 / 100
  for (int k = 0; k < trials; ++k) farthest = std::max(farthest, std::abs(p_values[k] - (k + 0.5) / trials));
  BOOST_TEST(farthest < 1.63 / std::sqrt(trials) + 1.0 / (permutations + 1));  // at the level of one in a hundred
}

BOOST_AUTO_TEST_CASE(its_p_value_is_small_where_one_is_shifted) {
  Normal normal(3);
  int found = 0;
  const int trials = 50;
  for (int k = 0; k < trials; ++k)
    found += energy_test(sample(normal, 32, 2, 0), sample(normal, 32, 2, 1), 199, 200 + k).p_value <= 0.01;
  BOOST_TEST(found >= 0.9 * trials);
}

BOOST_AUTO_TEST_SUITE_END()
