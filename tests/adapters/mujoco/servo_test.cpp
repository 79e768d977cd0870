// The option servo=native: servos as MuJoCo's actuators.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "adapters/engines.h"
#include "core/engine/engine_failure.h"
#include "core/engine/run_name.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_mujoco_servo)

namespace {

// A rod on a hinge without gravity, which its servo turns by 0.5 rad: an oscillator with J x'' + kd x' + kp (x - 0.5) =
// 0. `turned_about`: the joint goes from the rod to the world.
Scene turned_rod(bool turned_about = false) {
  Scene scene;
  Body rod;
  rod.name = "rod", rod.mass = 2, rod.inertia = Vec3(0.01, 0.3, 0.3).asDiagonal(), rod.position = {0.5, 0, 0};
  scene.bodies = {rod};
  Joint hinge;
  hinge.a = turned_about ? 0 : kWorld, hinge.b = turned_about ? kWorld : 0;
  hinge.type = HingeJoint{Vec3(0, 0, 0), Vec3::UnitZ()};
  scene.joints = {hinge};
  Motor motor;
  motor.joint = 0;
  motor.servo = Servo{.target = TimeTable::constant(0.5), .kp = 20, .kd = 1.5};
  scene.motors = {motor};
  return scene;
}

constexpr double kJ = 0.3 + 2 * 0.25;  // kg m², about the hinge

// The hinge's angle, as the scene counts it.
double angle_at(const std::string& name, const Scene& scene, double dt, double time) {
  const RunName run = parse_run_name(name, engines().infos());
  const auto world = find_engine(engines(), run.engine).load(scene, run.settings);
  for (long n = 0; n < std::lround(time / dt); ++n) world->step(dt);
  Snapshot now;
  world->read(now);
  const Vec3 x = now.bodies().position(0);
  return (scene.joints[0].b == 0 ? 1 : -1) * std::atan2(x.y(), x.x());
}

double exact(double t) {
  const double decay = 1.5 / (2 * kJ), w = std::sqrt(20 / kJ - decay * decay);
  return 0.5 - 0.5 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
}

}  // namespace

BOOST_AUTO_TEST_CASE(euler_moves_as_with_efforts_computed_before_each_step) {
  for (const bool about : {false, true}) {
    const Scene scene = turned_rod(about);
    const double native = angle_at("mujoco:euler,servo=native", scene, 1e-3, 0.7),
                 computed = angle_at("mujoco:euler", scene, 1e-3, 0.7);
    BOOST_TEST(std::abs(native - computed) < 1e-13);
    BOOST_TEST(std::abs(native - exact(0.7)) < 2e-3);  // of first order
  }
}

BOOST_AUTO_TEST_CASE(rk4_keeps_its_order_with_native_servos_alone) {
  const Scene scene = turned_rod(true);
  const auto error = [&](const char* name, double dt) {
    return std::abs(angle_at(name, scene, dt, 0.64) - exact(0.64));
  };
  // A fourth of the step: 256 times less, and 4 times less. Half of each is asked for.
  BOOST_TEST(error("mujoco:rk4,servo=native", 0.02) > 128 * error("mujoco:rk4,servo=native", 0.005));
  BOOST_TEST(error("mujoco:rk4,servo=native", 0.005) < 1e-6);
  BOOST_TEST(error("mujoco:rk4", 0.02) < 8 * error("mujoco:rk4", 0.005));
  BOOST_TEST(error("mujoco:rk4", 0.005) > 1e-4);
}

BOOST_AUTO_TEST_CASE(a_limited_effort_is_limited) {
  Scene scene = turned_rod();
  scene.motors[0].servo->most = 0.8;  // N m: 1 rad/s² at first
  BOOST_TEST(std::abs(angle_at("mujoco:rk4,servo=native", scene, 0.01, 0.2) - 0.5 * 0.04) < 1e-9);
}

BOOST_AUTO_TEST_CASE(what_actuators_cannot_do_is_unsupported) {
  const auto refuses = [](const Scene& scene) {
    try {
      angle_at("mujoco:euler,servo=native", scene, 1e-3, 1e-3);
    } catch (const EngineFailure& failure) {
      return failure.kind() == FailureKind::unsupported;
    }
    return false;
  };
  BOOST_TEST(!refuses(turned_rod()));
  Scene sampled = turned_rod(), late = turned_rod(), ends = turned_rod();
  sampled.motors[0].servo->period = 0.01, late.motors[0].from = 0.1, ends.motors[0].until = 1;
  for (const Scene& scene : {sampled, late, ends}) BOOST_TEST(refuses(scene));
}

BOOST_AUTO_TEST_SUITE_END()
