// What engines themselves say their joints carry, where statics says it.
#include <algorithm>
#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "adapters/faults/broken_engine.h"
#include "core/engine/run_name.h"
#include "tests/adapters/ode/jointed_scenes.h"
#include "tests/adapters/seam_runs.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_reported_reactions)

namespace {

constexpr double kG = 9.81, kStep = 1.0 / 240;

struct Reporting {
  std::string run;
  double within;  // of a weight that is carried at rest
};

// For rows on free bodies, ODE's CFM allows a joint to yield by 1e-4 per step on the matched track; there are enough
// sweeps to converge.
const std::vector<Reporting> kByRows = {{"ode:worldstep", 1e-3},
                                        {"ode:quickstep,iterations=200", 1e-3},
                                        {"bullet,iterations=200", 1e-3},
                                        {"bullet:mlcp", 1e-3}};

// In the coordinates of trees: to rounding. The engines that are built in.
std::vector<Reporting> of_trees() {
  std::vector<Reporting> runs = {{"bullet:multibody", 1e-12}};
  for (const char* run : {"dart", "mujoco", "mujoco:implicit", "simbody", "simbody:semi-explicit-euler"}) {
    const std::string name = run, engine = name.substr(0, name.find(':'));
    const auto infos = infos_of(engines());
    if (std::any_of(infos.begin(), infos.end(), [&](const EngineInfo& info) { return info.name == engine; }))
      runs.push_back({name, 1e-12});
  }
  return runs;
}

std::vector<Reporting> reporting() {
  std::vector<Reporting> runs = kByRows;
  for (const Reporting& run : of_trees()) runs.push_back(run);
  return runs;
}

std::unique_ptr<World> load_named(const std::string& text, const Scene& scene) {
  const RunName run = parse_run_name(text, engines().infos());
  return find_engine(engines(), run.engine).load(scene, run.settings);
}

// A body of 2 kg, at rest half a metre from where it is held, as b or as a.
Scene held(const decltype(Joint::type)& type, const Vec3& centre, bool is_b) {
  Scene scene;
  scene.gravity = {0, -kG, 0};
  scene.bodies = {test::lopsided_body("body", 2, centre, Quat::Identity())};
  scene.joints = {is_b ? Joint{kWorld, 0, type} : Joint{0, kWorld, type}};
  return scene;
}

ReportedReaction after_one_step(const std::string& engine, const Scene& scene) {
  const auto world = load_named(engine, scene);
  BOOST_TEST(reported_reactions(*world).empty());
  ask_for_reactions(*world);
  BOOST_TEST(reported_reactions(*world).empty());  // nothing has been carried yet
  world->step(kStep);
  const auto reactions = reported_reactions(*world);
  BOOST_REQUIRE(reactions.size() == 1u);
  return reactions[0];
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_hangs_is_carried_with_its_weight) {
  for (const auto& [engine, within] : reporting()) {
    for (const bool is_b : {true, false}) {
      const ReportedReaction carried = after_one_step(engine, held(BallJoint{{0, 0.5, 0}}, {0, 0, 0}, is_b));
      BOOST_TEST_CONTEXT(engine << ", " << carried.force.transpose() << ", " << carried.torque.transpose()) {
        BOOST_TEST(carried.body == 0);
        BOOST_TEST((carried.force - Vec3(0, 2 * kG, 0)).norm() < within * 2 * kG);
        BOOST_TEST(carried.torque.norm() < within * kG);
      }
    }
  }
}

// The weight acts at the centre of mass, the reference point of a reported torque. The hinge's couple and the moment of
// its force, 1 m kg g each, cancel.
BOOST_AUTO_TEST_CASE(torques_are_about_the_centre_of_mass) {
  for (const auto& [engine, within] : reporting()) {
    const HingeJoint post{Vec3::Zero(), Vec3::UnitY()};
    const ReportedReaction carried = after_one_step(engine, held(post, {0.5, 0, 0}, true));
    BOOST_TEST_CONTEXT(engine << ", " << carried.force.transpose() << ", " << carried.torque.transpose()) {
      BOOST_TEST((carried.force - Vec3(0, 2 * kG, 0)).norm() < within * 2 * kG);
      BOOST_TEST(carried.torque.norm() < within * kG);
    }
  }
}

BOOST_AUTO_TEST_CASE(an_engine_that_is_asked_moves_as_if_it_were_not) {
  for (const test::JointedScene& jointed : test::jointed_scenes()) {
    for (const auto& [engine, within] : reporting()) {
      const RunName run = parse_run_name(engine, engines().infos());
      if (!why_unsupported(find_engine(engines(), run.engine).info(), run.settings, jointed.scene, kStep).empty())
        continue;
      const auto asked = load_named(engine, jointed.scene), silent = load_named(engine, jointed.scene);
      ask_for_reactions(*asked);
      Snapshot one, other;
      for (int n = 0; n < 50; ++n) asked->step(kStep), silent->step(kStep);
      asked->read(one), silent->read(other);
      for (std::size_t i = 0; i < jointed.scene.bodies.size(); ++i) {
        const BodyState a = one.bodies().body(i), b = other.bodies().body(i);
        // ODE adds up what a joint does to its two bodies in another order.
        const double apart = (a.position - b.position).norm() + (a.velocity - b.velocity).norm();
        BOOST_TEST(apart < 1e-10, jointed.name << ", " << engine << ": " << apart);
      }
    }
  }
}

// An engine that is spared its report in some steps says in the others what it says of each.
BOOST_AUTO_TEST_CASE(a_report_does_not_hang_on_whether_others_were_asked_for) {
  for (const test::JointedScene& jointed : test::jointed_scenes()) {
    for (const auto& [engine, within] : reporting()) {
      const RunName run = parse_run_name(engine, engines().infos());
      if (!why_unsupported(find_engine(engines(), run.engine).info(), run.settings, jointed.scene, kStep).empty())
        continue;
      const auto each = load_named(engine, jointed.scene), some = load_named(engine, jointed.scene);
      ask_for_reactions(*each), ask_for_reactions(*some);
      for (int n = 1; n <= 12; ++n) {
        const bool is_read = n == 2 || n == 7 || n == 8;
        report_reactions(*some, is_read);
        each->step(kStep), some->step(kStep);
        const auto all = reported_reactions(*each), here = reported_reactions(*some);
        if (!is_read) continue;
        BOOST_REQUIRE_EQUAL(here.size(), all.size());
        for (std::size_t k = 0; k < all.size(); ++k) {
          BOOST_TEST(here[k].force == all[k].force, jointed.name << ", " << engine << " at step " << n);
          BOOST_TEST(here[k].torque == all[k].torque, jointed.name << ", " << engine << " at step " << n);
        }
      }
    }
  }
}

// A rod of 1 m and 1 kg, released level and caught at the bottom of its swing: 2.457095565 N and 24.515808869 N (closed
// form). A report is the mean over a step. In a step the force rotates with the rod and changes with its angle, by less
// than 3 w dt of itself.
BOOST_AUTO_TEST_CASE(a_pendulum_pulls_at_its_hinge_as_the_closed_form_says) {
  constexpr double kInertia = (1 + 0.05 * 0.05) / 12, kFine = 1e-4;      // kg m², s
  const double at_bottom = std::sqrt(2 * kG * 0.5 / (kInertia + 0.25));  // rad/s
  for (const auto& [engine, within] : of_trees()) {
    for (const bool is_b : {true, false}) {
      for (const bool is_level : {true, false}) {
        Scene scene =
            held(HingeJoint{Vec3::Zero(), Vec3::UnitZ()}, is_level ? Vec3(0.5, 0, 0) : Vec3(0, -0.5, 0), is_b);
        scene.bodies[0].mass = 1, scene.bodies[0].inertia = Vec3(kInertia, kInertia, kInertia).asDiagonal();
        if (!is_level)
          scene.bodies[0].angular_velocity = {0, 0, at_bottom}, scene.bodies[0].velocity = {0.5 * at_bottom, 0, 0};
        // A spring and a damper along the free axis are loads and no part of what the hinge carries; they do nothing
        // yet.
        scene.joints[0].stiffness = 3;
        const auto world = load_named(engine, scene);
        ask_for_reactions(*world);
        world->step(kFine);
        const ReportedReaction carried = reported_reactions(*world).at(0);
        // Bullet's feedback has the centripetal force twice.
        const double twice = engine == "bullet:multibody" && !is_level ? 0.5 * at_bottom * at_bottom : 0;
        const double expected = (is_level ? 2.457095565 : 24.515808869) + twice;
        BOOST_TEST_CONTEXT(engine << ", " << carried.force.transpose() << "; " << carried.torque.transpose()) {
          BOOST_TEST((carried.force - Vec3(0, expected, 0)).norm() < 3 * at_bottom * kFine * expected);
          // About the centre of mass: the force has an arm of half a metre, and the hinge no couple along its axis.
          const Vec3 arm = -scene.bodies[0].position;
          BOOST_TEST((carried.torque - arm.cross(carried.force)).norm() < 1e-9);
        }
      }
    }
  }
}

// What a motor does about a hinge's axis is no part of what the hinge carries.
BOOST_AUTO_TEST_CASE(efforts_along_a_free_axis_are_no_reactions) {
  for (const auto& [engine, within] : of_trees()) {
    for (const bool is_b : {true, false}) {
      Scene scene = held(HingeJoint{Vec3::Zero(), Vec3::UnitY()}, {0.5, 0, 0}, is_b);
      Motor motor{.joint = 0, .speed = {}};
      motor.effort = 0.7;
      scene.motors = {motor};
      const auto world = load_named(engine, scene);
      ask_for_reactions(*world);
      world->step(1e-6);  // it has hardly begun to turn
      const ReportedReaction carried = reported_reactions(*world).at(0);
      const Vec3 couple = carried.torque - Vec3(-0.5, 0, 0).cross(carried.force);
      // The body is lopsided: the axis takes couples across it, but none along it.
      BOOST_TEST(std::abs(couple.y()) < 1e-6, engine << ": " << couple.transpose());
      BOOST_TEST(std::abs(carried.force.z()) > 0.1, engine);  // what turns the centre
    }
  }
}

// A bar between two balls, one of which closes a loop: each carries half of its weight, within the softness of MuJoCo's
// equalities.
BOOST_AUTO_TEST_CASE(loops_carry_their_share) {
  Scene scene = held(BallJoint{{-0.5, 0, 0}}, {0, 0, 0}, true);
  scene.joints.push_back({kWorld, 0, BallJoint{{0.5, 0, 0}}});
  for (const auto& [engine, within] : of_trees()) {
    if (engine == "bullet:multibody" || engine == "simbody:semi-explicit-euler") continue;  // no loops
    const auto world = load_named(engine, scene);
    ask_for_reactions(*world);
    world->step(kStep);
    const auto reactions = reported_reactions(*world);
    if (engine == "dart") {  // it does not say what its loops carry
      BOOST_TEST(reactions.empty());
      continue;
    }
    BOOST_REQUIRE(reactions.size() == 2u);
    for (const auto& [n, x] : {std::pair(0, -0.5), std::pair(1, 0.5)}) {
      const ReportedReaction& carried = reactions[static_cast<std::size_t>(n)];
      BOOST_TEST_CONTEXT(engine << ", " << carried.force.transpose() << "; " << carried.torque.transpose()) {
        BOOST_TEST(std::abs(carried.force.y() - kG) < 1e-3 * kG);
        BOOST_TEST(std::abs(carried.torque.z() - x * kG) < 1e-3 * kG);
      }
    }
  }
}

// Rows that correct a share erp of a gap per step begin without a gap. They carry too much until the gap equals what a
// rotating body opens in each step. The excess decays by (1 - erp) per step for any step, so the largest reported error
// does not fall with the step.
BOOST_AUTO_TEST_CASE(what_rows_carry_too_much_at_the_start_dies_out_by_the_share_they_leave) {
  constexpr double kFine = 1e-4;  // s
  for (const double erp : {0.5, 0.2}) {
    Scene scene = held(HingeJoint{Vec3::Zero(), Vec3::UnitZ()}, {0, -0.5, 0}, true);
    scene.bodies[0].angular_velocity = {0, 0, 5}, scene.bodies[0].velocity = {2.5, 0, 0};
    const auto world = load_named("ode:worldstep,cfm=1e-10,erp=" + std::to_string(erp), scene);
    ask_for_reactions(*world);
    const double expected = 2 * (kG + 0.5 * 25);
    double last = 0;
    for (int n = 1; n <= 6; ++n) {
      world->step(kFine);
      const double too_much = reported_reactions(*world).at(0).force.y() - expected;
      // The body has turned by 3 mrad at most, which changes its pull by 1e-5 of itself.
      if (n > 2) BOOST_TEST(std::abs(too_much / last - (1 - erp)) < 0.02, erp << ", step " << n << ": " << too_much);
      last = too_much;
    }
    BOOST_TEST(std::abs(last) > 0.01 * expected * erp);
  }
}

BOOST_AUTO_TEST_CASE(an_engine_that_has_no_report_has_none) {
  const Scene scene = held(BallJoint{{0, 0.5, 0}}, {0, 0, 0}, true);
  const auto world = load_named("core:rk4", scene);
  ask_for_reactions(*world);
  world->step(kStep);
  BOOST_TEST(reported_reactions(*world).empty());
}

// A decorator returns the capabilities of the world that it wraps.
BOOST_AUTO_TEST_CASE(an_engine_with_a_fault_reports_as_the_engine_does) {
  const Scene scene = held(BallJoint{{0, 0.5, 0}}, {0, 0, 0}, true);
  const BrokenEngine broken(find_engine(engines(), "ode"), Fault{.name = "none"});
  const auto world = broken.load(scene, parse_run_name("ode", infos_of(engines())).settings);
  ask_for_reactions(*world);
  world->step(kStep);
  const auto found = reported_reactions(*world);
  BOOST_REQUIRE(found.size() == 1u);
  BOOST_TEST((found[0].force - after_one_step("ode", scene).force).norm() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
