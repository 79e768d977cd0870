// tube on runs beside, behind and ahead of a truth that moves evenly: 10 m in 1 s, so that the tube is 0.1 m wide.
#include <boost/test/unit_test.hpp>

#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_tube)

namespace {

BodyState at_place(double x, double y = 0, double turned = 0) {
  BodyState state;
  state.position = {x, y, 0}, state.velocity = {10, 0, 0};
  state.orientation = rotation_by({0, 0, turned});
  return state;
}

BodyState moving(double t) { return at_place(10 * t); }

Measurement tube_of(const std::function<BodyState(double)>& run_motion, double good_until = 1e9) {
  Scene scene;
  scene.bodies = {test::body("b", 2, {1, 2, 3})};
  const test::StatedTruth truth(moving, good_until), run(run_motion);
  const Trajectory trajectory = test::played(run, scene, 0.1, 10);
  const TruthSamples samples = test::sampled(truth, trajectory, scene, 1);
  const MetricResult result = test::measured("tube", {scene, trajectory, &samples, 0});
  BOOST_TEST_REQUIRE(result.measurement.has_value(), result.not_applicable);
  return *result.measurement;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_run_beside_the_truth_is_inside_up_to_a_hundredth_of_its_extent) {
  BOOST_TEST(tube_of([](double t) { return at_place(10 * t, 0.0999); }).value == 1);
  BOOST_TEST(tube_of([](double t) { return at_place(10 * t, 0.0999); }).worst.time == 0);  // which it never leaves
  const Measurement outside = tube_of([](double t) { return at_place(10 * t, t > 0.45 ? 0.1001 : 0); });
  BOOST_TEST(outside.value == 5.0 / 11);  // eleven samples, the first five of them inside
  BOOST_TEST(outside.worst.time == 0.5, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(outside.worst.found == 1.001, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(a_run_may_be_a_step_late_or_early_and_a_tolerance_more) {
  // Before the start there is no truth, so a late run waits there.
  const auto late_by = [](double lag) { return [lag](double t) { return moving(std::max(0.0, t - lag)); }; };
  BOOST_TEST(tube_of(late_by(0.1099)).value == 1);
  BOOST_TEST(tube_of(late_by(0.1101)).value == 2.0 / 11);  // the start and one step, still there
  const auto early_by = [](double lead) { return [lead](double t) { return moving(std::min(1.0, t + lead)); }; };
  BOOST_TEST(tube_of(early_by(0.1099)).value == 1);
  BOOST_TEST(tube_of(early_by(0.1101)).value == 2.0 / 11);  // the end, and one step before it
}

BOOST_AUTO_TEST_CASE(a_turn_of_a_hundredth_of_half_a_turn_is_inside) {
  BOOST_TEST(tube_of([](double t) { return at_place(10 * t, 0, 0.0314); }).value == 1);
  BOOST_TEST(tube_of([](double t) { return at_place(10 * t, 0, -0.0315); }).value == 0);
  // Both count together: .8 of one tolerance and .7 of the other are further than 1.
  BOOST_TEST(tube_of([](double t) { return at_place(10 * t, 0.08, 0.7 * 0.0314); }).value == 0);
}

BOOST_AUTO_TEST_CASE(a_body_at_rest_has_a_millimetre) {
  Scene scene;
  scene.bodies = {test::body("b", 2, {1, 2, 3})};
  const test::StatedTruth truth([](double) { return BodyState(); });
  for (const double off : {0.99e-3, 1e-3, 1.01e-3}) {
    const test::StatedTruth run([off](double) { return at_place(off); });
    const Trajectory trajectory = test::played(run, scene, 0.1, 10);
    const TruthSamples samples = test::sampled(truth, trajectory, scene, 1);
    const MetricResult result = test::measured("tube", {scene, trajectory, &samples, 0});
    BOOST_TEST(result.measurement->value == (off <= 1e-3 ? 1 : 0));
  }
}

BOOST_AUTO_TEST_CASE(the_share_is_of_the_time_the_truth_vouches_for) {
  // Good until 0.5 s, six samples; the extent is then 5 m and the tube half as wide.
  const Measurement m = tube_of([](double t) { return at_place(10 * t, t > 0.35 ? 0.06 : 0.04); }, 0.501);
  BOOST_TEST(m.value == 4.0 / 6);
  BOOST_TEST(m.compared_until == 0.5, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(a_run_that_is_lost_is_outside) {
  BOOST_TEST(tube_of([](double t) { return at_place(t > 0 ? 1e300 : 0); }).value == 1.0 / 11);
}

BOOST_AUTO_TEST_SUITE_END()
