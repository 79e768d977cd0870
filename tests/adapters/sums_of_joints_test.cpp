// Couplings and servos over several joints, in every engine that has them, against motions in closed form.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "tests/adapters/free_body_measures.h"
#include "tests/adapters/seam_runs.h"
#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_sums_of_joints)

namespace {

BodyTable state_by(const std::string& run, const Scene& scene, double dt, double time) {
  return state_after(*load_run(run, scene), dt, static_cast<int>(std::lround(time / dt)));
}

double angle_about_x(const BodyTable& state, std::size_t i) {
  const Quat q = state.columns().orientation(i);
  return 2 * std::atan2(q.x(), q.w());
}

// Two carts on rails, with a servo on s = x - y / 2 at rest: s swings about the target by w² = kp (1/m_x + 1/(4 m_y)).
// `turned_about`: y's slider goes from the cart to the world.
constexpr double kMassX = 1, kMassY = 2, kKp = 12, kTarget = 0.1;
Scene two_carts(bool turned_about) {
  Scene scene;
  for (const double mass : {kMassX, kMassY}) {
    Body cart;
    cart.name = scene.bodies.empty() ? "x" : "y", cart.mass = mass, cart.inertia = Mat3::Identity();
    cart.position = {0, static_cast<double>(scene.bodies.size()), 0};
    scene.bodies.push_back(cart);
  }
  const Vec3 rail = (turned_about ? -1 : 1) * Vec3::UnitX();
  scene.joints = {
      {.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}, .name = "of x"},
      {.a = turned_about ? 1 : kWorld, .b = turned_about ? kWorld : 1, .type = SliderJoint{rail}, .name = "of y"}};
  scene.motors = {{.joint = 0, .servo = Servo{.target = TimeTable::constant(kTarget), .kp = kKp}, .plus = {{1, -0.5}}}};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_servo_over_two_joints_moves_both) {
  const double w = std::sqrt(kKp * (1 / kMassX + 0.25 / kMassY)), t = 0.8;
  const double x = kKp * kTarget / (kMassX * w * w) * (1 - std::cos(w * t)), y = -0.5 * x * kMassX / kMassY;
  const struct {
    const char* run;
    double within;  // m: twice the amplitude times w dt of the methods of first order, which hold the effort for a step
  } kRuns[] = {{"core:dormand-prince", 1e-11},     {"core:rk4", 1e-11},
               {"core:semi-implicit-euler", 1e-3}, {"mujoco:euler", 1e-3},
               {"mujoco:rk4,servo=native", 1e-11}, {"mujoco:euler,servo=native", 1e-3}};
  for (const bool turned_about : {false, true}) {
    for (const auto& [run, within] : kRuns) {
      const BodyTable state = state_by(run, two_carts(turned_about), 1e-3, t);
      BOOST_TEST_CONTEXT(run << (turned_about ? ", turned about" : "")) {
        BOOST_TEST(std::abs(state.columns().position(0).x() - x) < within);
        BOOST_TEST(std::abs(state.columns().position(1).x() - y) < within);
      }
    }
  }
}

// The differential of the suite: the angles and accelerations of the head comment of its file.
BOOST_AUTO_TEST_CASE(a_differential_shares_its_torque) {
  const Scene scene = test::suite_scene("transmissions/differential");
  const double t = 2, left = 0.25 * t * t / 2, right = left / 3, carrier = (left + right) / 2;
  const struct {
    const char* run;
    double within;  // rad: rounding, or t dt times the fastest acceleration; MuJoCo's solver ends early
  } kRuns[] = {{"core:dormand-prince", 1e-12},
               {"core:rk4", 1e-12},
               {"core:semi-implicit-euler", 1e-3},
               {"mujoco:rk4", 1e-6},
               {"mujoco:euler", 1e-3}};
  for (const auto& [run, within] : kRuns) {
    const BodyTable state = state_by(run, scene, 1e-3, t);
    BOOST_TEST_CONTEXT(run) {
      BOOST_TEST(std::abs(angle_about_x(state, 0) - carrier) < within);
      BOOST_TEST(std::abs(angle_about_x(state, 1) - left) < within);
      BOOST_TEST(std::abs(angle_about_x(state, 2) - right) < within);
    }
  }
  const auto truth = make_truth("reference", scene, t);
  const BodyTable state = test::truth_at(*truth, t, scene.bodies.size());
  BOOST_TEST(truth->error(t) < 1e-12);
  BOOST_TEST(std::abs(angle_about_x(state, 1) - left) < 1e-12);
  BOOST_TEST(std::abs(angle_about_x(state, 2) - right) < 1e-12);
}

// An engine without them says so.
BOOST_AUTO_TEST_CASE(other_engines_call_them_unsupported) {
  for (const char* name : {"ode", "bullet"}) {
    for (const Scene& scene : {two_carts(false), test::suite_scene("transmissions/differential")}) {
      BOOST_TEST_CONTEXT(name)
      BOOST_CHECK_EXCEPTION(load_run(name, scene), InputError, [](const InputError& error) {
        const std::string what = error.what();
        return what.find("several-joints") != std::string::npos || what.find("has no coupling") != std::string::npos;
      });
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
