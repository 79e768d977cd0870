#include "cases/analysis/fitting/bootstrap.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_fitting_bootstrap)

namespace {

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }
double normal(std::mt19937_64& random) {
  return std::sqrt(-2 * std::log(1 - uniform(random))) * std::cos(2 * M_PI * uniform(random));
}

// Each trial's loss is the squared distance from its own number; the fitted value is their mean.
LossesOfTrials losses_of(const std::vector<double>& numbers) {
  return [numbers](const std::vector<BoxPoint>& points) {
    std::vector<std::vector<double>> losses;
    for (const BoxPoint& point : points) {
      losses.emplace_back();
      for (const double number : numbers) losses.back().push_back(std::pow(point[0] - number, 2));
    }
    return losses;
  };
}

double mean_of(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number;
  return sum / static_cast<double>(numbers.size());
}

}  // namespace

// The interval of a mean is known: plus and minus the quantile of Student's distribution times the standard error.
BOOST_AUTO_TEST_CASE(of_a_mean_the_interval_is_students) {
  std::mt19937_64 random(3);
  std::vector<double> numbers;
  for (int i = 0; i < 40; ++i) numbers.push_back(0.5 + 0.02 * normal(random));
  const double mean = mean_of(numbers);
  double squares = 0;
  for (const double number : numbers) squares += std::pow(number - mean, 2);
  const double half = 2.0227 * std::sqrt(squares / 39 / 40);  // of 39 degrees of freedom
  const Bootstrap found = bootstrap_around({mean}, losses_of(numbers), 1);
  // A thousand draws give a percentile to 5 %; two of these make the bound.
  BOOST_TEST(std::abs(found.axes[0].low - (mean - half)) < 0.1 * half);
  BOOST_TEST(std::abs(found.axes[0].high - (mean + half)) < 0.1 * half);
  BOOST_TEST(found.axes[0].is_curved);
}

// Of 400 intervals of ten trials each 95 % must hold the true value: 92 to 98 %, three standard errors of 1.1 %.
BOOST_AUTO_TEST_CASE(intervals_cover_the_true_value_as_often_as_they_say) {
  std::mt19937_64 random(5);
  int covered = 0;
  constexpr int kRepeats = 400;
  for (int i = 0; i < kRepeats; ++i) {
    std::vector<double> numbers;
    for (int k = 0; k < 10; ++k) numbers.push_back(0.4 + 0.03 * normal(random));
    const Bootstrap found = bootstrap_around({mean_of(numbers)}, losses_of(numbers), static_cast<unsigned long>(i));
    covered += found.axes[0].low <= 0.4 && 0.4 <= found.axes[0].high;
  }
  BOOST_TEST(covered >= 0.92 * kRepeats);
  BOOST_TEST(covered <= 0.98 * kRepeats);
}

BOOST_AUTO_TEST_CASE(an_axis_that_nothing_depends_on_is_flat) {
  const auto losses = [](const std::vector<BoxPoint>& points) {
    std::vector<std::vector<double>> all;
    for (const BoxPoint& point : points) {
      all.emplace_back();
      for (int k = 0; k < 12; ++k) all.back().push_back(std::pow(point[0] - 0.4 - 0.01 * k, 2));
    }
    return all;
  };
  const Bootstrap found = bootstrap_around({0.455, 0.5}, losses, 1);
  BOOST_TEST(found.axes[0].is_curved);
  BOOST_TEST(!found.axes[1].is_curved);
}

// Only the sum of the two matters: each alone is not known, and they move against each other.
BOOST_AUTO_TEST_CASE(values_that_only_matter_together_are_correlated) {
  const auto losses = [](const std::vector<BoxPoint>& points) {
    std::vector<std::vector<double>> all;
    for (const BoxPoint& point : points) {
      all.emplace_back();
      for (int k = 0; k < 20; ++k) {
        const double sum = 0.9 + 0.001 * (k % 5), difference = 0.1 * (k % 4) - 0.15;
        all.back().push_back(std::pow(point[0] + point[1] - sum, 2) +
                             0.01 * std::pow(point[0] - point[1] - difference, 2));
      }
    }
    return all;
  };
  const Bootstrap found = bootstrap_around({0.451, 0.451}, losses, 2);
  BOOST_TEST(found.correlations[0][1] < -0.95);
  BOOST_TEST(found.correlations[0][0] == 1);
}

BOOST_AUTO_TEST_SUITE_END()
