// DART's traps, each found again, so that a new DART that mends or moves one is noticed; and its joints against the
// core's.
#include "adapters/dart/dart_engine.h"

#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <iostream>
#include <numbers>
#include <sstream>

#include "cases/case/suite.h"
#include "cases/runner/grid.h"
#include "core/engine/engine_failure.h"
#include "tests/adapters/free_body_measures.h"
#include "tests/adapters/hung_rods.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_dart_dart_engine)

namespace {

constexpr double kHalfTurn = std::numbers::pi;

double distance_after(const std::string& run, const Scene& scene, double dt, double duration,
                      const std::string& other = "core:dormand-prince") {
  const auto steps = static_cast<int>(std::lround(duration / dt));
  const auto world = load_run(run, scene), truth = load_run(other, scene);
  for (int i = 0; i < steps; ++i) world->step(dt), truth->step(dt);
  Snapshot found, expected;
  world->read(found), truth->read(expected);
  double distance = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyState a = found.bodies().body(i), b = expected.bodies().body(i);
    distance = std::max({distance, (a.position - b.position).norm(), angle_between(a.orientation, b.orientation)});
  }
  return distance;
}

void check_refused(const Scene& scene, const std::string& why) {
  BOOST_CHECK_EXCEPTION(load_run("dart", scene), EngineFailure, [&](const EngineFailure& failure) {
    return failure.kind() == FailureKind::unsupported && std::string(failure.what()).find(why) != std::string::npos;
  });
}

// A ball on the ground that rolls off at `speed` along x, without friction.
Scene rolling_ball(double speed) {
  Scene scene = sliding_box(speed, 0, 0);
  scene.bodies[0].shape = Sphere{0.1};
  scene.bodies[0].position.z() = 0.1;
  return scene;
}

