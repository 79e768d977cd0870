#include <boost/test/unit_test.hpp>

#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_cost)

BOOST_AUTO_TEST_CASE(the_cost_is_cpu_time_per_time_simulated) {
  Scene scene;
  scene.bodies = {test::body("b", 2, {1, 2, 3})};
  const test::StatedTruth still([](double) { return BodyState(); });
  const Trajectory trajectory = test::played(still, scene, 0.5, 8);
  JudgedRun run{scene, trajectory, nullptr, 0};
  BOOST_TEST(test::measured("cost", run).not_applicable == "the run's steps were not timed");
  run.cpu_seconds = 2e-3;
  BOOST_TEST(test::measured("cost", run).measurement->value == 0.5e-3);
  const Trajectory one_step = test::played(still, scene, 0.5, 1), none = test::played(still, scene, 0.5, 0);
  JudgedRun shortest{scene, one_step, nullptr, 0}, empty{scene, none, nullptr, 0};
  shortest.cpu_seconds = empty.cpu_seconds = 2e-3;
  BOOST_TEST(test::measured("cost", shortest).measurement->value == 4e-3);
  BOOST_TEST(test::measured("cost", empty).not_applicable == "the run has no finite step");
}

BOOST_AUTO_TEST_SUITE_END()
