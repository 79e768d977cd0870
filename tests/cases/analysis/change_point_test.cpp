// Changes of level: how few values show one, and how often noise alone looks like one. Rates come from simulation with
// fixed seeds, and for Student's statistic also from its exact distribution.
#include "cases/analysis/change_point.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_change_point)

namespace {

enum class NoiseShape { normal, even, exponential, outliers, spikes };

// Noise of standard deviation 1 and of this autocorrelation from one value to the next. std::mt19937_64 gives the same
// numbers everywhere; the standard distributions do not.
class Noise {
 public:
  Noise(NoiseShape shape, double correlation, unsigned long seed)
      : shape_(shape), correlation_(correlation), random_(seed) {}

  std::vector<double> series(std::size_t count) {
    constexpr int kSettling = 40;  // 0.7^40 is 6e-7
    std::vector<double> values;
    double last = 0;
    for (std::size_t i = 0; i < count + kSettling; ++i) {
      last = correlation_ * last + std::sqrt(1 - correlation_ * correlation_) * innovation();
      if (i >= kSettling) values.push_back(last + spike());
    }
    return values;
  }

 private:
  double even() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double normal() { return std::sqrt(-2 * std::log(1 - even())) * std::cos(2 * std::numbers::pi * even()); }
  double spike() { return shape_ == NoiseShape::spikes && even() < 0.05 ? 10 : 0; }  // of one value
  double innovation() {
    switch (shape_) {
      case NoiseShape::normal:
      case NoiseShape::spikes:
        return normal();
      case NoiseShape::even:
        return std::sqrt(12.0) * (even() - 0.5);
      case NoiseShape::exponential:
        return -std::log(1 - even()) - 1;
      case NoiseShape::outliers:  // one value in twenty is ten times as far off
        return (even() < 0.05 ? 10 : 1) * normal() / std::sqrt(0.95 + 0.05 * 100);
    }
    return 0;
  }
  NoiseShape shape_;
  double correlation_;
  std::mt19937_64 random_;
};

double rate_of_changes(Noise noise, std::size_t count, int series) {
  int found = 0;
  for (int i = 0; i < series; ++i) found += !change_points(noise.series(count)).empty();
  return static_cast<double>(found) / series;
}

std::vector<double> with_step(std::vector<double> values, std::size_t at, double scale, double step) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = scale * values[i] + (i >= at ? step : 0);
  return values;
}

// The share of fivefold steps at `at` that are found there alone, in the logarithms of values with this relative noise.
double share_found(std::size_t count, std::size_t at, double noise) {
  constexpr int kSeries = 1000;
  Noise source(NoiseShape::normal, 0.5, 11);
  int found = 0;
  for (int i = 0; i < kSeries; ++i)
    found += change_points(with_step(source.series(count), at, noise, std::log(5))) == std::vector<std::size_t>{at};
  return static_cast<double>(found) / kSeries;
}

// The probability that a weighted sum of squares of independent standard normal numbers is positive: J. P. Imhof,
// Biometrika 48 (1961) 419, formula 3.2, by the midpoint rule.
double chance_of_positive(const Eigen::VectorXd& weights) {
  constexpr double kStep = 0.002, kEnd = 400;  // in units of the largest weight; finer steps change the sixth digit
  const Eigen::VectorXd scaled = weights / weights.cwiseAbs().maxCoeff();
  double integral = 0;
  for (double u = kStep / 2; u < kEnd; u += kStep) {
    double angle = 0, product = 1;
    for (const double weight : scaled)
      angle += 0.5 * std::atan(weight * u), product *= std::pow(1 + weight * weight * u * u, 0.25);
    integral += kStep * std::sin(angle) / (u * product);
  }
  return 0.5 + integral / std::numbers::pi;
}

// The probability that Student's statistic at one split exceeds `most`, for normal noise of this autocorrelation: it
// does where z' M z > 0, M = w w' - most²/(n - 2) times the projection on the residuals.
double chance_of_student(int n, int split, double correlation, double most) {
  Eigen::MatrixXd covariance(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) covariance(i, j) = std::pow(correlation, std::abs(i - j));
  }
  Eigen::VectorXd first = Eigen::VectorXd::Zero(n), second = first;
  first.head(split).setConstant(1 / std::sqrt(double(split)));
  second.tail(n - split).setConstant(1 / std::sqrt(double(n - split)));
  const Eigen::VectorXd w = (second / std::sqrt(double(n - split)) - first / std::sqrt(double(split))) *
                            std::sqrt(double(split) * (n - split) / n);
  const Eigen::MatrixXd residuals =
      Eigen::MatrixXd::Identity(n, n) - first * first.transpose() - second * second.transpose();
  const Eigen::MatrixXd form = w * w.transpose() - most * most / (n - 2) * residuals;
  const Eigen::MatrixXd L = covariance.llt().matrixL();
  return chance_of_positive(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(L.transpose() * form * L).eigenvalues());
}

}  // namespace

// The fewest values, three on either side. A tenth is the noise of a busy machine.
BOOST_AUTO_TEST_CASE(six_values_show_a_fivefold_step) {
  BOOST_TEST(change_points({1, 1, 1, 5, 5, 5}) == (std::vector<std::size_t>{3}));
  BOOST_TEST(share_found(6, 3, 0.1) >= 0.99);
  for (const std::size_t count : {12u, 14u, 15u}) {
    for (std::size_t at = 3; at + 3 <= count; ++at) BOOST_TEST(share_found(count, at, 0.1) >= 0.97, count << " " << at);
  }
  for (const double noise : {0.03, 0.1, 0.2, 0.3}) {
    for (const std::size_t count : {6u, 8u, 10u, 12u, 16u, 24u})
      BOOST_TEST_MESSAGE(noise << " noise, " << count << " values: " << share_found(count, count / 2, noise));
  }
}

