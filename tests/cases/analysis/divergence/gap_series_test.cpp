// The gap over time: what its thinning keeps, against every sample.
#include "cases/analysis/divergence/gap_series.h"

#include <boost/test/unit_test.hpp>

#include "tests/scenes.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_analysis_divergence_gap_series)

namespace {

void append(StateSeries& motion, const Vec3& position) {
  const double rotation[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  motion.states.insert(motion.states.end(), position.data(), position.data() + 3);
  motion.states.insert(motion.states.end(), std::begin(rotation), std::end(rotation));
  motion.states.insert(motion.states.end(), 6, 0.0);
}

// One body that rests in A and is at `heights` in B. The bound is 1 m, so that a height is a share.
struct Compared {
  Scene scene;
  StateSeries in_a, in_b;
  PartingBounds bounds;
  std::optional<Parting> parting;
  GapSeries series;

  explicit Compared(const std::vector<double>& heights, double seconds = 0.25) {
    scene.bodies = {body("one", 1, {1, 1, 1})};
    bounds.position = 1;
    for (const double height : heights) append(in_a, Vec3::Zero()), append(in_b, Vec3(0, 0, height));
    const MotionView a(in_a, 1), b(in_b, 1);
    parting = find_parting(a, b, scene, bounds, seconds, {});
    series = gap_series(a, b, scene, bounds, seconds, parting);
  }
  // The share at a sample; -1 if the sample is not kept.
  double at(std::size_t sample) const {
    for (std::size_t n = 0; n < series.time.size(); ++n) {
      if (series.time[n] == 0.25 * static_cast<double>(sample)) return series.share[n];
    }
    return -1;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_short_series_is_whole) {
  const Compared found({0, 0.25, -0.5, 2});
  BOOST_TEST((found.series.time == std::vector<double>{0, 0.25, 0.5, 0.75}));
  BOOST_TEST((found.series.share == std::vector<double>{0, 0.25, 0.5, 2}));
}

BOOST_AUTO_TEST_CASE(no_peak_is_lost_and_every_sample_is_one_of_the_motion) {
  std::vector<double> heights(100000, 0.125);
  heights[7] = 0.75, heights[12345] = 0.875, heights[60000] = 3, heights[99998] = 50;
  const Compared found(heights);
  BOOST_TEST_REQUIRE(found.parting.has_value());
  BOOST_TEST(found.parting->sample == 60000u);
  BOOST_TEST(found.series.time.size() <= 404u);
  BOOST_TEST(found.series.time.size() >= 400u);
  for (const std::size_t sample : {0, 7, 12345, 59999, 60000, 99998, 99999})
    BOOST_TEST(found.at(sample) == heights[sample], "sample " << sample);
  for (std::size_t n = 0; n < found.series.time.size(); ++n) {
    BOOST_TEST(found.series.share[n] == heights[static_cast<std::size_t>(4 * found.series.time[n])]);
    if (n > 0) BOOST_TEST(found.series.time[n - 1] < found.series.time[n]);
  }
}

BOOST_AUTO_TEST_CASE(an_early_parting_has_all_its_samples) {
  std::vector<double> heights(50000, 9);
  for (std::size_t n = 0; n < 100; ++n) heights[n] = 0.001 * static_cast<double>(n);
  const Compared found(heights);
  for (std::size_t n = 0; n <= 100; ++n) BOOST_TEST(found.at(n) == heights[n], "sample " << n);
}

BOOST_AUTO_TEST_CASE(runs_that_never_part_keep_their_largest_gap) {
  std::vector<double> heights(3000, 0.5);
  heights[1700] = 0.96875;
  const Compared found(heights);
  BOOST_TEST(!found.parting.has_value());
  BOOST_TEST(found.at(1700) == 0.96875);
  BOOST_TEST(found.series.time.size() <= 404u);
}

BOOST_AUTO_TEST_CASE(no_samples_are_no_series) { BOOST_TEST(Compared({}).series.time.empty()); }

BOOST_AUTO_TEST_SUITE_END()
