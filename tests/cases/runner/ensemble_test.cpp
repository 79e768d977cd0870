// Ensembles: starts that differ only slightly, outcomes that other code of the same laws reproduces as a distribution,
// and outcomes that a wrong law does not.
#include "cases/runner/ensemble.h"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <random>

#include "tests/cases/judged.h"
#include "tests/cases/scripted_engine.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_ensemble)

namespace {

Body fixed_post(double x, double z) {
  Body post = test::body("post", 1, {1, 1, 1}, {x, 0, z});
  post.shape = Sphere{0.05};
  post.fixed = post.collides = true;
  return post;
}

// A ball that falls through posts.
Case falling_ball(double restitution) {
  Case out;
  out.id = "falling ball";
  Body ball = test::body("ball", 1, {1, 1, 1}, {0.12, 0, 2.5});
  ball.shape = Sphere{0.1};
  ball.inertia = inertia_of(*ball.shape, ball.mass);
  ball.velocity = Vec3::Zero(), ball.angular_velocity = Vec3::Zero();
  ball.collides = true;
  out.scene.gravity = {0, 0, -9.81};
  out.scene.bodies = {ball};
  for (int row = 0; row < 5; ++row) {
    for (int k = -2; k <= 2; ++k) out.scene.bodies.push_back(fixed_post(0.5 * k + 0.25 * (row % 2), 2 - 0.4 * row));
  }
  out.scene.contact_default = {restitution, 0};
  out.duration = 3;
  out.dt = {{1.0 / 120, "1/120"}};
  out.ensemble = 32;
  return out;
}

RunName named(const std::string& text) { return parse_run_name(text, infos_of(engines())); }

}  // namespace

BOOST_AUTO_TEST_CASE(starts_differ_by_a_millionth_and_by_their_seed_alone) {
  const Scene scene = falling_ball(0.7).scene;
  const Scene one = jittered(scene, 1), again = jittered(scene, 1), other = jittered(scene, 2);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Vec3 moved = one.bodies[i].position - scene.bodies[i].position,
               pushed = one.bodies[i].velocity - scene.bodies[i].velocity;
    BOOST_TEST(one.bodies[i].position == again.bodies[i].position);
    BOOST_TEST((one.bodies[i].position == other.bodies[i].position) == scene.bodies[i].fixed);
    BOOST_TEST(moved.isZero(0) == scene.bodies[i].fixed);
    BOOST_TEST(pushed.isZero(0) == scene.bodies[i].fixed);
    BOOST_TEST(moved.cwiseAbs().maxCoeff() <= kJitter * (1 + 1e-9));
    BOOST_TEST(pushed.cwiseAbs().maxCoeff() <= kJitter * (1 + 1e-9));
  }
  // Along each axis, and as far either way.
  for (int axis = 0; axis < 3; ++axis) {
    double least = 0, most = 0;
    for (std::uint64_t seed = 1; seed <= 64; ++seed) {
      const Scene jitter = jittered(scene, seed);
      const double moved = jitter.bodies[0].position[axis] - scene.bodies[0].position[axis];
      least = std::min(least, moved), most = std::max(most, moved);
      BOOST_TEST(jitter.bodies[0].velocity[axis] != 0);
    }
    BOOST_TEST((least < -0.9 * kJitter && most > 0.9 * kJitter));
  }
}

