#include "cases/report/html/thinning.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_html_thinning)

namespace {

// Of a series of values, in units of `seen`.
Deviation deviation_of(const std::vector<double>& values, double seen) {
  return [&values, seen](std::size_t i, std::size_t a, std::size_t b) {
    const double share = static_cast<double>(i - a) / static_cast<double>(b - a);
    return std::abs(values[i] - values[a] - share * (values[b] - values[a])) / seen;
  };
}

// The largest distance between the series and straight lines through the kept samples, found sample by sample.
double largest_gap(const std::vector<double>& values, const std::vector<std::size_t>& kept) {
  double largest = 0;
  for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
    for (std::size_t i = kept[k]; i <= kept[k + 1]; ++i) {
      const double slope = (values[kept[k + 1]] - values[kept[k]]) / static_cast<double>(kept[k + 1] - kept[k]);
      largest = std::max(largest, std::abs(values[i] - values[kept[k]] - slope * static_cast<double>(i - kept[k])));
    }
  }
  return largest;
}

// |sin|: a kink, like an impact, wherever it is zero.
std::vector<double> bounces() {
  std::vector<double> values;
  for (int i = 0; i <= 2000; ++i) values.push_back(std::abs(std::sin(i * 0.01)));
  return values;
}

}  // namespace

BOOST_AUTO_TEST_CASE(lines_between_kept_samples_stay_as_close_as_asked) {
  const auto values = bounces();
  for (const double seen : {0.1, 0.01, 0.001}) {
    const auto kept = first_samples(ranked_samples(values.size(), 5000, deviation_of(values, seen)), 5000);
    BOOST_TEST(largest_gap(values, kept) <= seen * (1 + 1e-9));
    BOOST_TEST(kept.size() < values.size() / 4);
    BOOST_TEST(kept.front() == 0u);
    BOOST_TEST(kept.back() == values.size() - 1);
  }
}

BOOST_AUTO_TEST_CASE(impacts_come_before_all_else) {
  const auto values = bounces();
  const auto kept = first_samples(ranked_samples(values.size(), 20, deviation_of(values, 1e-3)), 20);
  for (int kink = 1; kink <= 6; ++kink) {
    const double at = kink * std::acos(-1) / 0.01;
    const bool is_kept = std::any_of(kept.begin(), kept.end(), [&](std::size_t i) { return std::abs(i - at) <= 2; });
    BOOST_TEST(is_kept, "the impact near sample " << at << " is lost");
  }
}

BOOST_AUTO_TEST_CASE(short_and_straight_series_keep_their_ends) {
  const std::vector<double> line = {0, 1, 2, 3};
  BOOST_TEST(ranked_samples(0, 9, deviation_of(line, 1)).empty());
  BOOST_TEST(ranked_samples(1, 9, deviation_of(line, 1)).size() == 1u);
  BOOST_TEST(ranked_samples(4, 9, deviation_of(line, 0.01)).size() == 2u);
}

BOOST_AUTO_TEST_SUITE_END()
