// MuJoCo's drive: force = gain * control + b0 + b1 length + b2 speed, within its force range. It acts on a joint by the
// gear, on the joints of a fixed tendon by gear and coefficient.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "adapters/mjcf/mjcf_import.h"

namespace rigor::inline adapters {
namespace {

using namespace mjcf;

constexpr int kParameters = 10, kGears = 6;

// The law of an actuator with its control at the start. Nothing changes the control later.
struct Law {
  bool is_affine = true;
  double constant = 0, by_length = 0, by_speed = 0;  // N or N m; per unit of the transmission's length and speed
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();

  bool does_nothing() const { return is_affine && constant == 0 && by_length == 0 && by_speed == 0; }
};

Law law_of(const MjcfImport& import, int k) {
  const auto gain = [&](int i) { return import.value("actuator_gainprm", kParameters * k + i); };
  const auto bias = [&](int i) { return import.value("actuator_biasprm", kParameters * k + i); };
  const int gains = import.whole("actuator_gaintype", k), biases = import.whole("actuator_biastype", k),
            dynamics = import.whole("actuator_dyntype", k);
  double control = import.value("ctrl", k);
  if (import.whole("actuator_ctrllimited", k))
    control =
        std::clamp(control, import.value("actuator_ctrlrange", 2 * k), import.value("actuator_ctrlrange", 2 * k + 1));
  const auto act = import.m.numbers.find("act");
  const bool has_activation = dynamics != kNoDynamics;
  const bool is_at_rest = act == import.m.numbers.end() ||
                          std::all_of(act->second.begin(), act->second.end(), [](double a) { return a == 0; });
  Law law;
  law.is_affine = gains <= kAffineGain && biases <= kAffineBias && dynamics <= kFilter;
  // An integrator or a filter without control and activation stays at zero.
  if (has_activation && (control != 0 || !is_at_rest)) law.is_affine = false;
  law.constant = control * gain(0);
  if (gains == kAffineGain) law.by_length += control * gain(1), law.by_speed += control * gain(2);
  if (biases == kAffineBias) law.constant += bias(0), law.by_length += bias(1), law.by_speed += bias(2);
  if (import.whole("actuator_forcelimited", k))
    law.least = import.value("actuator_forcerange", 2 * k), law.most = import.value("actuator_forcerange", 2 * k + 1);
  return law;
}

void lose_drive(MjcfImport& import, int k, const std::string& why) { import.lose("actuator", k, "a drive", why); }

// A constant effort on the joint.
void add_effort(MjcfImport& import, int row, double effort) {
  Motor motor;
  motor.joint = row, motor.effort = effort;
  if (effort != 0) import.model.motors.push_back(motor);
}

// effort = gear * (constant + b1 gear q + b2 gear q'), with q counted from the start as x.
Servo servo_of(const Law& law, double gear, double start) {
  Servo servo;
  servo.kp = -law.by_length * gear * gear, servo.kd = -law.by_speed * gear * gear;
  servo.target = TimeTable::constant(servo.kp > 0 ? gear * law.constant / servo.kp - start : 0);
  servo.target_speed = servo.kp > 0 || servo.kd == 0 ? 0 : gear * law.constant / servo.kd;
  return servo;
}

void drive_joint(MjcfImport& import, int k, const Law& law) {
  const int joint = import.whole("actuator_trnid", 2 * k), row = import.row_of_joint[joint];
  const double gear = import.value("actuator_gear", kGears * k);
  if (row < 0) return lose_drive(import, k, "acts on a joint without an axis of its own");
  if (import.whole("jnt_actfrclimited", joint))
    return import.lose("joint", joint, "actuatorfrcrange", "bounds the sum of all drives of the joint");
  Servo servo = servo_of(law, gear, import.start_of(joint));
  if (servo.kp < 0 || servo.kd < 0)
    return lose_drive(import, k, "pushes away from its target, which no servo of a scene does");
  if (servo.kp == 0 && servo.kd == 0)
    return add_effort(import, row, gear * std::clamp(law.constant, law.least, law.most));
  if (law.least != -law.most)
    return lose_drive(import, k, "has unequal bounds of its force, which no servo of a scene has");
  servo.most = std::abs(gear) * law.most;
  if (servo.kp > 0 && import.may_turn_round(joint))
    import.lose("actuator", k, "a servo beyond half a turn", "a scene's servo does not count whole turns");
  Motor motor;
  motor.joint = row, motor.servo = servo;
  import.model.motors.push_back(motor);
}

// Whether something beside the drive itself bounds what it does to a joint of its tendon.
bool is_bounded_by_others(const MjcfImport& import, int tendon) {
  if (import.whole("tendon_actfrclimited", tendon)) return true;
  const int first = import.whole("tendon_adr", tendon);
  for (int i = first; i < first + import.whole("tendon_num", tendon); ++i)
    if (import.whole("jnt_actfrclimited", import.whole("wrap_objid", i))) return true;
  return false;
}

// The tendon's length is the sum of coefficient times q. It is counted here in units of its first joint.
void add_servo_of_tendon(MjcfImport& import, int k, const Law& law, int tendon) {
  if (std::isfinite(law.least) || std::isfinite(law.most))
    return lose_drive(import, k, "is a servo over a tendon with a bound of its force, which no scene has");
  const int first = import.whole("tendon_adr", tendon), count = import.whole("tendon_num", tendon);
  const double unit = import.value("wrap_prm", first);
  if (unit == 0) return lose_drive(import, k, "is a servo over a tendon whose first joint has the coefficient 0");
  const double gear = import.value("actuator_gear", kGears * k) * unit;
  Motor motor;
  double start = 0;  // of the sum, in those units
  for (int i = first; i < first + count; ++i) {
    const int joint = import.whole("wrap_objid", i);
    const double ratio = import.value("wrap_prm", i) / unit;
    if (import.row_of_joint[joint] < 0) return lose_drive(import, k, "acts on a joint without an axis of its own");
    if (import.may_turn_round(joint))
      return lose_drive(import, k, "is a servo over a joint that may turn round, whose turns no scene counts");
    if (i == first)
      motor.joint = import.row_of_joint[joint];
    else if (ratio != 0)
      motor.plus.push_back({import.row_of_joint[joint], ratio});
    start += ratio * import.start_of(joint);
  }
  motor.servo = servo_of(law, gear, start);
  if (motor.servo->kp < 0 || motor.servo->kd < 0)
    return lose_drive(import, k, "pushes away from its target, which no servo of a scene does");
  import.model.motors.push_back(motor);
}

void drive_tendon(MjcfImport& import, int k, const Law& law) {
  const int tendon = import.whole("actuator_trnid", 2 * k), first = import.whole("tendon_adr", tendon);
  if (import.whole("wrap_type", first) != kWrapJoint) return lose_drive(import, k, "pulls a spatial tendon");
  if (is_bounded_by_others(import, tendon))
    return lose_drive(import, k, "has its force bounded by its tendon or a joint, too");
  if (law.by_length != 0 || law.by_speed != 0) return add_servo_of_tendon(import, k, law, tendon);
  for (int i = first; i < first + import.whole("tendon_num", tendon); ++i) {
    const int row = import.row_of_joint[import.whole("wrap_objid", i)];
    const double effort = import.value("actuator_gear", kGears * k) * std::clamp(law.constant, law.least, law.most);
    if (row < 0) return lose_drive(import, k, "acts on a joint without an axis of its own");
    add_effort(import, row, effort * import.value("wrap_prm", i));
  }
}

void read_actuator(MjcfImport& import, int k) {
  for (const char* name : {"damping", "armature"}) {
    if (import.value(fmt::format("actuator_{}", name), k) != 0)
      import.lose("actuator", k, fmt::format("{} of a drive", name), "acts on the joint, and is not read");
  }
  const Law law = law_of(import, k);
  if (law.does_nothing())
    return import.model.left_out.add(import.at("actuator", k), "a drive",
                                     assumed("has control 0 from start to end: it does nothing"));
  if (!law.is_affine) return lose_drive(import, k, "is a muscle, or has a state or a law that no scene has");
  if (import.value("actuator_delay", k) != 0) lose_drive(import, k, "has a delay");
  const int transmission = import.whole("actuator_trntype", k);
  if (transmission == kOnJoint || transmission == kOnJointInParent) return drive_joint(import, k, law);
  if (transmission == kOnTendon) return drive_tendon(import, k, law);
  lose_drive(import, k, "acts by a crank, a site or adhesion, and a scene's drive acts on a joint");
}

}  // namespace

void read_mjcf_actuators(MjcfImport& import) {
  for (int k = 0; k < import.count("actuator_trntype"); ++k) read_actuator(import, k);
}

}  // namespace rigor::inline adapters
