// rigor diverge: a planted difference is found at its instant and named; what is not there is not named.
#include "cases/analysis/divergence/divergence.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "tests/cases/analysis/divergence/changed_engine.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/scenes.h"

using namespace rigor;
using namespace rigor::test;

namespace cases_analysis_divergence_divergence {

Case case_of(Scene scene, double duration) {
  Case definition;
  definition.id = "test", definition.scene = std::move(scene), definition.duration = duration;
  return definition;
}

// Two runs of a scene: the first as named, the second by the engine `changed` if there is a change.
struct Planted {
  EngineTable table = built_in_engines();

  Divergence diverge(const Scene& scene, double duration, const std::string& a, const std::string& b, double dt,
                     double dt_b = 0) const {
    const DivergingRun first{parse_run_name(a, table.infos()), {dt, "dt"}};
    const DivergingRun second{parse_run_name(b, table.infos()), {dt_b > 0 ? dt_b : dt, dt_b > 0 ? "dt_b" : "dt"}};
    return rigor::diverge(table, case_of(scene, duration), first, second, default_parting_bounds(scene), {1, 60});
  }
  Divergence changed(const Scene& scene, double duration, double dt, const std::function<void(Scene&)>& change) {
    table.add(std::make_unique<ChangedEngine>("core", change));
    return diverge(scene, duration, "core:velocity-verlet", "changed:velocity-verlet", dt);
  }
};

std::string first_cause(const Divergence& found) { return found.causes.empty() ? "" : found.causes.front().what; }

void for_each_law(Scene& scene, const std::function<void(ContactLaw&)>& change) {
  change(scene.contact_default);
  for (ContactPair& pair : scene.contact_pairs) change(pair.law);
}

Scene thrown_stone() {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {body("stone", 2, {0.02, 0.02, 0.02}), body("still", 1, {0.1, 0.1, 0.1}, {0.5, 0, 0})};
  scene.bodies[0].velocity = {1, 0, 2};
  return scene;
}

// A rod on a hinge through its end, `angle` [rad] from hanging.
Scene rod_on_hinge(double angle) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {body("rod", 1, {1.0 / 12, 1.0 / 12, 1e-3}, {0.5 * std::sin(angle), 0, -0.5 * std::cos(angle)})};
  scene.bodies[0].orientation = rotation_by(Vec3(0, -angle, 0));
  scene.joints = {{kWorld, 0, HingeJoint{Vec3::Zero(), Vec3::UnitY()}, "pivot"}};
  return scene;
}

// A box of 0.2 m that slides on a plane.
Scene sliding_box() {
  Scene scene = dropped_sphere(0);
  scene.bodies[0] = body("box", 2, {2 * 0.04 / 6, 2 * 0.04 / 6, 2 * 0.04 / 6}, {0, 0.1, 0});
  scene.bodies[0].shape = Box{{0.2, 0.2, 0.2}}, scene.bodies[0].collides = true;
  scene.bodies[0].velocity = {2, 0, 0};
  scene.contact_default = {0, 0.3};
  return scene;
}

}  // namespace cases_analysis_divergence_divergence

BOOST_FIXTURE_TEST_SUITE(cases_analysis_divergence_divergence, Planted)

BOOST_AUTO_TEST_CASE(the_same_run_never_parts) {
  const Divergence found = changed(coupled_bodies(0), 1, 1.0 / 100, [](Scene&) {});
  BOOST_TEST(!found.parting);
  BOOST_TEST(found.largest.share == 0);
  BOOST_TEST(found.spread_a == 0);
}

