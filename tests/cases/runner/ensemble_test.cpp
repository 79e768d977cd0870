// Ensembles: starts that differ by no more than they should, outcomes that other code of the same laws repeats as a
// distribution, and ones that a wrong law does not.
#include "cases/runner/ensemble.h"

#include <boost/test/unit_test.hpp>

#include <cmath>

#include "tests/cases/judged.h"

using namespace rigor;

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

BOOST_AUTO_TEST_SUITE(cases_runner_ensemble)

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

BOOST_AUTO_TEST_CASE(the_cost_is_known_before) {
  Case definition = falling_ball(0.8);
  BOOST_TEST(cost_of_ensemble(definition, 6) ==
             "falling ball: an ensemble of 32 starts: 64 runs of a reference, and 32 in each of 6 cells");
  definition.ensemble = 0;
  BOOST_TEST(cost_of_ensemble(definition, 6) == "");
}

BOOST_AUTO_TEST_SUITE_END()
