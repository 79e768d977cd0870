// Forces of pairs that statics determines, against reports with errors put there on purpose.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <set>

#include "cases/metrics/measures/contact/meeting_points.h"
#include "tests/cases/metrics/standing_run.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_contact_determined_pairs)

using namespace rigor;

namespace {

Body fixed_box(const std::string& name, const Vec3& size, const Vec3& position, double turned = 0) {
  Body made = test::on_its_own(name, Box{size}, 1, position);
  made.fixed = true;
  made.orientation = Quat(Eigen::AngleAxisd(turned, Vec3::UnitY()));
  return made;
}

constexpr int kBeam = 0, kLoad = 1, kLeft = 2, kRight = 3;
constexpr double kQuarter = 0.7853981633974483;  // rad

// A beam of 6 kg on two knife edges at x = -1 and 1 bears 3 kg at x = -1/3. With g = 10 m/s², the left edge carries
// 30 + 20 N and the right one 30 + 10 N.
Scene beam_on_scales(double friction) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("beam", Box{{2.4, 0.4, 0.1}}, 6, {0, 0, 0.05}),
                  test::on_its_own("load", Box{{0.2, 0.2, 0.2}}, 3, {-1.0 / 3, 0, 0.2}),
                  fixed_box("left", {0.1, 0.6, 0.1}, {-1, 0, -0.05 * std::sqrt(2.0)}, kQuarter),
                  fixed_box("right", {0.1, 0.6, 0.1}, {1, 0, -0.05 * std::sqrt(2.0)}, kQuarter)};
  scene.contact_default = {0, friction};
  return scene;
}

ReportedContact on(int first, int second, const Vec3& point, double force) {
  return {first, second, point, Vec3::UnitZ(), 0, {0, 0, force}};
}

Trajectory scales_that_say(const Scene& scene, double left, double right) {
  return test::standing(scene, 5, [=](int) {
    return std::vector{on(kLeft, kBeam, {-1, 0, 0}, left), on(kRight, kBeam, {1, 0, 0}, right),
                       on(kBeam, kLoad, {-1.0 / 3, 0, 0.1}, 30)};
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_shares_of_two_scales_are_compared_one_by_one) {
  for (const double friction : {0.0, 0.5}) {
    const Scene scene = beam_on_scales(friction);
    BOOST_TEST_CONTEXT("friction " << friction) {
      BOOST_TEST(test::value_of("contact_force_error", scene, scales_that_say(scene, 50, 40)) < 1e-9);
      // Swapped shares balance the forces, and not the moments.
      const Trajectory swapped = scales_that_say(scene, 40, 50);
      BOOST_TEST(std::abs(test::value_of("contact_force_error", scene, swapped) - 10) < 1e-9);
      BOOST_TEST(test::value_of("contact_balance", scene, swapped) < 1e-12);
      const Instant worst = test::result_of("contact_force_error", scene, swapped).measurement->worst;
      const bool has_note = worst.component.find("(not determined, or in part, at some steps: ") != std::string::npos;
      BOOST_TEST(has_note == (friction > 0), worst.component);
    }
  }
}

// The moments about the foot: N 2.4 m = W 0.326 m. The wall is smooth.
BOOST_AUTO_TEST_CASE(a_ladder_at_a_smooth_wall_is_determined) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body ladder = test::on_its_own("ladder", Box{{2.5, 0.4, 0.05}}, 10, {0.374 - 2e-12, 0, 1.207 - 2e-12});
  ladder.orientation = Quat(0.8, 0, 0.6, 0);
  scene.bodies = {ladder, test::plane(), test::plane(Vec3::UnitX())};
  scene.bodies[2].name = "wall";
  scene.contact_default = {0, 0.5};
  scene.contact_pairs = {{0, 2, {0, 0}}};
  const auto error = [&](double wall) {
    return test::value_of("contact_force_error", scene, test::standing(scene, 3, [=](int) {
                            return std::vector{ReportedContact{1, 0, {0.7, 0, 0}, Vec3::UnitZ(), 0, {-wall, 0, 98.1}},
                                               ReportedContact{2, 0, {0, 0, 2.4}, Vec3::UnitX(), 0, {wall, 0, 0}}};
                          }));
  };
  BOOST_TEST(error(13.32525) < 1e-8);
  BOOST_TEST(std::abs(error(12.32525) - 1) < 1e-8);  // the forces are balanced, and the moments are not
}

BOOST_AUTO_TEST_CASE(a_box_on_four_scales_has_no_result_and_says_why) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("table", Box{{1, 1, 0.2}}, 6, {0, 0, 0.1})};
  for (int leg = 0; leg < 4; ++leg)
    scene.bodies.push_back(fixed_box("scale " + std::to_string(leg), {0.1, 0.1, 0.1},
                                     {leg & 1 ? 0.4 : -0.4, leg & 2 ? 0.4 : -0.4, -0.05}));
  scene.contact_default = {0, 0.5};
  const Trajectory run = test::standing(scene, 3, [](int) { return std::vector<ReportedContact>(); });
  const MetricResult result = test::result_of("contact_force_error", scene, run);
  // Their sum along y and x is known, and no share.
  BOOST_TEST(!result.measurement.has_value());
  BOOST_TEST(result.not_applicable == "the equations of motion determine no pair's force");
  BOOST_TEST(test::result_of("force_peak", scene, run).not_applicable ==
             "statics determines no pair's force, or all are zero");
}

