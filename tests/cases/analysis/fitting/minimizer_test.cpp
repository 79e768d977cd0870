#include "cases/analysis/fitting/minimizer.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_fitting_minimizer)

BOOST_AUTO_TEST_CASE(a_latin_hypercube_has_one_point_in_each_layer_of_each_axis) {
  const auto points = latin_hypercube(17, 3, 4);
  BOOST_TEST_REQUIRE(points.size() == 17u);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<int> layers;
    for (const BoxPoint& point : points) layers.push_back(static_cast<int>(17 * point[axis]));
    std::sort(layers.begin(), layers.end());
    for (int i = 0; i < 17; ++i) BOOST_TEST(layers[static_cast<std::size_t>(i)] == i);
  }
  BOOST_TEST((latin_hypercube(17, 3, 4) == points));
  BOOST_TEST((latin_hypercube(17, 3, 5) != points));
}

BOOST_AUTO_TEST_CASE(finds_the_minimum_of_rosenbrocks_valley) {
  const auto valley = [](const BoxPoint& x) {
    const double a = 3 * x[0] - 1, b = 3 * x[1] - 1;  // the minimum at a = b = 1
    return 100 * std::pow(b - a * a, 2) + std::pow(1 - a, 2);
  };
  const BoxMinimum found = nelder_mead(valley, {{0.1, 0.9}, valley({0.1, 0.9})}, {0.15, 1e-8, 2000});
  BOOST_TEST(std::abs(found.at[0] - 2.0 / 3) < 1e-6);
  BOOST_TEST(std::abs(found.at[1] - 2.0 / 3) < 1e-6);
}

BOOST_AUTO_TEST_CASE(finds_a_minimum_on_a_face_of_the_box_and_never_leaves_it) {
  bool is_inside = true;
  const auto slope = [&](const BoxPoint& x) {
    for (const double one : x) is_inside &= one >= 0 && one <= 1;
    return x[0] + std::pow(x[1] - 0.3, 2);
  };
  const BoxMinimum found = nelder_mead(slope, {{0.5, 0.5}, slope({0.5, 0.5})}, {0.15, 1e-6, 500});
  BOOST_TEST(is_inside);
  BOOST_TEST(found.at[0] < 1e-5);
  BOOST_TEST(std::abs(found.at[1] - 0.3) < 1e-3);
}

BOOST_AUTO_TEST_CASE(keeps_to_its_number_of_evaluations) {
  std::size_t count = 0;
  const auto function = [&](const BoxPoint& x) { return ++count, std::abs(x[0] - 0.123456); };
  nelder_mead(function, {{0.9}, 1}, {0.1, 0, 50});
  BOOST_TEST(count >= 50u);
  BOOST_TEST(count <= 53u);  // a step that has begun ends
}

BOOST_AUTO_TEST_CASE(starts_are_the_best_points_that_lie_apart) {
  const auto starts = distinct_starts({{{0.5}, 2}, {{0.1}, 1}, {{0.15}, 1.5}, {{0.9}, 3}, {{0.7}, 9}}, 3, 0.2);
  BOOST_TEST_REQUIRE(starts.size() == 3u);
  BOOST_TEST(starts[0].at[0] == 0.1);
  BOOST_TEST(starts[1].at[0] == 0.5);
  BOOST_TEST(starts[2].at[0] == 0.9);
}

BOOST_AUTO_TEST_SUITE_END()
