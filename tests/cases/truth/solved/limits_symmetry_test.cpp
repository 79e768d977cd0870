// Limits of joints and motors of given speed under exact symmetries: other units, a mirror, a turn, the reverse order
// of bodies. A threshold in absolute units would move a scene of micrometres, or of hours, differently.
#include <algorithm>
#include <cmath>

#include "cases/truth/distance.h"
#include "cases/truth/solved/events/equivalent_scene.h"
#include "tests/cases/judged.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_limits_symmetry)

namespace {

// A block falls onto the lower end of an inclined rail and bounces until it rests there. A spring holds a second one
// back.
Scene bouncing_blocks() {
  Scene scene;
  scene.gravity = {-3, 0, -9.81};
  scene.bodies = {body("falls", 2, {0.1, 0.2, 0.3}), body("held", 1, {0.1, 0.1, 0.1}, {0.7, 0, 0.2})};
  Joint rail{.a = kWorld, .b = 0, .type = SliderJoint{Vec3(0.6, 0, 0.8)}};
  rail.lower = -0.2, rail.upper = 0.5, rail.restitution = 0.5;
  Joint between{.a = 0, .b = 1, .type = SliderJoint{Vec3::UnitY()}};
  between.lower = -0.1, between.upper = 0.15, between.restitution = 0.7;
  between.stiffness = 40, between.quadratic_stiffness = 100;
  scene.joints = {rail, between};
  scene.bodies[1].velocity = {0, 0.9, 0};
  scene.springs = {spring(kWorld, {0.5, 0.3, 1}, 1, {0, 0.1, 0}, 5, 0.4)};
  scene.springs[0].quadratic_stiffness = 8;
  return scene;
}

// A motor turns an arm to its limit, holds it there, and is overcome by a push.
Scene driven_arm() {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {body("arm", 1.5, {0.05, 0.05, 0.02}, {0.4, 0, 0})};
  Joint hinge{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitY()}};
  hinge.lower = -1, hinge.upper = 0.6, hinge.restitution = 0.4;
  hinge.stiffness = 0.5, hinge.quadratic_stiffness = 0.4;
  scene.joints = {hinge};
  scene.motors = {{.joint = 0, .effort = 0, .speed = -1.5, .most = 9}};
  TimedForce down;
  down.body = 0, down.force = {0, 0, -30}, down.from = 1, down.until = 1.6;
  scene.forces = {down};
  return scene;
}

Simulation limited_run(const Scene& scene, const std::string& method, double time) {
  return simulate(engines().find("core"), {method, {}, {}}, scene, time / 60, 2 * time,
                  {.steps_per_sample = 1, .is_timed = false});
}

// m and rad, in the original's units.
double most_apart(const Scene& scene, const std::string& method, const Equivalence& how) {
  const Simulation here = limited_run(scene, method, 1), there = limited_run(equivalent(scene, how), method, how.time);
  const std::size_t count = here.trajectory.samples.size();
  BOOST_TEST_REQUIRE(there.trajectory.samples.size() == count);
  BOOST_TEST(here.solver_warning.empty());
  double most = 0;
  BodyTable seen(scene.bodies.size());
  for (std::size_t k = 0; k < count; ++k) {
    to_original(how, there.trajectory.samples[k].bodies.columns(), seen.columns());
    most = std::max(most, distance_between(here.trajectory.samples[k].bodies.columns(), std::as_const(seen).columns()));
  }
  return most;
}

}  // namespace

// Powers of two scale every product exactly, so that rounding alone is left. One bound serves gaps in metres and sines
// of angles where joints are closed, and it grows with the length: at 2^20 it leaves 2.6e-9.
BOOST_AUTO_TEST_CASE(units_change_nothing_but_rounding) {
  for (const Scene& scene : {bouncing_blocks(), driven_arm()}) {
    for (const char* method : {"rk4", "rkmk4", "semi-implicit-euler"}) {
      for (const auto& [length, time] : {std::pair(0x1p-20, 1.0), {0x1p10, 1.0}, {1.0, 0x1p-12}, {1.0, 0x1p20}}) {
        Equivalence units;
        units.length = length, units.time = time;
        const double apart = most_apart(scene, method, units);
        BOOST_TEST(apart < 1e-10, method << " in units of " << length << " and " << time << ": " << apart);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(mirrors_turns_and_order_change_nothing_but_rounding) {
  Equivalence mirrored, turned, reversed;
  mirrored.is_mirrored = true, turned.turn = Quat(0.8, 0.2, -0.4, 0.4), reversed.is_reversed = true;
  for (const Scene& scene : {bouncing_blocks(), driven_arm()}) {
    for (const char* method : {"rk4", "semi-implicit-euler"}) {
      for (const Equivalence& how : {mirrored, turned, reversed})
        BOOST_TEST(most_apart(scene, method, how) < 1e-10, method);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
