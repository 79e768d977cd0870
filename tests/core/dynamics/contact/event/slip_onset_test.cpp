// Contact by events where a slip begins or ends, and in other units.
#include <cmath>

#include "cases/truth/solved/events/equivalent_scene.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_slip_onset)

namespace {

constexpr double kEnd = 0.6;  // s

// A capsule that lands on its end, sticks, and slips from 0.25 s on.
Scene slip_begins() {
  Body capsule = solid("capsule", Capsule{0.12, 0.2}, {0, 0, 0.38});
  capsule.orientation = Quat(-0.05, -0.84, -0.44, 0.31).normalized();
  capsule.velocity = {0.74, -1.88, -0.18}, capsule.angular_velocity = {-0.78, 0.86, -2.02};
  Scene scene = on_floor({capsule}, {0, 0.9});
  std::get<Plane>(*scene.bodies[1].shape).normal = Vec3(-0.04, 0.04, 1).normalized();
  return scene;
}

BodyState end_of(const Scene& scene, const char* integrator, int steps) {
  ContactRun run(scene, "event", integrator);
  run.run(kEnd / steps, steps);
  BOOST_TEST(run.solver_warning() == "");
  return run.state().body(0);
}

double error_of(const char* integrator, int steps, const BodyState& exact) {
  const BodyState end = end_of(slip_begins(), integrator, steps);
  return std::max((end.position - exact.position).norm(), angle_between(end.orientation, exact.orientation));
}

// A box that bounces and slides.
Scene bouncing_box(double friction) {
  Body box = solid("box", Box{{0.3, 0.4, 0.2}}, {0, 0, 0.6});
  box.orientation = Quat(0.8, 0.2, -0.4, 0.4).normalized();
  box.velocity = {1, -0.5, 0}, box.angular_velocity = {1, 2, -1};
  return on_floor({box}, {0.4, friction});
}

}  // namespace

// The errors were 1.1e-2, 1.8e-3 and 6.1e-4 rad at 1/60, 1/240 and 1/960 s while fixed steps stepped over the onset.
BOOST_AUTO_TEST_CASE(the_order_outlives_a_slip_that_begins) {
  const BodyState exact = end_of(slip_begins(), "dormand-prince", 36);
  // Its inner steps err by 1e-12 each.
  BOOST_TEST(angle_between(end_of(slip_begins(), "dormand-prince", 144).orientation, exact.orientation) < 1e-10);
  for (const char* integrator : {"rk4", "rkmk4", "velocity-verlet"}) {
    const double at_60 = error_of(integrator, 36, exact), at_120 = error_of(integrator, 72, exact),
                 at_240 = error_of(integrator, 144, exact);
    BOOST_TEST(at_60 < 1e-5, integrator << ": " << at_60);
    // The next term of the error is a twentieth of the leading one at 1/60 s.
    BOOST_TEST(std::log2(at_60 / at_120) > 3.6, integrator << ": " << at_60 << ", " << at_120);
    BOOST_TEST(std::log2(at_120 / at_240) > 3.7, integrator << ": " << at_120 << ", " << at_240);
  }
}

// Thresholds in absolute units would decide otherwise. With friction an adaptive method follows turning slips, and its
// tolerance of 1e-12 is in absolute units.
BOOST_AUTO_TEST_CASE(other_units_change_nothing) {
  Equivalence how;
  for (const auto& [length, time] : {std::pair(0x1p4, 0x1p-1), std::pair(0x1p-7, 0x1p1)}) {
    how.length = length, how.time = time;
    for (const double friction : {0.0, 0.4}) {
      const Scene scene = bouncing_box(friction);
      ContactRun here(scene, "event", "rk4"), there(equivalent(scene, how), "event", "rk4");
      here.run(1.0 / 64, 64), there.run(time / 64, 64);
      const double apart = (here.state().position(0) - there.state().position(0) / length).norm(),
                   turn = (here.state().orientation(0).coeffs() - there.state().orientation(0).coeffs()).norm();
      BOOST_TEST(std::max(apart, turn) <= (friction == 0 ? 1e-13 : 1e-9), length << ", " << friction << ": " << apart);
    }
  }
}

// Four corners that land at once can share an impulse with friction in many ways. The order of corners, which a mirror
// changes, must not choose.
BOOST_AUTO_TEST_CASE(a_mirror_changes_nothing_where_many_corners_land_at_once) {
  Body box = solid("box", Box{{0.33, 0.36, 0.32}}, {-0.33, -0.55, 0.64}, 2.68);
  box.orientation = Quat(0.89, 0.41, 0.21, -0.07).normalized();
  box.velocity = {-0.29, -0.62, 1.17}, box.angular_velocity = {0.81, -1.25, -0.18};
  Scene scene = on_floor({box}, {0, 0.5});
  std::get<Plane>(*scene.bodies[1].shape).normal = Vec3(-0.01, 0.1, 1).normalized();
  Equivalence mirrored;
  mirrored.is_mirrored = true;
  ContactRun here(scene, "event", "dormand-prince"), there(equivalent(scene, mirrored), "event", "dormand-prince");
  here.run(1.0 / 60, 60), there.run(1.0 / 60, 60);
  BodyTable back(2);
  to_original(mirrored, there.state(), back.columns());
  const double turn = angle_between(here.state().orientation(0), std::as_const(back).columns().orientation(0));
  BOOST_TEST(turn < 1e-8);  // 1.7e-3 when sweeps shared the impulses out
}

// A ball that slides at v rolls from 2 v/(7 mu g) on, at 5/7 of v. A step that slips limit is twice as long as the time
// that is left for the slip, so that its end is tried to the last bit.
BOOST_AUTO_TEST_CASE(a_slip_may_end_just_where_it_is_looked_for) {
  for (const int steps_a_second : {60, 100, 128, 200, 256, 512}) {
    Body ball = solid("ball", Sphere{0.1}, {-1.2, 0.1, 0.1});
    ball.velocity = {1, 0, 0};
    ContactRun run(on_floor({ball}, {0, 0.5}), "event", "dormand-prince");
    const double ends = 2 / (7 * 0.5 * 9.81), g = 9.81;
    for (int n = 0; run.time() < 0.1; ++n) {
      run.step(1.0 / steps_a_second);
      const double due = run.time() < ends ? 1 - 0.5 * g * run.time() : 5.0 / 7;
      BOOST_TEST(std::abs(run.state().velocity(0).x() - due) < 1e-7, steps_a_second << " at " << run.time());
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
