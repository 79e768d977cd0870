// What is true of one method alone.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <utility>

#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/integrators/method_run.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_integrators_single_methods)
using Run = test::MethodRun;

BOOST_AUTO_TEST_CASE(implicit_midpoint_says_when_its_equations_are_not_solved) {
  Run too_coarse(test::fixed_spring(), {&integrator("implicit-midpoint"), nullptr});
  too_coarse.steps(0.5, 100);
  BOOST_TEST(too_coarse.solver_warning().find("did not converge") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(moser_veselov_turns_a_steady_spin_by_the_arcsine_and_says_when_there_is_none) {
  const double dt = 0.1;
  Scene scene = test::tumbling_body();
  scene.bodies[0].orientation = Quat::Identity();
  const auto turned = [&](const Vec3& w) {
    scene.bodies[0].angular_velocity = w;
    Run run(scene, {&integrator("moser-veselov"), nullptr});
    run.steps(dt, 1);
    return std::pair(angle_between(run.bodies().orientation(0), Quat::Identity()), run.solver_warning());
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double w : {0.1, 5.0, 9.5}) {
      const auto [angle, solver_warning] = turned(w * Vec3::Unit(axis));
      BOOST_TEST(std::abs(angle - std::asin(w * dt)) < 1e-14);  // a few roundings of an angle up to 1.3
      BOOST_TEST(solver_warning == "");
    }
    BOOST_TEST(turned(10.5 * Vec3::Unit(axis)).second.find("no solution") != std::string::npos, "axis " << axis);
  }
  BOOST_TEST(turned({20, 30, -25}).second.find("no solution") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_spin_about_a_fixed_axis_is_exact_on_rotation_vectors) {
  Scene scene = test::tumbling_body();
  scene.bodies[0].orientation = Quat::Identity();
  scene.bodies[0].angular_velocity = {0, 0, 20};
  const auto error = [&](const char* name) {
    Run run(scene, {&integrator(name), nullptr});
    run.steps(0.1, 10);
    return angle_between(run.bodies().orientation(0), rotation_by({0, 0, 20}));
  };
  BOOST_TEST(error("rkmk4") < 1e-13);  // ten roundings of an angle of 2
  BOOST_TEST(error("rk4") > 1e-2);
}

BOOST_AUTO_TEST_CASE(linearly_implicit_euler_is_stable_on_a_spring_and_a_damper_of_any_stiffness) {
  // omega dt = 180 with dt c/m = 0, and omega dt = 0.3 with dt c/m = 3300: explicit methods blow up on both.
  for (const auto& [stiffness, damping] : {std::pair(3e9, 0.0), std::pair(1e4, 1e7)}) {
    Scene scene;
    scene.bodies = {test::body("ball", 100, {1, 1, 1}, {1.5, 0, 0})};
    scene.bodies[0].velocity = {1, 0, 0};
    scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, stiffness, 1, damping)};
    Run implicit(scene, {&integrator("linearly-implicit-euler"), nullptr});
    Run explicit_run(scene, {&integrator("semi-implicit-euler"), &orientation_update("quaternion-exponential")});
    const double start = energy(scene, implicit.bodies());
    double before = start;
    for (int n = 0; n < 300; ++n) {
      implicit.steps(1.0 / 30, 1);
      const double now = energy(scene, implicit.bodies());
      BOOST_TEST(now <= before * (1 + 1e-9));  // rounding of the stretch, 1e-16 of a metre against what is left of it
      before = now;
    }
    BOOST_TEST(implicit.solver_warning() == "");
    explicit_run.steps(1.0 / 30, 300);
    BOOST_TEST(!(energy(scene, explicit_run.bodies()) < 1e6 * start));
  }
}

BOOST_AUTO_TEST_CASE(an_exponential_method_moves_a_body_on_a_straight_spring_exactly_at_any_step) {
  // x'' = -(k/m) (x - l) - (c/m) x' about l = 1 m, from 0.1 m beyond; the two cases are under- and overdamped.
  for (const auto& [k, c] : {std::pair{8100.0, 0.0}, std::pair{8100.0, 40.0}, std::pair{100.0, 500.0}}) {
    Scene scene;
    scene.bodies = {test::body("weight", 1, {1, 1, 1}, {1.1, 0, 0})};
    scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, k, 1, c)};
    Run run(scene, {&integrator("exponential-adams"), nullptr});
    run.steps(1.0 / 30, 60);
    const std::complex<double> root = std::sqrt(std::complex<double>(c * c / 4 - k)), fast = -c / 2 - root,
                               slow = -c / 2 + root;
    const double expected = (0.1 * (slow * std::exp(fast * 2.0) - fast * std::exp(slow * 2.0)) / (slow - fast)).real();
    // 60 steps of roundings of 1 m.
    BOOST_TEST(std::abs(run.bodies().position(0).x() - 1 - expected) < 1e-13);
  }
}

BOOST_AUTO_TEST_SUITE_END()
