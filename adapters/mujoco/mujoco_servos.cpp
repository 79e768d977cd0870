#include "adapters/mujoco/mujoco_servos.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/mujoco/mujoco_options.h"
#include "core/engine/engine_failure.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {
namespace {

void refuse(const Scene& scene, const Motor& motor, const char* what) {
  throw EngineFailure(FailureKind::unsupported,
                      fmt::format("the servo of {} {}, which MuJoCo's actuators do not; servo=computed does",
                                  scene.joint_name(static_cast<std::size_t>(motor.joint)), what));
}

std::string tendon_of(const Scene& scene, const Motor& motor) {
  return fmt::format("servo{}", &motor - scene.motors.data());
}

}  // namespace

bool has_native_servos(const Scene& scene, const Settings& settings) {
  const auto it = settings.options.find(kMujocoServo.name);
  if (it == settings.options.end() || it->second != "native") return false;
  return std::any_of(scene.motors.begin(), scene.motors.end(), [](const Motor& motor) { return motor.servo; });
}

std::string mjcf_actuators(const Scene& scene, const std::function<std::string(int joint)>& joint_name,
                           const std::function<double(int joint)>& sign_of) {
  std::string rows;
  for (const Motor& motor : scene.motors) {
    if (!motor.servo) continue;
    const Servo& servo = *motor.servo;
    if (servo.period > 0) refuse(scene, motor, "samples");
    if (motor.from > 0 || std::isfinite(motor.until)) refuse(scene, motor, "begins late or ends");
    const std::string range = std::isfinite(servo.most)
                                  ? fmt::format(R"( forcelimited="true" forcerange="{} {}")", -servo.most, servo.most)
                                  : "";
    const std::string acts_on =
        motor.plus.empty() ? fmt::format(R"(joint="{}" gear="{}")", joint_name(motor.joint), sign_of(motor.joint))
                           : fmt::format(R"(tendon="{}")", tendon_of(scene, motor));
    rows += fmt::format("<general {} gaintype=\"fixed\" gainprm=\"1\" biastype=\"affine\" biasprm=\"0 {} {}\"{}/>\n",
                        acts_on, -servo.kp, -servo.kd, range);
  }
  return "<actuator>\n" + rows + "</actuator>\n";
}

std::string mjcf_servo_tendons(const Scene& scene, const std::function<std::string(int joint)>& joint_name,
                               const std::function<double(int joint)>& sign_of) {
  std::string rows;
  for (const Motor& motor : scene.motors) {
    if (motor.plus.empty()) continue;
    const auto term = [&](int joint, double ratio) {
      return fmt::format(R"(<joint joint="{}" coef="{}"/>)", joint_name(joint), sign_of(joint) * ratio);
    };
    std::string joints = term(motor.joint, 1);
    for (const JointTerm& other : motor.plus) joints += term(other.joint, other.ratio);
    rows += fmt::format("<fixed name=\"{}\">{}</fixed>\n", tendon_of(scene, motor), joints);
  }
  return rows;
}

std::vector<double> mujoco_controls(const std::vector<Motor>& servos, double t) {
  std::vector<double> controls;
  for (const Motor& motor : servos)
    controls.push_back(motor.servo->kp * motor.servo->target.at(t) + motor.servo->kd * motor.servo->target_speed);
  return controls;
}

}  // namespace rigor::inline adapters