// A gap of g t²/200 reaches the bound at t = sqrt(200 bound/g). Nothing amplifies it, and it enters evenly.
BOOST_AUTO_TEST_CASE(too_much_gravity_parts_where_the_parabola_says_and_is_named) {
  constexpr double dt = 1.0 / 200;
  const Divergence found = changed(thrown_stone(), 1, dt, [](Scene& s) { s.gravity *= 1.01; });
  BOOST_TEST_REQUIRE(found.parting.has_value());
  const double due = std::sqrt(200 * found.bounds.position / 10);
  BOOST_TEST(found.parting->time >= due - 1e-9);
  BOOST_TEST(found.parting->time <= due + dt);
  BOOST_TEST(found.parting->component == "pz");
  BOOST_TEST(found.parting->part < 0);
  BOOST_TEST(first_cause(found) == "gravity");
  BOOST_TEST(!found.causes.front().falls_with_dt());
  BOOST_TEST(found.injections.injected == 1, boost::test_tools::tolerance(0.02));
  BOOST_TEST(found.injections.growth_factor == 1, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(!found.swaps.best);
}

BOOST_AUTO_TEST_CASE(the_body_that_parts_is_named_and_not_its_neighbour) {
  const Divergence found = changed(thrown_stone(), 1, 1.0 / 100, [](Scene& s) { s.bodies[1].velocity.y() += 0.1; });
  BOOST_TEST_REQUIRE(found.parting.has_value());
  BOOST_TEST(found.parting->body == 1);
  BOOST_TEST(found.parting->component == "py");
}

BOOST_AUTO_TEST_CASE(of_two_springs_the_changed_one_is_named) {
  for (const std::size_t k : {0, 1}) {
    Planted own;
    const Divergence found = own.changed(coupled_bodies(0), 2, 1.0 / 200, [k](Scene& s) {
      for (Spring& spring : s.springs) {
        if ((spring.a == kWorld) == (k == 0)) spring.stiffness *= 1.05;
      }
    });
    BOOST_TEST_REQUIRE(found.parting.has_value());
    BOOST_TEST(first_cause(found) ==
               (k == 0 ? "the spring of 'world' and 'upper'" : "the spring of 'upper' and 'lower'"));
    BOOST_TEST(!found.causes.front().falls_with_dt());
  }
}

// The ball meets the ground at sqrt(2 (1.47 - 0.1)/g).
BOOST_AUTO_TEST_CASE(another_restitution_enters_at_the_impact) {
  constexpr double dt = 1.0 / 200;
  const Divergence found = changed(dropped_sphere(0.5), 1, dt,
                                   [](Scene& s) { for_each_law(s, [](ContactLaw& law) { law.restitution *= 1.2; }); });
  BOOST_TEST_REQUIRE(found.parting.has_value());
  const double impact = std::sqrt(2 * 1.37 / 9.8);
  BOOST_TEST(found.parting->time >= impact - dt);
  BOOST_TEST(found.parting->time <= impact + 5 * dt);
  BOOST_TEST_REQUIRE(!found.causes.empty());
  BOOST_TEST(std::abs(found.causes.front().at.time - impact) <= 2 * dt);
  BOOST_TEST(first_cause(found) == "the restitution of 'ball' and 'ground'");
  BOOST_TEST(found.causes.size() == 1u);  // nothing enters before
}

BOOST_AUTO_TEST_CASE(another_friction_is_named_before_its_contact) {
  const Divergence found = changed(sliding_box(), 0.3, 1.0 / 200,
                                   [](Scene& s) { for_each_law(s, [](ContactLaw& law) { law.friction *= 1.2; }); });
  BOOST_TEST_REQUIRE(found.parting.has_value());
  BOOST_TEST(first_cause(found) == "the friction of 'box' and 'ground'");
  BOOST_TEST(found.causes.front().detail.starts_with("slips"), found.causes.front().detail);
}

BOOST_AUTO_TEST_CASE(a_limit_that_bounces_is_named_where_it_is_met) {
  Scene scene = rod_on_hinge(1);
  scene.joints[0].lower = -1, scene.joints[0].upper = 1;
  const Divergence found = changed(scene, 1, 1.0 / 400, [](Scene& s) { s.joints[0].restitution = 0.5; });
  BOOST_TEST_REQUIRE(found.parting.has_value());
  BOOST_TEST(first_cause(found) == "the limit of joint 'pivot'");
}

// The light head hangs at the foot's centre by a ball joint, so the foot's impact reaches it. Without the joint the
// head would not notice the impact, but the foot would.
BOOST_AUTO_TEST_CASE(a_joint_that_hands_an_impact_on_is_not_its_cause) {
  Scene scene = dropped_sphere(0.2);
  scene.bodies[0].position.y() = 0.3;
  scene.bodies.push_back(body("head", 0.1, {1e-3, 1e-3, 1e-3}, {0.3, 0.3, 0}));
  scene.joints = {{0, 2, BallJoint{scene.bodies[0].position}, "neck"}};
  const Divergence found =
      changed(scene, 0.5, 1.0 / 200, [](Scene& s) { for_each_law(s, [](ContactLaw& law) { law.restitution *= 2; }); });
  BOOST_TEST_REQUIRE(found.parting.has_value());
  BOOST_TEST(first_cause(found) == "the restitution of 'ball' and 'ground'");
}

BOOST_AUTO_TEST_CASE(another_drive_is_named) {
  Scene scene = rod_on_hinge(0.3);
  Motor motor;
  motor.joint = 0, motor.effort = 1.5, motor.from = 0.25;
  scene.motors = {motor};
  const Divergence found = changed(scene, 1, 1.0 / 400, [](Scene& s) {
    for (Motor& own : s.motors) own.effort *= 1.1;
  });
  BOOST_TEST_REQUIRE(found.parting.has_value());
  BOOST_TEST(first_cause(found) == "the drive of joint 'pivot'");
  BOOST_TEST_REQUIRE(!found.causes.empty());
  BOOST_TEST(found.causes.front().at.time >= 0.25 - 1.0 / 400);
}

// Near the top x'' = w² x: a nudge at rest grows like cosh(w T). Of the nudge in three directions one turns the rod,
// which then moves by that much in position and in angle: sqrt(2/3) of it.
BOOST_AUTO_TEST_CASE(growth_is_that_of_the_motion) {
  const double w = std::sqrt(10 * 0.5 / (1.0 / 12 + 0.25));
  const Divergence found =
      changed(rod_on_hinge(std::numbers::pi - 1e-6), 3, 1.0 / 200, [](Scene& s) { s.gravity.x() += 1e-5; });
  BOOST_TEST_REQUIRE(found.parting.has_value());
  const double due = std::sqrt(2.0 / 3) * std::cosh(w * found.parting->time);
  BOOST_TEST(found.injections.growth_factor == due, boost::test_tools::tolerance(0.05));
  BOOST_TEST(found.injections.injected < 0.5);  // the motion amplifies what enters
}

BOOST_AUTO_TEST_CASE(where_only_the_step_differs_no_setting_is_named) {
  const Divergence found =
      diverge(coupled_bodies(0), 2, "core:semi-implicit-euler", "core:semi-implicit-euler", 1.0 / 60, 1.0 / 120);
  BOOST_TEST_REQUIRE(found.parting.has_value());
  BOOST_TEST_REQUIRE(!found.causes.empty());
  BOOST_TEST(found.causes.front().falls_with_dt());
  for (const TriedSwap& one : found.swaps.tried) {
    for (const SettingSwap& swap : one.swaps) BOOST_TEST((swap.kind == SettingSwap::Kind::step));
  }
}

BOOST_AUTO_TEST_CASE(steps_that_never_end_together_are_refused) {
  BOOST_CHECK_THROW(diverge(thrown_stone(), 0.02, "core", "core", 0.01, 0.015), InputError);
}

// Of several settings that differ, only one acts on a free body: the others are decoys.
BOOST_AUTO_TEST_CASE(the_setting_that_acts_is_named_among_decoys) {
  const Divergence found =
      diverge(tumbling_body(), 3, "ode:quickstep", "ode:quickstep,erp=0.7,gyroscopic=off,iterations=77", 1.0 / 100);
  BOOST_TEST_REQUIRE(found.parting.has_value());
  BOOST_TEST_REQUIRE(found.swaps.best.has_value());
  BOOST_TEST_REQUIRE(found.swaps.best->swaps.size() == 1u);
  BOOST_TEST(found.swaps.best->swaps.front().option == "gyroscopic");
  BOOST_TEST(found.swaps.best->closes == 1);
  BOOST_TEST(first_cause(found) == "the gyroscopic term of 'top'");
}

BOOST_AUTO_TEST_CASE(what_an_engine_lacks_is_refused_with_the_feature) {
  Scene scene = sliding_box();
  BOOST_CHECK_EXCEPTION(diverge(scene, 1, "core", "simbody", 1.0 / 100), InputError,
                        [](const InputError& error) { return std::string(error.what()).find("simbody") == 0; });
}

// Two sliders and a hinge, a spring on each slider's axis; the second one is changed.
BOOST_AUTO_TEST_CASE(of_the_axes_of_a_compound_joint_the_changed_one_is_named) {
  Scene scene = suite_scene("joints/compound-root");
  for (const std::size_t k : {1, 2}) scene.joints[k].stiffness = 200;
  const Divergence found = changed(scene, 1, 1.0 / 200, [](Scene& s) { s.joints[2].stiffness *= 1.05; });
  BOOST_TEST_REQUIRE(found.parting.has_value());
  BOOST_TEST(first_cause(found) == "the spring and damper of joint 'rootz'");
}

// A restarted scene has the state of the running one: nothing is hidden in a method without memory.
BOOST_AUTO_TEST_CASE(a_compound_joint_hides_nothing) {
  const Divergence found =
      diverge(suite_scene("joints/compound-root"), 1, "core:rk4", "core:semi-implicit-euler", 0.01);
  BOOST_TEST_REQUIRE(found.parting.has_value());
  for (const Injection& step : found.injections.steps) {
    BOOST_TEST(step.hidden_a < 1e-6);
    BOOST_TEST(step.hidden_b < 1e-6);
  }
}

// Each distance is known to the truth's error only, so two that are nearer together than twice that have no order.
BOOST_AUTO_TEST_CASE(a_run_is_nearer_only_where_the_truth_can_tell) {
  const auto nearer = [](double a, double b, double error, const std::string& why = "") {
    DivergenceTruth truth;
    truth.a = a, truth.b = b, truth.error = error, truth.why = why;
    return truth.nearer();
  };
  BOOST_TEST((nearer(1, 2, 0.1) == RunPair::Side::a));
  BOOST_TEST((nearer(2, 1, 0.1) == RunPair::Side::b));
  BOOST_TEST(!nearer(1, 2, 0.5));
  BOOST_TEST(!nearer(1, 1, 0));
  BOOST_TEST(!nearer(1, 2, 0.1, "the case has no truth"));
}

BOOST_AUTO_TEST_SUITE_END()
