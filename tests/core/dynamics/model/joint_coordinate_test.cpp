// Springs, dampers and motors of joints: against closed forms, and what they must keep.
#include "core/dynamics/model/joint_coordinate.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "adapters/core/core_engine.h"
#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/loads/loads.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_model_joint_coordinate)

namespace {

// A wheel of 0.5 kg m² about an axis that lies across its own and W's.
Scene wheel() {
  Scene scene;
  scene.bodies = {test::body("wheel", 2, {0.5, 0.5, 0.5}, {1, 2, 3})};
  scene.bodies[0].orientation = Quat(0.8, 0.2, -0.4, 0.4).normalized();
  scene.joints = {{kWorld, 0, HingeJoint{{1, 2, 3}, Vec3(1, 2, 2) / 3}}};
  return scene;
}

// Two bodies of full inertia on a slider, tumbling and drifting apart along it.
Scene free_slider() {
  Scene scene;
  const Vec3 axis = Vec3(2, -1, 2) / 3, w(0.4, 0.7, -0.2), line(0.6, 0.3, 0.2);
  scene.bodies = {test::body("a", 2, {0.1, 0.2, 0.25}), test::body("b", 1, {0.05, 0.06, 0.08}, line)};
  scene.bodies[0].inertia(0, 1) = scene.bodies[0].inertia(1, 0) = 0.03;
  for (Body& body : scene.bodies) body.angular_velocity = w;
  scene.bodies[1].velocity = w.cross(line) + 0.5 * axis;
  scene.joints = {{0, 1, SliderJoint{axis}}};
  return scene;
}

BodyTable after(const Scene& scene, const std::string& method, double dt, int steps) {
  const auto world = CoreEngine().load(scene, {.method = method, .options = {}});
  for (int n = 0; n < steps; ++n) world->step(dt);
  BOOST_TEST(world->solver_warning() == "");
  Snapshot snapshot;
  world->read(snapshot);
  return BodyTable(snapshot.bodies());
}

double coordinate(const Scene& scene, const BodyTable& state) {
  return JointCoordinate(scene, scene.joints[0]).at(state.columns()).x;
}

}  // namespace

// Beyond half a turn the spring's angle would jump to the other side. The step in which it does so reports it.
BOOST_AUTO_TEST_CASE(a_sprung_hinge_that_turns_by_half_a_turn_is_named) {
  Scene scene = wheel();
  scene.joints[0].stiffness = 1e-3;
  scene.bodies[0].angular_velocity = Vec3(1, 2, 2) / 3;
  const auto world = CoreEngine().load(scene, {.method = "rk4", .options = {}});
  for (int n = 1; n <= 40; ++n) {
    world->step(0.1);  // at 1 rad/s: pi is passed in step 32
    BOOST_TEST((world->solver_warning().find("half a turn") != std::string::npos) == (n == 32));
  }
}

// I x'' + c x' + k (x - r) = 0 from x = 0 at rest: with a = c/2I and f² = k/I - a²,
// x = r - r exp(-a t) (cos f t + a/f sin f t).
BOOST_AUTO_TEST_CASE(a_hinges_spring_and_damper_make_a_damped_oscillation) {
  Scene scene = wheel();
  scene.joints[0].stiffness = 8, scene.joints[0].damping = 0.6, scene.joints[0].rest = -0.7;
  const double a = 0.6 / (2 * 0.5), f = std::sqrt(8 / 0.5 - a * a), t = 1.3;
  const double exact = -0.7 + 0.7 * std::exp(-a * t) * (std::cos(f * t) + a / f * std::sin(f * t));
  BOOST_TEST(std::abs(coordinate(scene, after(scene, "dormand-prince", 0.1, 13)) - exact) < 1e-11);
  // Second order with its damper: a swing of 4 rad/s leaves a hundredth of the step's square.
  const double coarse = std::abs(coordinate(scene, after(scene, "velocity-verlet", 0.02, 65)) - exact);
  const double fine = std::abs(coordinate(scene, after(scene, "velocity-verlet", 0.01, 130)) - exact);
  BOOST_TEST(std::log2(coarse / fine) > 1.9);
}

