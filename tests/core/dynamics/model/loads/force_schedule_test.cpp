#include "core/dynamics/model/loads/force_schedule.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <ctime>
#include <limits>
#include <random>

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/model/loads/loads.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_model_loads_force_schedule)

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Durations from an instant to infinity, some at the same instants.
std::vector<TimedForce> some_forces(int count) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> begin(0, 40), kind(0, 9), length(1, 9);
  std::vector<TimedForce> forces(count);
  for (TimedForce& force : forces) {
    force.body = 0;
    force.from = kind(random) == 0 ? -kInfinity : 0.25 * begin(random);
    force.until = kind(random) == 0 ? kInfinity : std::max(0.0, force.from) + 0.25 * length(random);
  }
  return forces;
}

// By a search through all.
double nearest_switch(const std::vector<TimedForce>& forces, double t, double end) {
  for (const TimedForce& force : forces) {
    for (const double s : {force.from, force.until}) {
      if ((s > t && s < end) || (s < t && s > end)) end = s;
    }
  }
  return end;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_finds_what_acts_and_what_is_next_as_a_look_at_each_force_does) {
  for (const int count : {0, 1, 2, 33, 200}) {
    const std::vector<TimedForce> forces = some_forces(count);
    const ForceSchedule schedule(forces);
    for (const double t : {-1.0, 0.0, 0.1, 0.25, 3.9, 4.0, 11.0, 13.0}) {
      for (const double dt : {0.0, 0.1, 0.25, 5.0, -0.1, -0.25, -5.0}) {
        BOOST_TEST_CONTEXT(count << " forces, from " << t << " for " << dt) {
          const std::vector<std::size_t> found = schedule.acting(t, t + dt);
          BOOST_TEST(std::is_sorted(found.begin(), found.end()));
          for (std::size_t i = 0; i < forces.size(); ++i) {
            const bool is_found = std::binary_search(found.begin(), found.end(), i);
            const double low = std::min(t, t + dt), high = std::max(t, t + dt);
            BOOST_TEST((is_found || forces[i].until <= low || forces[i].from > high), "force " << i);
            BOOST_TEST((!is_found || (forces[i].until >= low && forces[i].from <= high)), "force " << i);
          }
          BOOST_TEST(schedule.next_switch(t, t + dt) == nearest_switch(forces, t, t + dt));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_step_backward_has_the_share_of_the_forces_that_it_passes) {
  TimedForce force;
  force.from = 1, force.until = 2;
  BOOST_TEST(share_of_step(force, 0.5, -0.25) == 0);
  BOOST_TEST(share_of_step(force, 1.25, -0.5) == 0.5);
  BOOST_TEST(share_of_step(force, 1.75, -0.5) == 1);
  BOOST_TEST(share_of_step(force, 2.25, -0.5) == 0.5);
}

// 20,000 forces, one after another, each a part of a step to a method of high order. At a look at each force for each
// part these are 4e8 looks a stage, six seconds measured; found by the schedule, 0.2 s of which most is the stepping.
BOOST_AUTO_TEST_CASE(work_grows_with_the_forces_that_act_and_not_with_all_there_are) {
  Scene scene;
  scene.bodies = {test::body("ball", 1, {1, 1, 1})};
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    TimedForce force;
    force.body = 0, force.force = {i % 2 ? 1.0 : 3.0, 0, 0};
    force.from = static_cast<double>(i) / kCount, force.until = static_cast<double>(i + 1) / kCount;
    scene.forces.push_back(force);
  }
  const System system(scene);
  const auto stepper = integrator("rk4").make({system, nullptr, nullptr, {}});
  BodyTable state(1);
  set_initial_state(scene, state.columns());
  const std::clock_t before = std::clock();
  for (int n = 0; n < 30; ++n) stepper->step(state.columns(), n / 30.0, 1 / 30.0);
  BOOST_TEST(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC < 2);
  // The impulse of all, but for the roundings of 20,000 parts.
  BOOST_TEST(std::abs(state.columns().velocity(0).x() - 2) < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
