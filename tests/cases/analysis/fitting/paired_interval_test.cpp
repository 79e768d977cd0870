#include "cases/analysis/fitting/paired_interval.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_fitting_paired_interval)

namespace {

// Where the trials' own minima lie: about 0.4.
std::vector<double> minima_of_trials(std::size_t count) {
  std::mt19937_64 random(7);
  std::vector<double> minima;
  for (std::size_t t = 0; t < count; ++t) {
    double sum = -6;  // nearly normal, of deviation 1
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(random() >> 11) * 0x1p-53;
    minima.push_back(0.4 + 0.2 * sum);
  }
  return minima;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double error_of_mean(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += (value - mean_of(values)) * (value - mean_of(values));
  const auto n = static_cast<double>(values.size());
  return std::sqrt(squares / (n - 1) / n);
}

// `loss`: of a trial whose minimum is c, at a point.
LossesOfTrials losses_by(const std::vector<double>& minima,
                         const std::function<double(const BoxPoint&, double)>& loss) {
  return [=](const std::vector<BoxPoint>& points) {
    std::vector<std::vector<double>> all;
    for (const BoxPoint& point : points) {
      all.emplace_back();
      for (const double c : minima) all.back().push_back(loss(point, c));
    }
    return all;
  };
}

}  // namespace

// The best value is the mean of the trials' minima, and its standard error is known. Three halvings leave an eighth of
// the way to the end of the range, and the end that is told lies outside.
BOOST_AUTO_TEST_CASE(of_parabolas_it_is_the_interval_of_the_mean) {
  const std::vector<double> minima = minima_of_trials(100);
  const double best = mean_of(minima), error = error_of_mean(minima);
  const auto found = paired_interval(
      {best}, 0, losses_by(minima, [](const BoxPoint& x, double c) { return (x[0] - c) * (x[0] - c); }));
  BOOST_TEST(!found.is_low_open);
  BOOST_TEST(!found.is_high_open);
  const double low = best - 1.96 * error - found.low, high = found.high - (best + 1.96 * error);
  BOOST_TEST((low > -1e-3 && low < best / 8));
  BOOST_TEST((high > -1e-3 && high < (1 - best) / 8));
}

// A second value that makes up for the first: along x + y = const nothing changes but by a tenth of the curvature. The
// first is then known only as well as that tenth tells, with the other fitted again.
BOOST_AUTO_TEST_CASE(other_values_are_fitted_again) {
  const std::vector<double> minima = minima_of_trials(400);
  const double best = mean_of(minima), error = error_of_mean(minima);
  const auto loss = [](const BoxPoint& p, double c) {
    const double sum = p[0] + p[1] - 2 * c, difference = p[0] - c;
    return sum * sum + 0.1 * difference * difference;
  };
  const auto found = paired_interval({best, best}, 0, losses_by(minima, loss));
  // With the second value free, the trials' differences are those of 0.1 (x - c)² alone: the same interval as alone.
  const double high = found.high - (best + 1.96 * error);
  BOOST_TEST((high > -0.02 && high < (1 - best) / 8 + 0.02));  // the search for the second value ends at 1e-2
  BOOST_TEST(found.low < best);
}

BOOST_AUTO_TEST_CASE(a_range_whose_ends_fit_as_well_is_open) {
  const std::vector<double> minima = minima_of_trials(50);
  const auto flat = paired_interval({0.4}, 0, losses_by(minima, [](const BoxPoint&, double c) { return c * c; }));
  BOOST_TEST(flat.is_low_open);
  BOOST_TEST(flat.is_high_open);
  // Nothing on one side, far worse on the other.
  const auto half = paired_interval(
      {0.4}, 0, losses_by(minima, [](const BoxPoint& x, double c) { return x[0] > 0.4 ? 10 * (x[0] - 0.4) + c : c; }));
  BOOST_TEST(half.is_low_open);
  BOOST_TEST(!half.is_high_open);
  BOOST_TEST(half.high < 0.4 + 0.6 / 8 + 1e-12);
}

BOOST_AUTO_TEST_SUITE_END()
