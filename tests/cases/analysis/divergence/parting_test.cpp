// Bounds of rigor diverge, and the instant and component in which two motions leave them.
#include "cases/analysis/divergence/parting.h"

#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "tests/scenes.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_analysis_divergence_parting)

namespace {

void add_row(StateSeries& motion, const BodyState& state) {
  const Mat3 R = matrix_of(state.orientation);
  for (int k = 0; k < 3; ++k) motion.states.push_back(state.position[k]);
  for (int k = 0; k < 9; ++k) motion.states.push_back(R(k / 3, k % 3));
  for (int k = 0; k < 3; ++k) motion.states.push_back(state.velocity[k]);
  for (int k = 0; k < 3; ++k) motion.states.push_back(state.angular_velocity[k]);
}

// Two bodies; in the n-th sample the second has moved by n `move` and turned by n `turn`.
StateSeries drifting(const Vec3& move, const Vec3& turn) {
  StateSeries motion;
  for (int n = 0; n < 10; ++n) {
    add_row(motion, {Vec3(1, 2, 3)});
    add_row(motion, {Vec3(4, 5, 6) + n * move, rotation_by(n * turn)});
  }
  return motion;
}

std::optional<Parting> parted(const StateSeries& b, const std::string& bound, const std::vector<double>& spread = {}) {
  Scene scene;
  scene.bodies = {body("one", 1, {1, 1, 1}), body("two", 1, {1, 1, 1})};
  const StateSeries a = drifting(Vec3::Zero(), Vec3::Zero());
  return find_parting(MotionView(a, 2), MotionView(b, 2), scene, parse_parting_bounds({bound}), 0.5, spread);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_first_sample_beyond_the_bound_counts) {
  const auto found = parted(drifting({0, -0.4e-3, 0}, Vec3::Zero()), "1mm");
  BOOST_TEST_REQUIRE(found.has_value());
  BOOST_TEST(found->sample == 3u);
  BOOST_TEST(found->time == 1.5);
  BOOST_TEST(found->body == 1);
  BOOST_TEST(found->component == "py");
  BOOST_TEST(found->part == -1.2e-3, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(*found->in_a == 5);
}

BOOST_AUTO_TEST_CASE(a_turn_has_its_axis) {
  const auto found = parted(drifting(Vec3::Zero(), {0, 0, 0.3e-3}), "1mrad");
  BOOST_TEST_REQUIRE(found.has_value());
  BOOST_TEST(found->sample == 4u);
  BOOST_TEST(found->component == "turn about z");
  BOOST_TEST(found->part == 1.2e-3, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(!parted(drifting(Vec3::Zero(), {0, 0, 0.3e-3}), "1m").has_value());  // which no one asked for
}

BOOST_AUTO_TEST_CASE(what_repeats_of_a_run_differ_by_is_no_parting) {
  const std::vector<double> wide(10, 0.9), narrow(10, 0.5);
  BOOST_TEST(!parted(drifting({0.29e-3, 0, 0}, Vec3::Zero()), "1mm", wide).has_value());  // 9 × 0.29 < 3 × 0.9
  BOOST_TEST(parted(drifting({0.4e-3, 0, 0}, Vec3::Zero()), "1mm", narrow)->sample == 4u);
}

BOOST_AUTO_TEST_CASE(a_bound_says_its_unit_and_quantity) {
  const PartingBounds bounds = parse_parting_bounds({"position=2cm", "0.5 deg", "velocity=1mm/s"});
  BOOST_TEST(bounds.position == 0.02, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(bounds.orientation == 0.008726646, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(bounds.velocity == 1e-3, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(bounds.angular_velocity == PartingBounds::kNone);
}

BOOST_AUTO_TEST_CASE(what_is_no_bound_is_refused) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> rows = {
      {{"1"}, "no unit"},
      {{"position=1"}, "no unit"},
      {{"position=1mrad"}, "'mrad' is a unit of orientation"},
      {{"positon=1mm"}, "did you mean 'position'"},
      {{"0mm"}, "greater than 0"},
      {{"-1mm"}, "greater than 0"},
      {{"mm"}, "no number"},
      {{"1furlong"}, "unit is 'furlong'"},
      {{"1mm", "2cm"}, "bounded twice"},
      {{"nanmm"}, "greater than 0"}};
  for (const auto& [texts, expected] : rows) {
    BOOST_CHECK_EXCEPTION(parse_parting_bounds(texts), InputError, [&](const InputError& error) {
      BOOST_TEST_INFO(error.what());
      return std::string(error.what()).find(expected) != std::string::npos;
    });
  }
}

BOOST_AUTO_TEST_CASE(the_default_bound_follows_the_size_of_the_scene) {
  Scene scene;
  scene.bodies = {body("a", 1, {1, 1, 1}), body("b", 1, {1, 1, 1}, {0, 3, 4})};
  BOOST_TEST(default_parting_bounds(scene).position == 5e-3);
  BOOST_TEST(default_parting_bounds(scene).orientation == 1e-3);
  scene.bodies.pop_back();
  scene.bodies[0].shape = Sphere{0.1};
  BOOST_TEST(scene_size(scene) == 0.2);
  // The world's ground has no size.
  BOOST_TEST(scene_size(dropped_sphere(0)) == 0.2);
}

BOOST_AUTO_TEST_SUITE_END()
