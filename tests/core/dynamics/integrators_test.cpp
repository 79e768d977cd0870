// Every method of the core, and every twin of another engine's, is held to the facts that its own row states.
#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <utility>

#include "adapters/bullet/bullet_twin.h"
#include "adapters/ode/ode_twin.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/model/energy.h"
#include "tests/cases/judged.h"
#include "tests/core/dynamics/integrators/method_run.h"

using namespace rigor;
using test::Method;

BOOST_AUTO_TEST_SUITE(core_dynamics_integrators)
using Run = test::MethodRun;

namespace {

std::vector<Method> every_method() {
  std::vector<Method> methods = {{&kBulletTwin, nullptr}, {&kOdeTwin, nullptr}};
  for (const Integrator& row : integrators()) {
    if (row.default_orientation.empty()) {
      methods.push_back({&row, nullptr});
      continue;
    }
    for (const OrientationUpdate& update : orientation_updates()) methods.push_back({&row, &update});
  }
  return methods;
}

double distance(BodyColumns a, BodyColumns b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest =
        std::max({largest, (a.position(i) - b.position(i)).norm(), angle_between(a.orientation(i), b.orientation(i)),
                  (a.velocity(i) - b.velocity(i)).norm(), (a.angular_velocity(i) - b.angular_velocity(i)).norm()});
  }
  return largest;
}

// Computed from the judge's own equations of motion, solved in extended precision by code that shares nothing with the
// methods.
BodyTable accurate(const Scene& scene, double duration) {
  const auto truth = make_truth("reference", scene, duration);
  BOOST_TEST(truth->error(duration) < 1e-11);
  return test::truth_at(*truth, duration, scene.bodies.size());
}

// log2 of the ratio of the errors at dt and dt/4, halved. At a single halving the next term of the series may make one
// order too good and the other too bad.
double observed_order(const Scene& scene, const BodyTable& truth, const Method& method, double duration, int steps) {
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const int count = steps << (2 * k);
    Run run(scene, method);
    run.steps(duration / count, count);
    error[k] = distance(run.bodies(), truth.columns());
    BOOST_TEST_MESSAGE(method.name() << " in " << count << " steps: " << error[k]);
  }
  return std::log2(error[0] / error[1]) / 2;
}

}  // namespace

BOOST_AUTO_TEST_CASE(rows_are_alphabetical_and_unique) {
  const auto by_name = [](const Integrator& a, const Integrator& b) { return a.name < b.name; };
  BOOST_TEST(std::is_sorted(integrators().begin(), integrators().end(), by_name));
  BOOST_TEST((std::adjacent_find(integrators().begin(), integrators().end(), [](const auto& a, const auto& b) {
                return a.name == b.name;
              }) == integrators().end()));
}

// So many steps per second that the next term of the error series is a few per cent of the leading one, and rounding is
// far below both.
int steps_for_order(int order) { return order <= 2 ? 1600 : order <= 4 ? 50 : 10; }

// Tolerance 0.25: what those few per cent may do to the order.
BOOST_AUTO_TEST_CASE(each_converges_at_its_stated_order) {
  Scene free_body = test::tumbling_body();
  free_body.bodies[0].angular_velocity *= 5;  // fast enough that a method of order 8 has an error to see
  const std::pair<const char*, Scene> scenes[] = {{"a free body of three moments", free_body},
                                                  {"coupled bodies without damping", test::coupled_bodies(0)},
                                                  {"coupled bodies with damping", test::coupled_bodies(3)},
                                                  {"coupled bodies with dampers that drive", test::coupled_bodies(-1)}};
  for (const auto& [what, scene] : scenes) {
    const BodyTable truth = accurate(scene, 1);
    for (const Method& method : every_method()) {
      if (method.integrator->adaptive) continue;  // held to its tolerance below
      const double order = observed_order(scene, truth, method, 1, steps_for_order(method.integrator->order));
      BOOST_TEST(std::abs(order - method.integrator->order) < 0.25,
                 method.name() << " on " << what << ": observed order " << order);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_symplectic_method_does_not_gain_or_lose_energy_over_many_periods) {
  // A body of equal moments on a spring through its centre has no gyroscopic term. Every method declared as symplectic
  // is then symplectic as a whole. Over 200 periods a first- or second-order drift per step would add up.
  Scene scene;
  scene.bodies = {test::body("ball", 1, {1, 1, 1}, {1.5, 0, 0})};
  scene.bodies[0].velocity = {0, 0.4, 0};
  scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 1, 1)};
  const double dt = 0.1;
  for (const Method& method : every_method()) {
    Run run(scene, method);
    const double start = energy(scene, run.bodies());
    double first = 0, last = 0;  // mean energies over the first and the last ten periods
    const int steps = 12566, part = 628;
    for (int n = 0; n < steps; ++n) {
      run.steps(dt, 1);
      if (n < part) first += energy(scene, run.bodies()) / part;
      if (n >= steps - part) last += energy(scene, run.bodies()) / part;
    }
    const double drift = std::abs(last - first) / start;
    if (method.integrator->symplectic) {
      BOOST_TEST(drift < 1e-3, method.name() << ": " << drift);  // what the oscillation leaves in a mean of ten periods
    } else if (method.integrator->order == 1 && method.integrator->twin_of.empty()) {  // a twin's loss is in its spin
      BOOST_TEST(!(drift < 0.1), method.name() << " is stated not to be symplectic, yet keeps the energy: " << drift);
    }
  }
}