Scene slow_spin() {
  Scene scene;
  scene.bodies = {rod("rod", {0, 0, 0})};
  scene.bodies[0].inertia = Mat3::Identity();
  scene.bodies[0].angular_velocity = {0.5, 0, 0};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_world_that_blows_up_is_lost_before_it_aborts) {
  // The explicit gyroscopic torque spins a top up; a number that is not finite trips an assertion of DART's library.
  const auto world = load_run("dart", asymmetric_top());
  const BodyState end = body_after(*world, 1.0 / 30, 1800);
  BOOST_TEST(!std::isfinite(end.angular_velocity.norm()));
  BOOST_TEST(world->solver_warning().find("before it would abort") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_aborts_all_the_same_costs_its_cell) {
  // The stock DART asserts here that its solver's result is finite.
  Case doll = select_cases({"mechanisms/ragdoll-on-floor"}, default_suite_dir(), test::words()).front();
  std::erase_if(doll.dt, [](const StepSize& dt) { return dt.text != "1/240"; });
  doll.gates.clear();
  const auto infos = infos_of(engines());
  Results grid =
      plan_grid({doll}, {parse_run_name("dart@stock", infos), parse_run_name("ode", infos)}, engines(), {false, true});
  run_grid(grid, engines(), {1, 60, {}, false, false}, [](std::size_t, std::size_t) {});
  for (const Cell& cell : grid.cases.front().cells) {
    const bool is_dart = grid.runs[cell.run].engine == "dart";
    BOOST_TEST((cell.status == (is_dart ? Status::crashed : Status::pass)), cell.reason);
    if (is_dart) BOOST_TEST(cell.reason.find("SIGABRT") != std::string::npos, cell.reason);
  }
}

BOOST_AUTO_TEST_CASE(small_turns_go_too_far_by_a_sixth_of_their_cube) {
  // DART's exponential map is cut off for turns below 1e-3 rad; the twin's likewise.
  const auto turned = [](const std::string& run, double dt) {
    const auto world = load_run(run, slow_spin());
    const auto steps = static_cast<int>(std::lround(2 / dt));
    const Quat q = body_after(*world, dt, steps).orientation, q0 = slow_spin().bodies[0].orientation;
    return angle_between(q0, q) - 1;
  };
  for (const char* run : {"dart", "core:dart-twin"}) {
    const double dt = 1e-3, each = std::pow(0.5 * dt, 3) / 6;
    BOOST_TEST(std::abs(turned(run, dt) - 2000 * each) < 1e-11, run << ": " << turned(run, dt));  // of 4.2e-8
    BOOST_TEST(std::abs(turned(run, 1e-2)) < 1e-12, run << ": " << turned(run, 1e-2));
  }
}

BOOST_AUTO_TEST_CASE(friction_is_a_pyramid) {
  BOOST_TEST(std::abs(stop_distance_ratio("dart", 0, 1e-3) - 1) < 1e-3);  // v dt/2 of the way
  BOOST_TEST(std::abs(stop_distance_ratio("dart", kHalfTurn / 4, 1e-3) - std::sqrt(0.5)) < 1e-3);
}

BOOST_AUTO_TEST_CASE(its_constants_are_as_they_were_after_each_step) {
  // A gap of the loop is closed by an erp that one world has and the other not; steps are taken in turn.
  Scene scene = hung_by({.a = 0, .b = 1, .type = BallJoint{{1, 0.1, 0}}});
  scene.joints.push_back({.a = kWorld, .b = 1, .type = BallJoint{{2, 0.3, 0.2}}});
  const auto after = [&](const std::string& run, const std::string& between) {
    const auto world = load_run(run, scene), other = load_run(between, scene);
    for (int i = 0; i < 100; ++i) world->step(1e-2), other->step(1e-2);
    Snapshot now;
    world->read(now);
    return Vec3(now.bodies().position(1));
  };
  for (const auto& [run, other] : {std::pair("dart", "dart@stock"), std::pair("dart@stock", "dart,erp=0.1,cfm=1e-3")})
    BOOST_TEST((after(run, run) - after(run, other)).norm() == 0);
  BOOST_TEST((after("dart", "dart") - after("dart@stock", "dart@stock")).norm() > 1e-6);
}

BOOST_AUTO_TEST_CASE(a_tree_of_joints_moves_as_the_cores_whichever_end_hangs) {
  for (Joint joint : joints_of_each_kind()) {
    if (std::holds_alternative<CylindricalJoint>(joint.type)) continue;  // DART has none
    for (const bool swapped : {false, true}) {
      joint.a = swapped ? 1 : 0, joint.b = swapped ? 0 : 1;
      const Scene scene = hung_by(joint);
      const double coarse = distance_after("dart", scene, 1.0 / 500, 0.6),
                   fine = distance_after("dart", scene, 1.0 / 1000, 0.6);
      const std::string what = joint_type_name(joint) + (swapped ? ", ends exchanged: " : ": ");
      BOOST_TEST_MESSAGE(what << coarse << ", " << fine);
      BOOST_TEST(fine < 1e-2, what << fine);
      BOOST_TEST((coarse > 1.7 * fine && coarse < 2.3 * fine), what << coarse << " at twice the step, " << fine);
    }
  }
}

BOOST_AUTO_TEST_CASE(without_springs_a_tree_of_joints_is_its_twin) {
  for (Joint joint : joints_of_each_kind()) {
    if (std::holds_alternative<CylindricalJoint>(joint.type)) continue;  // DART has none
    joint.a = 0, joint.b = 1, joint.stiffness = joint.damping = 0;
    const double apart = distance_after("dart", hung_by(joint), 1.0 / 30, 1, "core:dart-twin");
    BOOST_TEST(apart < 1e-9, joint_type_name(joint) << ": " << apart);  // a tenth of what its gates ask
  }
}

BOOST_AUTO_TEST_CASE(a_loop_closes_at_first_order) {
  for (Joint joint :
       {Joint{.type = BallJoint{{2, 0.3, 0.2}}}, Joint{.type = HingeJoint{{2, 0.3, 0.2}, Vec3::UnitX()}}}) {
    Scene scene = hung_by({.a = 0, .b = 1, .type = BallJoint{{1, 0.1, 0}}});
    joint.a = kWorld, joint.b = 1;
    scene.joints.push_back(joint);
    const double coarse = distance_after("dart", scene, 1.0 / 500, 0.4),
                 fine = distance_after("dart", scene, 1.0 / 1000, 0.4);
    BOOST_TEST_MESSAGE(joint_type_name(joint) << ": " << coarse << ", " << fine);
    BOOST_TEST(coarse > 1.7 * fine, joint_type_name(joint) << ": " << coarse << ", " << fine);
  }
}

BOOST_AUTO_TEST_CASE(motors_turn_b_against_a) {
  Scene scene = hung_by({.a = 0, .b = 1, .type = HingeJoint{{1, 0.1, 0}, Vec3::UnitY()}});
  Motor motor{.joint = 1, .speed = {}};
  motor.effort = 2, motor.from = 0.1, motor.until = 0.35;
  Motor steady{.joint = 1, .speed = 1.5};
  steady.most = 1e3;
  for (const bool swapped : {false, true}) {
    if (swapped) std::swap(scene.joints[1].a, scene.joints[1].b);
    scene.motors = {motor};
    BOOST_TEST(distance_after("dart", scene, 1e-3, 0.6) < 1e-2);
    scene.motors = {steady};
    const auto world = load_run("dart", scene);
    Snapshot now;
    for (int i = 0; i < 100; ++i) world->step(1e-3);
    world->read(now);
    const Vec3 axis =
        matrix_of(now.bodies().orientation(0)) * (matrix_of(scene.bodies[0].orientation).transpose() * Vec3::UnitY());
    const double speed = axis.dot(now.bodies().angular_velocity(1) - now.bodies().angular_velocity(0));
    BOOST_TEST(std::abs(speed - (swapped ? -1.5 : 1.5)) < 1e-3, speed);
  }
}

BOOST_AUTO_TEST_CASE(what_it_cannot_say_is_refused) {
  Scene loop = hung_by({.a = 0, .b = 1, .type = SliderJoint{Vec3::UnitX()}});
  loop.joints.push_back({.a = kWorld, .b = 1, .type = SliderJoint{Vec3::UnitX()}});
  loop.joints.push_back({.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}});
  check_refused(loop, "closes a loop");
  Scene limited = hung_by({.a = 0, .b = 1, .type = HingeJoint{{1, 0.1, 0}, Vec3::UnitY()}, .upper = 1});
  BOOST_CHECK_NO_THROW(load_run("dart", limited));
  limited.joints[1].restitution = 0.5;
  check_refused(limited, "no restitution");
  Scene slippery = sliding_box(1, 0, 5e-4);
  check_refused(slippery, "takes a friction of 0.001 or less for none");
  slippery.contact_default = {5e-4, 0};
  check_refused(slippery, "takes a restitution of 0.001 or less for none");
  const EngineInfo info = DartEngine().info();
  for (const Feature missing :
       {Feature::friction_infinite, joint_feature<DistanceJoint>(), contact_feature<Capsule, Plane>()})
    BOOST_TEST(!info.features.contains(missing), word_of(missing));
}