// I x'' + (k + q |x|) x = 0 from x = A at rest: by the energy, the first quarter of the swing takes
//   integral over x from 0 to A of dx / sqrt((k (A² - x²) + 2/3 q (A³ - x³)) / I).
// With x = A - A u² the integrand is smooth, and Simpson's rule with 200 parts is right to 1e-9.
BOOST_AUTO_TEST_CASE(a_quadratic_spring_swings_in_the_time_that_its_energy_tells) {
  constexpr double kInertia = 0.5, k = 2, q = 6, A = 0.8;  // kg m², N m/rad, N m/rad², rad
  const auto integrand = [&](double u) {
    const double x = A - A * u * u, square = (k * (A + x) + 2.0 / 3 * q * (A * A + A * x + x * x)) / kInertia;
    return 2 * std::sqrt(A) / std::sqrt(square);  // dx = 2 A u du, and A - x = A u²
  };
  constexpr int kParts = 200;
  double quarter = 0;
  for (int n = 0; n <= kParts; ++n)
    quarter += (n == 0 || n == kParts ? 1 : n % 2 ? 4 : 2) * integrand(static_cast<double>(n) / kParts);
  quarter /= 3.0 * kParts;
  Scene scene = wheel();
  scene.joints[0].stiffness = k, scene.joints[0].quadratic_stiffness = q, scene.joints[0].rest = -A;
  // The coordinate counts from the start, A away from rest.
  constexpr int kSteps = 100;
  for (const auto& [quarters, expected] : {std::pair{1, -A}, {2, -2 * A}, {3, -A}, {4, 0.0}}) {
    const double x = coordinate(scene, after(scene, "dormand-prince", quarters * quarter / kSteps, kSteps));
    BOOST_TEST(std::abs(x - expected) < 1e-8, quarters << " quarters: " << x << " for " << expected);
  }
}

// Between limits less than a turn apart the spring goes by the turns: from 0 it swings to -4 rad and back.
BOOST_AUTO_TEST_CASE(a_spring_between_limits_counts_turns) {
  Scene scene = wheel();
  scene.joints[0].stiffness = 8, scene.joints[0].rest = -2;
  scene.joints[0].lower = -4.5, scene.joints[0].upper = 0.5;
  for (const double t : {0.5, 0.75, 1.3}) {
    const double exact = -2 + 2 * std::cos(std::sqrt(8 / 0.5) * t);
    const int steps = static_cast<int>(std::lround(t / 0.01));
    BOOST_TEST(std::abs(coordinate(scene, after(scene, "dormand-prince", 0.01, steps)) - exact) < 1e-10);
  }
  // Without the second limit the angle jumps, and the run says so.
  scene.joints[0].upper = std::numeric_limits<double>::infinity();
  const auto world = CoreEngine().load(scene, {.method = "dormand-prince", .options = {}});
  bool is_said = false;
  for (int n = 0; n < 75; ++n) {
    world->step(0.01);
    is_said |= world->solver_warning().find("half a turn") != std::string::npos;
  }
  BOOST_TEST(is_said);
}

// The pair of forces acts along one line: linear and angular momentum stay, and the energy with the spring's.
BOOST_AUTO_TEST_CASE(a_sliders_spring_on_a_free_pair_keeps_momenta_and_energy) {
  Scene scene = free_slider();
  scene.joints[0].stiffness = 20, scene.joints[0].rest = 0.1;
  BodyTable start(2);
  set_initial_state(scene, start.columns());
  const BodyTable end = after(scene, "dormand-prince", 0.05, 40);
  BOOST_TEST(std::abs(coordinate(scene, end)) > 0.01);
  BOOST_TEST((linear_momentum(scene, end.columns()) - linear_momentum(scene, start.columns())).norm() < 1e-11);
  BOOST_TEST(
      (angular_momentum(scene, end.columns(), Vec3::Zero()) - angular_momentum(scene, start.columns(), Vec3::Zero()))
          .norm() < 1e-11);
  BOOST_TEST(std::abs(energy(scene, end.columns()) - energy(scene, start.columns())) < 1e-11);
  BOOST_TEST(std::abs(potential_energy(scene, start.columns()) - 0.5 * 20 * 0.1 * 0.1) < 1e-15);
}

// 3 N m over 0.25 s on 0.5 kg m² make 1.5 rad/s, whatever steps the motor begins and ends in.
BOOST_AUTO_TEST_CASE(a_motor_gives_its_impulse_and_no_more) {
  Scene scene = wheel();
  scene.motors = {{.joint = 0, .effort = 3, .speed = {}, .from = 0.13, .until = 0.38}};
  for (const char* method : {"explicit-euler", "semi-implicit-euler", "velocity-verlet", "rk4", "dormand-prince"}) {
    const BodyTable end = after(scene, method, 0.1, 6);
    const auto at = JointCoordinate(scene, scene.joints[0]).at(end.columns());
    BOOST_TEST_CONTEXT(method) { BOOST_TEST(std::abs(at.rate - 1.5) < 1e-11); }
  }
}

BOOST_AUTO_TEST_CASE(an_angle_counts_from_the_start_to_half_a_turn_either_way) {
  const Scene scene = wheel();
  const JointCoordinate hinge(scene, scene.joints[0]);
  BodyTable state(1);
  for (const double angle : {0.0, 0.4, -0.4, 3.0, -3.0, 4.0}) {
    set_initial_state(scene, state.columns());
    const Quat turn = rotation_by(angle * *free_axis(scene.joints[0]));
    state.columns().set_orientation(0, turn * scene.bodies[0].orientation);
    BOOST_TEST(std::abs(hinge.at(state.columns()).x - std::remainder(angle, 2 * M_PI)) < 1e-14);
  }
}

BOOST_AUTO_TEST_SUITE_END()