BOOST_AUTO_TEST_CASE(fewer_than_three_values_are_no_level) {
  BOOST_TEST(change_points({1, 1, 1, 1, 1, 1, 5, 5}).empty());
  BOOST_TEST(change_points({1, 1, 5, 5, 5}).empty());
  BOOST_TEST(change_points({}).empty());
  BOOST_TEST(change_points({1}).empty());
  BOOST_TEST(change_points(std::vector<double>(50, 1.0)).empty());
}

BOOST_AUTO_TEST_CASE(steps_beyond_the_noise_are_found_where_they_are) {
  Noise noise(NoiseShape::even, 0, 1);
  std::vector<double> values = with_step(with_step(noise.series(60), 20, 0.03, 0.3), 40, 1, -0.7);
  BOOST_TEST(change_points(values) == (std::vector<std::size_t>{20, 40}));
  // The first change is found in the second part: its index counts from the beginning.
  values = with_step(with_step(noise.series(60), 15, 0.03, 2), 30, 1, 0.3);
  BOOST_TEST(change_points(values) == (std::vector<std::size_t>{15, 30}));
}

// One step up and one down leave no single split that explains much.
BOOST_AUTO_TEST_CASE(a_step_that_is_taken_back_is_found) {
  Noise noise(NoiseShape::normal, 0.5, 2);
  BOOST_TEST(change_points(with_step(with_step(noise.series(50), 20, 0.1, 1.6), 30, 1, -1.6)) ==
             (std::vector<std::size_t>{20, 30}));
  BOOST_TEST(change_points(with_step(with_step(noise.series(24), 8, 0.05, 1.6), 16, 1, -1.6)) ==
             (std::vector<std::size_t>{8, 16}));
}

BOOST_AUTO_TEST_CASE(one_outlier_is_no_change_wherever_it_stands) {
  for (const std::size_t count : {8u, 30u, 200u}) {
    const std::vector<double> quiet = Noise(NoiseShape::even, 0, 3).series(count);
    for (std::size_t at = 0; at < count; ++at) {
      std::vector<double> values = quiet;
      values[at] = 1000;
      BOOST_TEST(change_points(values).empty(), count << " values, at " << at);
    }
  }
}

BOOST_AUTO_TEST_CASE(noise_below_the_least_is_no_change) {
  const std::vector<double> values = {1, 1, 1, 1.01, 1.01, 1.01};
  BOOST_TEST(change_points(values) == (std::vector<std::size_t>{3}));
  BOOST_TEST(change_points(values, 0.01).empty());
}

// The bound is 1 %. 1200 series with a true rate of 1 % show at most 1.7 % in 98 of 100 seeds.
BOOST_AUTO_TEST_CASE(noise_alone_changes_in_at_most_one_series_of_a_hundred) {
  constexpr int kSeries = 1200;
  constexpr double kMost = 0.017;
  for (const std::size_t count : {10u, 12u, 20u, 50u, 100u, 200u}) {
    for (const double correlation : {0.0, 0.3, 0.5}) {
      for (const NoiseShape shape :
           {NoiseShape::normal, NoiseShape::even, NoiseShape::exponential, NoiseShape::outliers, NoiseShape::spikes}) {
        const double rate = rate_of_changes(Noise(shape, correlation, 100 + count), count, kSeries);
        BOOST_TEST(rate <= kMost, count << " values, correlation " << correlation << ", shape " << int(shape));
        BOOST_TEST_MESSAGE(count << " values, correlation " << correlation << ", shape " << int(shape) << ": " << rate);
      }
    }
  }
}

// Not by simulation: the sum over all splits of the exact probabilities is an upper bound. Leaving out the values that
// favour a change makes the statistic smaller than Student's.
BOOST_AUTO_TEST_CASE(the_exact_distribution_of_students_statistic_bounds_the_rate) {
  constexpr double kMostWithin = 7.2;
  // Student's t with 4 degrees of freedom exceeds 4.604 in 1 % of both sides (tables of the distribution).
  BOOST_TEST(std::abs(chance_of_student(6, 3, 0, 4.604) - 0.01) < 1e-4);
  for (const int count : {6, 7, 8, 12, 20}) {
    double sum = 0;
    for (int split = 3; split + 3 <= count; ++split) sum += chance_of_student(count, split, 0.5, kMostWithin);
    const double rate = rate_of_changes(Noise(NoiseShape::normal, 0.5, 5), static_cast<std::size_t>(count), 20000);
    BOOST_TEST_MESSAGE(count << " values: at most " << sum << "; simulated " << rate);
    BOOST_TEST(sum <= 0.01, count);
    BOOST_TEST(rate <= sum + 0.0015, count);  // three standard deviations of 20000 series at 0.5 %
  }
}

// Each is found in what the one before left.
BOOST_AUTO_TEST_CASE(ever_smaller_changes_have_their_own_places) {
  std::vector<double> values;
  for (const double level : {0.0, 100.0, 110.0, 111.0}) values.insert(values.end(), 8, level);
  const std::vector<std::size_t> rising = change_points(values, 0), expected = {8, 16, 24};
  BOOST_TEST(rising == expected, boost::test_tools::per_element());
  std::reverse(values.begin(), values.end());
  BOOST_TEST(change_points(values, 0) == expected, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_SUITE_END()