BOOST_AUTO_TEST_CASE(a_body_that_leaves_the_box_under_it_does_not_fall_in_silence) {
  const auto world = load_run("dart", rolling_ball(499.5));
  for (int i = 0; i < 100; ++i) world->step(1e-2);  // 499.5 m
  BOOST_CHECK_EXCEPTION(
      [&] {
        for (int i = 0; i < 10; ++i) world->step(1e-2);
      }(),
      EngineFailure,
      [](const EngineFailure& failure) {
        return failure.kind() == FailureKind::unsupported &&
               std::string(failure.what()).find("body 'box'") != std::string::npos;
      });
}

BOOST_AUTO_TEST_CASE(it_prints_nothing) {
  std::ostringstream heard;
  std::streambuf *const cerr = std::cerr.rdbuf(heard.rdbuf()), *const cout = std::cout.rdbuf(heard.rdbuf());
  Scene scene = sliding_box(1, 0, 0.5);
  scene.bodies.push_back(scene.bodies[0]);  // two boxes in one place
  scene.bodies.back().name = "other";
  const auto world = load_run("dart", scene);
  for (int i = 0; i < 10; ++i) world->step(1e-2);
  std::cerr.rdbuf(cerr), std::cout.rdbuf(cout);
  BOOST_TEST(heard.str() == "");
}

BOOST_AUTO_TEST_CASE(settings_are_read_back) {
  const Scene scene = sliding_box(1, 0, 0.5);
  const auto matched = load_run("dart,erp=0.3", scene)->settings_in_force();
  BOOST_TEST(setting(matched, "solver") == "DantzigBoxedLcpSolver, and where it fails PgsBoxedLcpSolver");
  BOOST_TEST(setting(matched, "collision detector") == "dart");
  BOOST_TEST(setting(matched, "contacts").starts_with("erp 0.3 of an overlap a step"));
  const auto stock = load_run("dart:pgs@stock", scene)->settings_in_force();
  BOOST_TEST(setting(stock, "solver") == "PgsBoxedLcpSolver");
  BOOST_TEST(setting(stock, "collision detector") == "fcl");
  BOOST_TEST(setting(stock, "contacts") == "erp 0.01 of an overlap a step, at most 0.001 m/s; cfm 1e-05; 1000 at most");
}

BOOST_AUTO_TEST_SUITE_END()
