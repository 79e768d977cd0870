// The metrics of contact forces on reports whose errors are put there on purpose.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/metrics/measures/contact/meeting_points.h"
#include "cases/metrics/measures/contact/pair_wrenches.h"
#include "tests/cases/metrics/standing_run.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_contact_force_metrics)

using test::result_of, test::standing, test::value_of;

namespace {

constexpr double kDt = test::kStandingDt, kWeight = 20;  // s, N
constexpr int kBall = 0, kGround = 1;

Scene ball_on_ground(double friction) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 0.5}), test::plane()};
  scene.contact_default = {0, friction};
  return scene;
}

ReportedContact under_ball(const Vec3& force) { return {kGround, kBall, Vec3::Zero(), Vec3::UnitZ(), 0, force}; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_weight_that_is_carried_leaves_nothing) {
  const Scene scene = ball_on_ground(0.5);
  const Trajectory run = standing(scene, 10, [](int) { return std::vector{under_ball({0, 0, kWeight})}; });
  for (const char* metric : {"contact_balance", "contact_force_error", "coulomb_residual", "force_ripple"})
    BOOST_TEST(value_of(metric, scene, run) < 1e-12, metric);
  BOOST_TEST(std::abs(value_of("force_peak", scene, run) - 1) < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_force_that_is_wrong_is_seen_with_its_size_pair_and_instant) {
  const Scene scene = ball_on_ground(0.5);
  const Trajectory run = standing(scene, 10, [](int n) {
    return std::vector{under_ball({n == 7 ? 3.0 : 0.0, 0, n == 7 ? kWeight + 4 : kWeight})};
  });
  for (const char* metric : {"contact_balance", "contact_force_error"}) {
    const MetricResult result = result_of(metric, scene, run);
    BOOST_TEST_CONTEXT(metric) {
      BOOST_TEST(std::abs(result.measurement->value - 5) < 1e-12);  // a triangle of 3, 4, 5
      BOOST_TEST(result.measurement->worst.time == 7 * kDt);
      BOOST_TEST(result.measurement->worst.body == kBall);
      BOOST_TEST(std::abs(result.measurement->worst.expected - kWeight) < 1e-12);
    }
  }
  BOOST_TEST(std::abs(value_of("force_peak", scene, run) - std::hypot(3, 24) / kWeight) < 1e-12);
}

BOOST_AUTO_TEST_CASE(no_contact_where_one_must_carry_is_an_error_of_the_whole_weight) {
  const Scene scene = ball_on_ground(0.5);
  const Trajectory run = standing(scene, 10, [](int) { return std::vector<ReportedContact>(); });
  BOOST_TEST(std::abs(value_of("contact_force_error", scene, run) - kWeight) < 1e-12);
  BOOST_TEST(std::abs(value_of("contact_balance", scene, run) - kWeight) < 1e-12);
  BOOST_TEST(value_of("force_ripple", scene, run) == 1);
}

BOOST_AUTO_TEST_CASE(friction_beyond_the_cone_and_a_pull_are_outside_it) {
  const Scene scene = ball_on_ground(0.25);
  const auto residual = [&](const Vec3& force) {
    const Trajectory run = standing(scene, 3, [=](int) { return std::vector{under_ball(force)}; });
    return value_of("coulomb_residual", scene, run);
  };
  BOOST_TEST(residual({3, 4, 20}) == 0);  // at its limit
  BOOST_TEST(std::abs(residual({3, 4, 12}) - 2) < 1e-12);
  BOOST_TEST(std::abs(residual({0, 0, -6}) - 6) < 1e-12);
}

// A point that rests has its static friction, and one that slides through a whole step has not.
BOOST_AUTO_TEST_CASE(only_a_point_that_rests_has_static_friction) {
  Scene scene = ball_on_ground(0.25);
  scene.contact_default.static_friction = 0.5;
  const auto residual = [&](double speed) {
    Trajectory run = standing(scene, 3, [](int) { return std::vector{under_ball({6, 8, 20})}; });
    for (Sample& sample : run.samples) sample.bodies.columns().set_velocity(kBall, {speed, 0, 0});
    return value_of("coulomb_residual", scene, run);
  };
  BOOST_TEST(residual(0) == 0);
  BOOST_TEST(std::abs(residual(0.1) - 5) < 1e-12);
}

// 19 and 21 N in turn: a mean of 20 N, and a deviation of 1 N.
BOOST_AUTO_TEST_CASE(ripple_is_the_deviation_over_the_mean_of_the_second_half) {
  const Scene scene = ball_on_ground(0.5);
  const Trajectory run = standing(scene, 39, [](int n) {
    return std::vector{under_ball({0, 0, n < 20 ? 500 : kWeight + (n % 2 ? 1 : -1)})};
  });
  BOOST_TEST(std::abs(value_of("force_ripple", scene, run) - 0.05) < 1e-12);
  BOOST_TEST(std::abs(value_of("force_peak", scene, run) - 25) < 1e-12);
}

BOOST_AUTO_TEST_CASE(forces_on_bodies_are_what_loads_do_not_explain) {
  Scene scene = ball_on_ground(0.5);
  scene.forces = {{.body = kBall, .force = Vec3(6, 0, 0), .from = 0, .until = 0.5}};
  BodyTable before(2), after(2);
  set_initial_state(scene, before.columns());
  set_initial_state(scene, after.columns());
  after.columns().set_velocity(kBall, {2, 0, 0});
  // 2 kg gain 2 m/s within 1 s. The force acts for half of it with 6 N, so contact gives 4 - 3 N, and bears the weight.
  const auto forces = forces_on_bodies(scene, std::as_const(before).columns(), std::as_const(after).columns(), 0, 1);
  BOOST_TEST((forces[kBall] - Vec3(1, 0, kWeight)).norm() < 1e-12);
  BOOST_TEST(forces[kGround].norm() == 0);
}

// A box of 2 kg, 1 m wide and 0.5 m high, on level ground.
Scene box_on_ground(double friction) {
  Scene scene = ball_on_ground(friction);
  scene.bodies[kBall] = test::on_its_own("box", Box{{1, 1, 0.5}}, 2, {3, 0, 0.25});
  return scene;
}

ReportedContact under_box(double x, double y, const Vec3& force) {
  return {kGround, kBall, Vec3(3 + x, y, 0), Vec3::UnitZ(), 0, force};
}

BOOST_AUTO_TEST_CASE(a_load_that_is_carried_off_centre_has_a_moment_and_a_centre_of_pressure) {
  const Scene scene = box_on_ground(0.5);
  // 15 N at one edge and 5 N at the other: 20 N act at 0.25 m from the centre.
  const Trajectory run = standing(scene, 5, [](int) {
    return std::vector{under_box(0.5, 0, {0, 0, 15}), under_box(-0.5, 0, {0, 0, 5})};
  });
  BOOST_TEST(value_of("contact_force_error", scene, run) < 1e-12);
  BOOST_TEST(std::abs(value_of("contact_moment_error", scene, run) - 5) < 1e-12);
  BOOST_TEST(std::abs(value_of("centre_of_pressure_error", scene, run) - 0.25) < 1e-12);
  const Trajectory even = standing(scene, 5, [](int) {
    return std::vector{under_box(0.5, 0, {0, 0, 10}), under_box(-0.5, 0, {0, 0, 10})};
  });
  BOOST_TEST(value_of("contact_moment_error", scene, even) < 1e-12);
  BOOST_TEST(value_of("centre_of_pressure_error", scene, even) < 1e-12);
}

// A push of 6 N on the box at the height of its centre asks for friction of 6 N at its base. The moment of that, 1.5 N
// m about the centre, needs the weight of 20 N at 0.075 m before it.
BOOST_AUTO_TEST_CASE(friction_moves_the_centre_of_pressure) {
  Scene scene = box_on_ground(0.5);
  scene.forces = {{.body = kBall, .force = Vec3(6, 0, 0)}};
  const auto at = [&](double x) {
    const Trajectory run = standing(scene, 5, [=](int) { return std::vector{under_box(x, 0, {-6, 0, 20})}; });
    return std::pair(value_of("contact_moment_error", scene, run), value_of("centre_of_pressure_error", scene, run));
  };
  BOOST_TEST(at(0.075).first < 1e-12);
  BOOST_TEST(at(0.075).second < 1e-12);
  BOOST_TEST(std::abs(at(0).first - 1.5) < 1e-12);
  BOOST_TEST(std::abs(at(0).second - 0.075) < 1e-12);
}

// A body that is pushed along and spun.
BOOST_AUTO_TEST_CASE(moments_on_bodies_are_what_loads_do_not_explain) {
  Scene scene = box_on_ground(0);
  scene.bodies[kBall].inertia = Vec3(1, 2, 3).asDiagonal();
  scene.forces = {{.body = kBall, .force = Vec3(0, 4, 0), .torque = Vec3(0, 0, 1), .point = Vec3::Zero()}};
  BodyTable before(2), after(2);
  set_initial_state(scene, before.columns());
  set_initial_state(scene, after.columns());
  after.columns().set_velocity(kBall, {0, 2, 0});
  after.columns().set_position(kBall, {3, 1, 0.25});
  after.columns().set_angular_velocity(kBall, {0, 0, 5});
  const Vec3 moment =
      moments_on_bodies(scene, std::as_const(before).columns(), std::as_const(after).columns(), 0, 1)[kBall];
  // In 1 s the angular momentum about the origin becomes 15 of spin and (-1, 0, 12) of orbit. The mean position is
  // (3, 1/3, 1/4): gravity has the moment (-20/3, 60, 0) there, the push (-1, 0, 12 + 1).
  BOOST_TEST((moment - Vec3(20.0 / 3, -60, 14)).norm() < 1e-12, moment.transpose());
}

BOOST_AUTO_TEST_CASE(a_force_across_a_gap_breaks_signorinis_law) {
  const Scene scene = ball_on_ground(0.5);
  const auto residual = [&](double gap, double force) {
    const Trajectory run = standing(scene, 3, [=](int) {
      ReportedContact contact = under_ball({3, 0, force});
      contact.gap = gap;
      return std::vector{contact};
    });
    return value_of("signorini_residual", scene, run);
  };
  BOOST_TEST(residual(0, kWeight) == 0);
  BOOST_TEST(residual(0.01, 0) == 0);
  BOOST_TEST(std::abs(residual(0.01, kWeight) - 0.2) < 1e-12);
  BOOST_TEST(std::abs(residual(-0.02, kWeight) - 0.4) < 1e-12);
}

// The box slides with (3, 4, 0) m/s. Its friction of 10 N would take 50 W.
BOOST_AUTO_TEST_CASE(friction_that_does_not_oppose_the_sliding_dissipates_too_little) {
  Scene scene = box_on_ground(0.5);
  scene.bodies[kBall].velocity = {3, 4, 0};
  const auto residual = [&](const Vec3& friction) {
    const Trajectory run =
        standing(scene, 3, [=](int) { return std::vector{under_box(0, 0, friction + Vec3(0, 0, kWeight))}; });
    return value_of("dissipation_residual", scene, run);
  };
  BOOST_TEST(residual({-6, -8, 0}) < 1e-12);
  BOOST_TEST(std::abs(residual({-8, 6, 0}) - 50) < 1e-12);  // across
  BOOST_TEST(std::abs(residual({0, 0, 0}) - 50) < 1e-12);
  BOOST_TEST(std::abs(residual({6, 8, 0}) - 100) < 1e-12);  // it drives
}

BOOST_AUTO_TEST_CASE(hover_is_the_gap_weighted_by_the_force) {
  Scene scene = ball_on_ground(0.5);
  scene.bodies[kBall].position.z() = 0.503;
  const Trajectory run = standing(scene, 4, [](int) { return std::vector{under_ball({0, 0, kWeight})}; });
  BOOST_TEST(std::abs(value_of("hover", scene, run) - 0.003) < 1e-12);
  scene.bodies[kBall].position.z() = 0.497;  // an overlap does not hover
  BOOST_TEST(value_of("hover", scene, standing(scene, 4, [](int) {
                        return std::vector{under_ball({0, 0, 20})};
                      })) == 0);
}

BOOST_AUTO_TEST_CASE(a_reported_gap_is_compared_with_the_geometry) {
  Scene scene = ball_on_ground(0.5);
  scene.bodies[kBall].position.z() = 0.497;
  const auto error = [&](double gap) {
    const Trajectory run = standing(scene, 4, [=](int) {
      ReportedContact contact = under_ball({0, 0, kWeight});
      contact.gap = gap;
      return std::vector{contact};
    });
    return value_of("contact_gap_error", scene, run);
  };
  BOOST_TEST(error(-0.003) < 1e-12);
  BOOST_TEST(std::abs(error(0.003) - 0.006) < 1e-12);
}

// Two balls of 2 kg on a rod fall on the ground: together they need both forces, and each alone does not.
BOOST_AUTO_TEST_CASE(bodies_that_a_joint_holds_together_are_balanced_as_one) {
  Scene scene = ball_on_ground(0.5);
  scene.bodies.push_back(test::on_its_own("other", Sphere{0.5}, 2, {0, 0, 1.5}));
  scene.joints = {{.a = kBall, .b = 2, .type = FixedJoint{}}};
  const auto left = [&](double force) {
    return value_of("contact_balance", scene, standing(scene, 3, [=](int) {
                      return std::vector{under_ball({0, 0, force})};
                    }));
  };
  BOOST_TEST(left(2 * kWeight) < 1e-12);
  BOOST_TEST(std::abs(left(kWeight) - kWeight) < 1e-12);
  scene.joints.push_back({.a = kWorld, .b = 2, .type = BallJoint{Vec3::Zero()}});
  const Trajectory run = standing(scene, 3, [](int) { return std::vector<ReportedContact>(); });
  BOOST_TEST(result_of("contact_balance", scene, run).not_applicable ==
             "joints or springs hold every body to the world");
}

// Three balls in a row: the first strikes, the second passes the whole momentum on within the step and stands at both
// of its ends, a millimetre from both others. So each pair carries m v/dt.
BOOST_AUTO_TEST_CASE(a_body_that_passes_its_momentum_on_within_a_step_is_met) {
  constexpr double dt = 0.1, v = 1, gap = 1e-3;
  Scene scene;
  scene.gravity = Vec3::Zero();
  scene.contact_default = {1, 0};
  for (int i = 0; i < 3; ++i)
    scene.bodies.push_back(test::on_its_own("ball " + std::to_string(i), Sphere{0.5}, 2, {i * (1 + gap), 0, 0}));
  scene.bodies[0].velocity = {v, 0, 0};
  BodyTable before(3), after(3);
  set_initial_state(scene, before.columns()), set_initial_state(scene, after.columns());
  after.columns().set_position(0, {gap, 0, 0}), after.columns().set_velocity(0, Vec3::Zero());
  after.columns().set_position(1, {1 + 2 * gap, 0, 0});
  after.columns().set_position(2, {2 + 2 * gap + v * (dt - 2 * gap / v), 0, 0});
  after.columns().set_velocity(2, {v, 0, 0});
  const auto points = [&](double length) {
    return meeting_points(scene, ContactLaws(scene), std::as_const(before).columns(), std::as_const(after).columns(),
                          length);
  };
  BOOST_TEST(points(dt).size() == 2u);
  // Within a step too short for the first ball to arrive no pair meets, and none is kicked.
  set_initial_state(scene, after.columns());
  BOOST_TEST(points(0.5 * gap / v).empty());
}

// A ball without gravity meets the ground exactly at the third of five samples, where the truth still has the velocity
// of before. Its impulse of 2 m v may be reported in the step before that sample or in the one after it.
BOOST_AUTO_TEST_CASE(an_impact_at_a_sample_may_be_reported_on_either_side_of_it) {
  constexpr double v = 1, force = 2 * 2 * v / kDt;
  const auto error = [&](int struck, double share) {
    Scene scene = ball_on_ground(0);
    scene.gravity = Vec3::Zero();
    scene.contact_default = {1, 0};
    Trajectory run = standing(scene, 4, [&](int n) {
      return n == struck ? std::vector{under_ball({0, 0, share * force})} : std::vector<ReportedContact>();
    });
    for (int n = 0; n <= 4; ++n) {
      BodyTable table(scene.bodies.size());
      set_initial_state(scene, table.columns());
      table.columns().set_position(kBall, {0, 0, 0.5 + v * kDt * std::abs(n - 2)});
      table.columns().set_velocity(kBall, {0, 0, n <= 2 ? -v : v});
      run.samples[static_cast<std::size_t>(n)].bodies = KeptBodies(std::as_const(table).columns());
    }
    return value_of("contact_force_error", scene, run);
  };
  for (const int beside : {2, 3}) BOOST_TEST(error(beside, 1) < 1e-9 * force);
  // The mean over both steps is compared, so half of what is missing is seen.
  BOOST_TEST(std::abs(error(2, 0.9) - 0.05 * force) < 1e-9 * force);
  BOOST_TEST(std::abs(error(4, 1) - force) < 1e-9 * force);
  BOOST_TEST(std::abs(error(1, 1) - force) < 1e-9 * force);
}

BOOST_AUTO_TEST_CASE(a_run_without_reports_says_so) {
  const Scene scene = ball_on_ground(0.5);
  Trajectory run = standing(scene, 3, [](int) { return std::vector<ReportedContact>(); });
  run.contacts = ContactRecords::not_reported;
  BOOST_TEST(result_of("contact_balance", scene, run).not_applicable == "the engine does not report contact forces");
  run.contacts = ContactRecords::not_asked_for;
  BOOST_TEST(result_of("contact_balance", scene, run).not_applicable ==
             "contact forces are recorded where a gate of the case names them");
}

BOOST_AUTO_TEST_SUITE_END()