// The generator's numbers are the same with every library, and so are the starts: places first, then velocities.
BOOST_AUTO_TEST_CASE(starts_are_the_same_everywhere) {
  Scene scene;
  scene.bodies = {test::body("a", 1, {1, 1, 1}), test::body("b", 1, {1, 1, 1})};
  const Scene moved = jittered(scene, 5);
  std::mt19937_64 random(5);
  for (const Body& body : moved.bodies) {
    for (const Vec3& start : {body.position, body.velocity}) {
      for (int axis = 0; axis < 3; ++axis) {
        const double share = std::ldexp(static_cast<double>(random() >> 11), -52) - 1;  // 53 bits, from -1 to 1
        BOOST_TEST(start[axis] == kJitter * share);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(other_code_of_the_same_laws_has_the_same_outcomes_and_a_wrong_law_has_not) {
  const Case definition = falling_ball(0.8);
  const EnsembleReference reference(engines(), definition);
  const RunName impulse = named("core:velocity-verlet,contact=impulse");
  const Ensembles same = reference.compare(engines(), impulse, definition, 1.0 / 120);
  BOOST_TEST(same.flaw == "");
  BOOST_TEST(same.test.p_value > 0.01);
  Case wrong = definition;
  wrong.scene.contact_default.restitution = 0.6;
  const Ensembles other = reference.compare(engines(), impulse, wrong, 1.0 / 120);
  BOOST_TEST(other.flaw == "");
  BOOST_TEST(other.test.p_value <= 0.01, other.test.p_value);
  BOOST_TEST(other.test.coefficient > same.test.coefficient);
}

BOOST_AUTO_TEST_CASE(a_run_that_does_not_last_is_not_compared) {
  Case definition = falling_ball(0.8);
  definition.duration = 0.1;
  const EnsembleReference reference(engines(), definition);
  Case stiff = definition;
  stiff.scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 1e300, 0)};
  const Ensembles found = reference.compare(engines(), named("core:explicit-euler,contact=impulse"), stiff, 1.0 / 120);
  BOOST_TEST(!found.flaw.empty());
  BOOST_TEST(found.test.coefficient == 0);
}

// A free body ends where its start and its speed take it in a second; what is fixed has no outcome.
BOOST_AUTO_TEST_CASE(outcomes_are_where_the_bodies_that_move_end_from_one_seed_on) {
  Case definition;
  definition.scene.bodies = {fixed_post(5, 5), test::body("free", 2, {1, 1, 1}, {1, 2, 3})};
  definition.scene.bodies[1].velocity = {0.5, 0, -1};
  definition.scene.bodies[1].collides = definition.scene.bodies[0].collides = false;
  definition.duration = 1, definition.ensemble = 3;
  const RunName run = named("core:velocity-verlet");
  const Engine& core = find_engine(engines(), "core");
  std::string flaw;
  const Points outcomes = outcomes_of(core, run.settings, definition, 0.25, 7, flaw).value();
  BOOST_TEST(flaw == "");
  BOOST_TEST_REQUIRE(outcomes.size() == 3u);
  for (std::uint64_t k = 0; k < 3; ++k) {
    const Body start = jittered(definition.scene, 7 + k).bodies[1];
    BOOST_TEST_REQUIRE(outcomes[k].size() == 3u);
    for (int axis = 0; axis < 3; ++axis)
      BOOST_TEST(outcomes[k][axis] == start.position[axis] + start.velocity[axis], boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(one_start_that_blows_up_or_breaks_a_promise_spoils_all) {
  Case definition;
  definition.scene = test::tumbling_body();
  definition.duration = 1, definition.ensemble = 3;
  int worlds = 0;
  test::Script lost, failing;
  lost.play = [&](int step, MutableBodyColumns bodies) {
    worlds += step == 0;
    bodies.set_position(0, {0, worlds == 2 && step == 4 ? std::nan("") : 0, 0});
  };
  failing.solver_warning = [](int step) { return step < 2 ? "" : "failed in step " + std::to_string(step); };
  std::string flaw;
  BOOST_TEST(!outcomes_of(test::ScriptedEngine(lost), {}, definition, 0.25, 1, flaw).has_value());
  BOOST_TEST(flaw == "start 2 blew up");
  BOOST_TEST(worlds == 2);
  flaw.clear();
  BOOST_TEST(!outcomes_of(test::ScriptedEngine(failing), {}, definition, 0.25, 1, flaw).has_value());
  BOOST_TEST(flaw == "failed in step 2");
}

// The reference uses the case's finest step. With 8 steps of 0.05 s per radian of a swing its distance from the result
// at half of that step is 1e-3 of the way, a thousand times the difference of the starts.
BOOST_AUTO_TEST_CASE(a_reference_whose_outcomes_depend_on_its_step_is_none) {
  Case definition;
  definition.scene.bodies = {test::body("bead", 1, {1, 1, 1}, {1, 0, 0})};
  definition.duration = 1, definition.ensemble = 16;
  definition.dt = {{0.25, "1/4"}, {0.05, "1/20"}, {0.1, "1/10"}};
  const RunName run = named("core:velocity-verlet");
  const auto flaw_of = [&](const Case& asked) {
    return EnsembleReference(engines(), asked).compare(engines(), run, asked, 0.05);
  };
  const Ensembles free = flaw_of(definition);
  BOOST_TEST(free.flaw == "");
  BOOST_TEST(free.test.p_value > 0.01);
  definition.scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 9, 0)};
  const Ensembles swinging = flaw_of(definition);
  BOOST_TEST(swinging.flaw.starts_with(
                 "no reference: its own outcomes differ between its step and half of that (H = 1, p = 0.001)"),
             swinging.flaw);
  definition.scene.springs[0].stiffness = 1e300;
  BOOST_TEST(flaw_of(definition).flaw == "no reference: start 1 blew up");
}

BOOST_AUTO_TEST_CASE(the_cost_is_known_before) {
  Case definition = falling_ball(0.8);
  BOOST_TEST(cost_of_ensemble(definition, 6) ==
             "falling ball: an ensemble of 32 starts: 64 runs of a reference, and 32 in each of 6 cells");
  definition.ensemble = 0;
  BOOST_TEST(cost_of_ensemble(definition, 6) == "");
}

BOOST_AUTO_TEST_SUITE_END()
