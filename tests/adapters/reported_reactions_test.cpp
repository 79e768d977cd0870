// What engines themselves say their joints carry, where statics says it.
#include "core/engine/reported_reactions.h"

#include <boost/test/unit_test.hpp>

#include "core/engine/run_name.h"
#include "tests/adapters/ode/jointed_scenes.h"
#include "tests/adapters/seam_runs.h"

using namespace rigor;

namespace {

constexpr const char* kReporting[] = {"ode:worldstep", "ode:quickstep,iterations=200", "bullet,iterations=200",
                                      "bullet:mlcp"};
constexpr double kG = 9.81, kStep = 1.0 / 240;

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

BOOST_AUTO_TEST_SUITE(adapters_reported_reactions)

// To what ODE's CFM lets a joint give way in a step, 1e-4 of it as matched; sweeps enough to converge.
BOOST_AUTO_TEST_CASE(what_hangs_is_carried_with_its_weight) {
  for (const char* engine : kReporting) {
    for (const bool is_b : {true, false}) {
      const ReportedReaction carried = after_one_step(engine, held(BallJoint{{0, 0.5, 0}}, {0, 0, 0}, is_b));
      BOOST_TEST_CONTEXT(engine << ", " << carried.force.transpose() << ", " << carried.torque.transpose()) {
        BOOST_TEST(carried.body == 0);
        BOOST_TEST((carried.force - Vec3(0, 2 * kG, 0)).norm() < 1e-3 * 2 * kG);
        BOOST_TEST(carried.torque.norm() < 1e-3 * kG);
      }
    }
  }
}

// The weight acts at the centre of mass, about which a report's torque is: the hinge's couple and the moment of its
// force, 1 m kg g each, take each other out.
BOOST_AUTO_TEST_CASE(torques_are_about_the_centre_of_mass) {
  for (const char* engine : kReporting) {
    const HingeJoint post{Vec3::Zero(), Vec3::UnitY()};
    const ReportedReaction carried = after_one_step(engine, held(post, {0.5, 0, 0}, true));
    BOOST_TEST_CONTEXT(engine << ", " << carried.force.transpose() << ", " << carried.torque.transpose()) {
      BOOST_TEST((carried.force - Vec3(0, 2 * kG, 0)).norm() < 1e-3 * 2 * kG);
      BOOST_TEST(carried.torque.norm() < 1e-3 * kG);
    }
  }
}

BOOST_AUTO_TEST_CASE(an_engine_that_is_asked_moves_as_if_it_were_not) {
  for (const test::JointedScene& jointed : test::jointed_scenes()) {
    for (const char* engine : kReporting) {
      if (std::string(engine).find("bullet") == 0 &&
          std::holds_alternative<DistanceJoint>(jointed.scene.joints[0].type))
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

BOOST_AUTO_TEST_CASE(an_engine_that_has_no_report_has_none) {
  const Scene scene = held(BallJoint{{0, 0.5, 0}}, {0, 0, 0}, true);
  const auto world = load_named("core:rk4", scene);
  ask_for_reactions(*world);
  world->step(kStep);
  BOOST_TEST(reported_reactions(*world).empty());
}

BOOST_AUTO_TEST_SUITE_END()