BOOST_AUTO_TEST_CASE(methods_that_carry_the_angular_momentum_keep_it_without_torque) {
  const Scene scene = test::tumbling_body();
  for (const char* name :
       {"dormand-prince", "moser-veselov", "rk4", "rkmk4", "symplectic4", "symplectic8", "velocity-verlet"}) {
    Run run(scene, {&integrator(name), nullptr});
    const Vec3 before = angular_momentum(scene, run.bodies(), run.bodies().position(0));
    run.steps(1.0 / 30, 3000);
    const Vec3 after = angular_momentum(scene, run.bodies(), run.bodies().position(0));
    // 3000 steps with some roundings of 1e-16 in each of their stages.
    BOOST_TEST((after - before).norm() / before.norm() < 2e-12, name << ": " << (after - before).norm());
  }
}

BOOST_AUTO_TEST_CASE(velocity_verlet_has_no_phase_error_for_equal_moments) {
  const Method verlet{&integrator("velocity-verlet"), nullptr};
  for (const Vec3& moments : {Vec3(2, 2, 2), Vec3(1, 2, 2), Vec3(2, 2, 1), Vec3(2, 1, 2)}) {
    const Scene scene = test::tumbling_body(moments);
    Run symmetric(scene, verlet);
    symmetric.steps(0.5, 20);
    const BodyTable truth = accurate(scene, 10);
    // The truth's own error is below 1e-11; a phase error of the splitting would be about 0.1.
    BOOST_TEST(angle_between(symmetric.bodies().orientation(0), truth.columns().orientation(0)) < 1e-10,
               "moments " << moments.transpose());
  }
}

