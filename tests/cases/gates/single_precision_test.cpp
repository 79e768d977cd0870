#include "cases/gates/single_precision.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/runner/faulty_engine.h"
#include "tests/scenes.h"

using namespace rigor;
using rigor::test::body;

BOOST_AUTO_TEST_SUITE(cases_gates_single_precision)

namespace {

// Two bodies that move, and one far away that does not. With 4 J, 2 kg can reach 2 m/s, and 0.5 kg m² can reach 4
// rad/s.
CaseResult thrown(double largest_kinetic_energy) {
  CaseResult result;
  result.definition = drifting_body("thrown");
  result.definition.duration = 3;
  Scene& scene = result.definition.scene;
  scene.gravity = {0, -10, 0};
  scene.bodies = {body("long", 2, {1, 2, 4}, {3, 4, 0}), body("ball", 8, {0.5, 0.5, 0.5}, {1, 0, 0}),
                  body("rock", 1000, {1e-3, 1, 1}, {100, 0, 0})};
  scene.bodies[0].velocity = {0, 0, 1}, scene.bodies[0].angular_velocity = {0, 0, 0.5};
  scene.bodies[2].fixed = true;
  if (largest_kinetic_energy > 0) {
    result.truth.emplace();
    result.truth->largest_kinetic_energy = largest_kinetic_energy;
  }
  return result;
}

const double kRelative = 8 * std::ldexp(1, -24) * std::sqrt(30);  // eight roundings in each of thirty steps

}  // namespace

BOOST_AUTO_TEST_CASE(each_unit_has_the_allowance_that_its_sizes_make) {
  const double mass = 2 + 8, inertia = 4 + 0.5, time = 3, speed = 2, spin = 4, place = 5 + speed * time;
  const double energy = 4 + mass * 10 * place;
  const std::map<std::string, double> wanted = {
      {"m", place + speed * time}, {"m/s", speed},
      {"rad", 1 + spin * time},    {"rad/s", spin},
      {"kg m/s", mass * speed},    {"kg m²/s", inertia * spin + mass * speed * place},
      {"1", energy / 4},           {"order", 0}};
  for (const auto& [unit, size] : wanted) {
    const double allowance = single_precision_allowance(thrown(4), 0.1, unit);
    BOOST_TEST(std::abs(allowance - kRelative * size) <= 1e-12 * kRelative * size, unit << ": " << allowance);
  }
}

// The speeds at the start, and those from their fall.
BOOST_AUTO_TEST_CASE(without_a_truth_the_start_and_the_fall_say_how_fast_it_gets) {
  const double speed = 1 + 10 * 3, place = 5 + 3 * speed;
  const std::map<std::string, double> wanted = {{"m", place + 3 * speed}, {"m/s", speed}, {"rad/s", 0.5}, {"1", 1}};
  for (const auto& [unit, size] : wanted) {
    const double allowance = single_precision_allowance(thrown(0), 0.1, unit);
    BOOST_TEST(std::abs(allowance - kRelative * size) <= 1e-12 * kRelative * size, unit << ": " << allowance);
  }
}

// A run of one step, or of none, has one step's roundings.
BOOST_AUTO_TEST_CASE(the_fewest_roundings_are_those_of_one_step) {
  const double relative = 8 * std::ldexp(1, -24), size = 5 + 2 * 3 + 2 * 3;
  for (const double dt : {3.0, 4.0}) {
    const double allowance = single_precision_allowance(thrown(4), dt, "m");
    BOOST_TEST(std::abs(allowance - relative * size) <= 1e-12 * relative * size, dt << ": " << allowance);
  }
}

BOOST_AUTO_TEST_SUITE_END()
