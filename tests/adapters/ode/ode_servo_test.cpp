// The option servo=native of ODE: soft stops at the target, which are a spring and a damper by implicit Euler.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/engine/engine_failure.h"
#include "tests/adapters/free_body_measures.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_ode_ode_servo)

namespace {

constexpr double kMass = 2, kKp = 30, kKd = 1.5;

// A cart on a rail from rest, whose servo moves it. `turned_about`: the joint goes from the cart to the world.
Scene cart(const Servo& servo, bool turned_about = false) {
  Scene scene;
  Body body;
  body.name = "cart", body.mass = kMass, body.inertia = Mat3::Identity();
  scene.bodies = {body};
  Joint slider{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}, .name = "rail"};
  if (turned_about) std::swap(slider.a, slider.b), slider.type = SliderJoint{-Vec3::UnitX()};
  scene.joints = {slider};
  scene.motors = {{.joint = 0, .servo = servo}};
  return scene;
}

// A wheel about z whose servo wants 4 rad: it is 2.28 rad the other way.
Scene wheel() {
  Scene scene = cart({.target = TimeTable::constant(4), .kp = kKp, .kd = kKd});
  scene.joints[0].type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()};
  scene.bodies[0].inertia = kMass * Mat3::Identity();
  return scene;
}

BodyState state_by(const std::string& run, const Scene& scene, double dt, int steps) {
  return body_after(*load_run(run, scene), dt, steps);
}

// Implicit Euler of m x'' = kp (target - x) + kd (speed - x'), as its definition says.
double implicit_euler(const Servo& servo, double dt, int steps) {
  double x = 0, v = 0;
  for (int n = 1; n <= steps; ++n) {
    const double target = servo.target.at(static_cast<double>(n) * dt);
    v = (v + dt / kMass * (servo.kp * (target - x) + servo.kd * servo.target_speed)) /
        (1 + dt / kMass * (servo.kd + dt * servo.kp));
    x += dt * v;
  }
  return x;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_servo_is_a_spring_and_damper_by_implicit_euler) {
  const Servo servos[] = {{.target = TimeTable::constant(0.4), .kp = kKp, .kd = kKd},
                          {.target = TimeTable::constant(0.4), .kp = kKp, .kd = 0},
                          {.target = {{0, 0.5}, {0, 0.3}, true}, .kp = kKp, .kd = kKd, .target_speed = 0.6},
                          {.target = TimeTable::constant(0.4), .kp = 1e6, .kd = 10}};  // stiff: w dt = 23 at 1/30 s
  for (const Servo& servo : servos) {
    for (const bool about : {false, true}) {
      for (const char* method : {"ode:worldstep,servo=native", "ode:worldstep,servo=native@stock"}) {
        const double came = state_by(method, cart(servo, about), 1.0 / 30, 25).position.x();
        BOOST_TEST_CONTEXT(method << ", kp " << servo.kp << ", kd " << servo.kd << (about ? ", turned about" : ""))
        BOOST_TEST(std::abs(came - implicit_euler(servo, 1.0 / 30, 25)) < 1e-9);  // ODE's joint rows are softer by cfm
      }
    }
  }
}

// Computed before each step, the stiff one blows up.
BOOST_AUTO_TEST_CASE(a_stiff_servo_is_stable_with_native_servos_alone) {
  const Scene scene = cart({.target = TimeTable::constant(0.4), .kp = 1e6, .kd = 10});
  BOOST_TEST(std::abs(state_by("ode:worldstep,servo=native", scene, 1.0 / 30, 60).position.x() - 0.4) < 1e-2);
  const double computed = state_by("ode:worldstep", scene, 1.0 / 30, 60).position.x();
  BOOST_TEST(!(std::abs(computed - 0.4) < 1e3));
}

BOOST_AUTO_TEST_CASE(a_wheel_takes_the_shorter_way) {
  const Scene scene = wheel();
  const auto angle_after = [&](const char* name, int steps) {
    const Quat q = state_by(name, scene, 1e-3, steps).orientation;
    return 2 * std::atan2(q.z(), q.w());
  };
  const double native = angle_after("ode:worldstep,servo=native", 200), computed = angle_after("ode:worldstep", 200);
  BOOST_TEST(native < -0.05);
  BOOST_TEST(std::abs(native - computed) < 0.02 * std::abs(native));  // both of first order
}

BOOST_AUTO_TEST_CASE(what_stops_cannot_do_is_unsupported) {
  const Servo plain{.target = TimeTable::constant(0.4), .kp = kKp, .kd = kKd};
  const auto refused = [](const Scene& scene, const char* why) {
    BOOST_CHECK_EXCEPTION(load_run("ode:worldstep,servo=native", scene), EngineFailure,
                          [&](const EngineFailure& failure) {
                            return failure.kind() == FailureKind::unsupported &&
                                   std::string(failure.what()).find(why) != std::string::npos;
                          });
    BOOST_CHECK_NO_THROW(state_by("ode:worldstep", scene, 1e-3, 1));
  };
  Scene sampled = cart(plain), bounded = cart(plain), late = cart(plain), limited = cart(plain), rough = cart(plain);
  sampled.motors[0].servo->period = 0.01, bounded.motors[0].servo->most = 3, late.motors[0].from = 0.5;
  limited.joints[0].upper = 1;
  rough.motors.push_back({.joint = 0, .speed = 0, .most = 1, .is_friction = true});
  refused(sampled, "samples"), refused(bounded, "has a bound"), refused(late, "begins late"),
      refused(limited, "beside limits"), refused(rough, "beside friction");
  refused(cart({.target = TimeTable::constant(0), .kd = 2, .target_speed = 1}), "has no kp");
}

// A run whose joints hold servos' efforts tells no reactions: they would be taken for the joint's own.
BOOST_AUTO_TEST_CASE(reactions_are_not_mixed_with_efforts) {
  const Scene scene = cart({.target = TimeTable::constant(0.4), .kp = kKp, .kd = kKd});
  const auto world = load_run("ode:worldstep,servo=native", scene);
  world->capabilities().reactions->ask_for_reactions();
  world->step(1e-3);
  BOOST_TEST(world->capabilities().reactions->reactions().empty());
}

BOOST_AUTO_TEST_SUITE_END()
