// KEY=VALUES, and the points of a sample.
#include "cases/analysis/sweep/sweep_axis.h"

#include <boost/test/unit_test.hpp>
#include <set>

#include "core/base/error.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_sweep_axis)
using Values = std::vector<std::string>;

BOOST_AUTO_TEST_CASE(lists_and_ranges_are_read) {
  BOOST_TEST(parse_axis("iterations=10,20,50", false).values == (Values{"10", "20", "50"}));
  BOOST_TEST(parse_axis("erp=0.1..0.9:9", false).values ==
             (Values{"0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9"}));
  BOOST_TEST(parse_axis("dt=1/1000..1/10:log:3", false).values == (Values{"0.001", "0.01", "0.1"}));
  BOOST_TEST(parse_axis("dt=1/30,1/60", false).values == (Values{"1/30", "1/60"}));
  BOOST_TEST(parse_axis("gyroscopic=on,off", false).values == (Values{"on", "off"}));
  BOOST_TEST(parse_axis("scene.spring[0].stiffness=1e2..1e6:log:5", false).values ==
             (Values{"100", "1000", "10000", "100000", "1000000"}));
  BOOST_TEST(parse_axis("scene.gravity[1]=-9.8..0:2", false).values == (Values{"-9.8", "0"}));
  BOOST_TEST(parse_axis("scene.x.y=1/4", false).values == Values{"0.25"});
  BOOST_TEST(parse_axis("dt=1/1000..1/10:log:20", false).values.size() == 20u);
  BOOST_TEST(parse_axis("erp=0.1..0.9", true).from == 0.1);
}

BOOST_AUTO_TEST_CASE(what_is_neither_is_refused_with_the_reason) {
  const std::pair<const char*, const char*> rows[] = {
      {"erp=0.9..0.1:9", "wrong way round; give 0.1..0.9"},
      {"dt=1/10..1/1000:log:20", "wrong way round"},
      {"erp=0.5..0.5:3", "begins where it ends"},
      {"erp=0..1:log:3", "begins above 0"},
      {"erp=0.1..0.9", "no count"},
      {"erp=0.1..0.9:1", "count of '1'"},
      {"erp=0.1..0.9:2.5", "count of '2.5'"},
      {"erp=0.1..0.9:1e9", "count of '1e9'"},
      {"erp=0.1..0.9:lin:3", "no scale 'lin'"},
      {"erp=0.1..0.9:log:3:4", "'4' behind the count"},
      {"erp=a..b:3", "no range of numbers"},
      {"erp=0.1..:3", "no range of numbers"},
      {"erp", "no key, or no values"},
      {"erp=", "no key, or no values"},
      {"=1", "no key, or no values"},
      {"erp=1,,2", "empty value"},
      {"iterations=10,10", "given twice"},
      {"dt=fast", "no number"},
      {"scene.x.y=1/0", "no number"},
      {"scene.x.y=nan", "no number"},
      {"scene.x.y=1e999", "no number"},
  };
  for (const auto& [text, expected] : rows) {
    BOOST_CHECK_EXCEPTION(parse_axis(text, false), InputError, [&](const InputError& error) {
      const bool is_said = std::string(error.what()).find(expected) != std::string::npos;
      BOOST_TEST(is_said, error.what());
      return is_said && std::string(error.what()).find(text) != std::string::npos;
    });
  }
}

BOOST_AUTO_TEST_CASE(whole_values_are_rounded_and_each_once) {
  SweepAxis axis = parse_axis("iterations=1..10:log:7", false);
  make_whole(axis);
  BOOST_TEST(axis.values == (Values{"1", "2", "3", "5", "7", "10"}));  // 1 1.47 2.15 3.16 4.64 6.81 10
}

// The same seed draws the same points, another seed other points, and the points fill the space. The first 256 points
// of a two-dimensional Sobol sequence put one into each of 16 × 16 boxes. After a shift each still has only a few.
BOOST_AUTO_TEST_CASE(samples_fill_the_space_and_follow_from_the_seed) {
  const auto points = sample_points(256, 2, 7);
  BOOST_TEST((points == sample_points(256, 2, 7)));
  BOOST_TEST((points != sample_points(256, 2, 8)));
  std::set<std::pair<int, int>> boxes;
  for (const auto& point : points) {
    BOOST_TEST((point[0] >= 0 && point[0] < 1 && point[1] >= 0 && point[1] < 1));
    boxes.insert({static_cast<int>(point[0] * 8), static_cast<int>(point[1] * 8)});
  }
  BOOST_TEST(boxes.size() == 64u);  // of 8 × 8, every one; of as many drawn at random 1.8 % would be missed
}

BOOST_AUTO_TEST_SUITE_END()