BOOST_AUTO_TEST_CASE(symmetric_methods_undo_their_own_step) {
  // With dampers too: that is what a composition's order rests on. Equations solved to less than rounding would show.
  for (const double damping : {0.0, 3.0}) {
    const Scene scene = test::coupled_bodies(damping);
    for (const char* name : {"implicit-midpoint", "moser-veselov", "symplectic4", "symplectic8"}) {
      Run run(scene, {&integrator(name), nullptr});
      const BodyTable start(run.bodies());
      run.steps(0.05, 1);
      BOOST_TEST(distance(run.bodies(), start.columns()) > 1e-2, name);
      run.steps(-0.05, 1);
      BOOST_TEST(distance(run.bodies(), start.columns()) < 1e-13, name << ", damping " << damping);
      BOOST_TEST(run.solver_warning() == "", name);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_multistep_method_forgets_when_it_is_moved) {
  // A run that is set elsewhere in the middle ends as one that began there.
  const Scene scene = test::coupled_bodies(1);
  const System system(scene);
  for (const char* name : {"adams", "exponential-adams"}) {
    BodyTable moved(scene.bodies.size()), fresh(scene.bodies.size());
    const auto one = integrator(name).make({system, nullptr, nullptr}),
               other = integrator(name).make({system, nullptr, nullptr});
    set_initial_state(scene, moved.columns());
    for (int n = 0; n < 20; ++n) one->step(moved.columns(), n * 0.01, 0.01);
    moved.columns().set_velocity(0, {1, 2, 3});
    fresh = moved;
    for (int n = 20; n < 40; ++n) {
      one->step(moved.columns(), n * 0.01, 0.01);
      other->step(fresh.columns(), n * 0.01, 0.01);
    }
    BOOST_TEST(distance(moved.columns(), fresh.columns()) == 0, name);
  }
}

// A force that begins long after t = 0 is the same force for a run that begins then. It pulls at a point far from the
// body's centre and rotates the body by more than a radian, so methods with a memory of loads must renew it. All times
// are sums of powers of two, so all differences are exact.
BOOST_AUTO_TEST_CASE(a_method_knows_no_time_but_that_of_its_forces) {
  constexpr double kLater = 128, dt = 1.0 / 32;
  Scene scene = test::tumbling_body();
  scene.forces = {
      {.body = 0, .force = {400, 0, 0}, .torque = Vec3::Zero(), .point = {0, 0.5, 0}, .from = 0.0, .until = 64.0}};
  for (const Method& method : every_method()) {
    BodyTable ends[2];
    for (const double start : {0.0, kLater}) {
      scene.forces[0].from = start, scene.forces[0].until = start + 64;
      const System system(scene);
      BodyTable state(1, method.orientation && method.orientation->keeps_matrix);
      set_initial_state(scene, state.columns());
      const auto stepper = method.integrator->make({system, nullptr, method.orientation, {}});
      for (int n = 0; n < 64; ++n) stepper->step(state.columns(), start + n * dt, dt);
      ends[start > 0] = state;
    }
    const double apart = distance(ends[0].columns(), ends[1].columns());
    // Methods that work out instants within a step may round them otherwise beside 128 s than beside 0, by 1e-14 s.
    BOOST_TEST(apart < 1e-9, method.name() << ": " << apart);
  }
}

BOOST_AUTO_TEST_CASE(methods_of_high_order_step_to_a_force_that_begins_and_ends_inside_a_step) {
  Scene scene;
  scene.bodies = {test::body("ball", 2, {1, 1, 1})};
  TimedForce push;
  push.body = 0, push.force = {6, 0, 0}, push.from = 0.123, push.until = 0.777;
  scene.forces = {push};
  const double acceleration = 3, during = push.until - push.from, after = 1 - push.until;
  const double x = 0.5 * acceleration * during * during + acceleration * during * after;
  for (const Method& method : every_method()) {
    if (method.integrator->order < 4) continue;
    for (const int steps : {1, 4, 10}) {
      Run run(scene, method);
      run.steps(1.0 / steps, steps);
      BOOST_TEST(std::abs(run.bodies().position(0).x() - x) < 1e-14, method.name());  // some roundings of 1
    }
  }
}

BOOST_AUTO_TEST_CASE(an_adaptive_method_meets_its_tolerance_whatever_the_step_and_says_when_it_cannot) {
  const Scene scenes[] = {test::tumbling_body(), test::coupled_bodies(0), test::coupled_bodies(3)};
  for (const Method& method : every_method()) {
    if (!method.integrator->adaptive) continue;
    for (const Scene& scene : scenes) {
      const BodyTable truth = accurate(scene, 1);
      for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
        for (const int steps : {1, 30, 300}) {
          Run run(scene, method, {.method = "", .options = {{"tolerance", fmt::format("{}", tolerance)}}});
          run.steps(1.0 / steps, steps);
          // At most some tens of inner steps come near the tolerance; in one second none of these scenes magnifies
          // their errors by much.
          const double error = distance(run.bodies(), truth.columns());
          BOOST_TEST(error < 100 * tolerance, method.name()
                                                  << " at " << tolerance << " in " << steps << " steps: " << error);
          BOOST_TEST(run.solver_warning() == "");
        }
      }
    }
    Scene too_stiff = test::fixed_spring();
    too_stiff.springs[0].stiffness = 1e18;
    Run run(too_stiff, method);
    run.steps(1, 1);
    BOOST_TEST(run.solver_warning().find("was not met") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(a_fixed_body_stays_where_it_is) {
  Scene scene = test::coupled_bodies(1);
  scene.bodies[0].fixed = true;
  scene.bodies[0].velocity = {1, 2, 3};
  for (const Method& method : every_method()) {
    Run run(scene, method);
    run.steps(1.0 / 30, 30);
    BOOST_TEST((run.bodies().position(0) - scene.bodies[0].position).norm() == 0, method.name());
    BOOST_TEST(run.bodies().angular_velocity(0).norm() == 0, method.name());
    BOOST_TEST((run.bodies().position(1) - scene.bodies[1].position).norm() > 0.01, method.name());
  }
}

BOOST_AUTO_TEST_SUITE_END()