namespace {

// A ball of 2 kg meets the ground between two samples, at which it is 3 cm above it.
struct Bounce {
  Scene scene;
  Trajectory run;
};

Bounce bounce(double reported) {
  Bounce made;
  made.scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 0.53}), test::plane()};
  made.scene.bodies[0].velocity = {0, 0, -6};
  made.run = test::standing(made.scene, 2, [=](int n) {
    return n == 1 ? std::vector{ReportedContact{1, 0, Vec3::Zero(), Vec3::UnitZ(), 0, {0, 0, reported}}}
                  : std::vector<ReportedContact>();
  });
  for (std::size_t n : {1u, 2u}) {
    BodyTable bodies(made.run.samples[n].bodies.columns());
    bodies.columns().set_velocity(0, {0, 0, 6});
    bodies.columns().set_position(0, {0, 0, 0.53 + (n == 2 ? 0.06 : 0)});
    made.run.samples[n].bodies = KeptBodies(std::as_const(bodies).columns());
  }
  return made;
}

}  // namespace

// 2 kg turn round from -6 to 6 m/s within 0.01 s.
BOOST_AUTO_TEST_CASE(an_impact_between_two_samples_is_due) {
  const Bounce right = bounce(2400), wrong = bounce(2000);
  BOOST_TEST(test::value_of("contact_force_error", right.scene, right.run) < 1e-9);
  BOOST_TEST(std::abs(test::value_of("contact_force_error", wrong.scene, wrong.run) - 400) < 1e-9);
}

// A box slides over the ground and turns round at a smooth wall between two samples. The ground's friction of that step
// is not determined, and its normal force is.
BOOST_AUTO_TEST_CASE(an_impact_at_a_wall_is_not_charged_to_the_ground) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("box", Box{{1, 1, 1}}, 2, {0.53, 0, 0.5}), test::plane(),
                  test::plane(Vec3::UnitX())};
  scene.bodies[0].velocity = {-6, 0, 0};
  scene.contact_default = {1, 0.1};
  scene.contact_pairs = {{0, 2, {1, 0}}};
  Trajectory run = test::standing(scene, 1, [](int) {
    return std::vector{ReportedContact{1, 0, {0.53, 0, 0}, Vec3::UnitZ(), 0, {2, 0, 20}},
                       ReportedContact{2, 0, {0, 0, 0.5}, Vec3::UnitX(), 0, {2398, 0, 0}}};
  });
  BodyTable bodies(run.samples[1].bodies.columns());
  bodies.columns().set_velocity(0, {6, 0, 0});
  run.samples[1].bodies = KeptBodies(std::as_const(bodies).columns());
  const MetricResult result = test::result_of("contact_force_error", scene, run);
  BOOST_TEST_REQUIRE(result.measurement.has_value());
  BOOST_TEST(result.measurement->value < 1e-9);
  BOOST_TEST(result.measurement->worst.component.find("not determined") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(meeting_points_are_those_that_touch_or_meet_within_the_step) {
  Scene scene;
  scene.bodies = {test::on_its_own("box", Box{{1, 1, 1}}, 2, {0, 0, 0.5}), test::plane(),
                  test::on_its_own("ball", Sphere{0.1}, 1, {0, 0, 1.2})};
  scene.contact_default = {0, 0.5};
  const auto pairs = [&](double speed, double dt) {
    scene.bodies[2].velocity = {0, 0, -speed};
    BodyTable before(3);
    set_initial_state(scene, before.columns());
    BodyTable after = before;
    after.columns().set_position(2, {0, 0, 1.2 - speed * dt});
    std::set<BodyPair> found;
    for (const MeetingPoint& point :
         meeting_points(scene, ContactLaws(scene), std::as_const(before).columns(), std::as_const(after).columns(), dt))
      found.insert(point.pair);
    return found;
  };
  BOOST_TEST((pairs(0.99, 0.1) == std::set<BodyPair>{{1, 0}}));  // 1 mm above the box at the end
  BOOST_TEST((pairs(1.01, 0.1) == std::set<BodyPair>{{1, 0}, {0, 2}}));
  BOOST_TEST((pairs(-1, 0.1) == std::set<BodyPair>{{1, 0}}));
}

BOOST_AUTO_TEST_SUITE_END()
