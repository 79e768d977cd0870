#include "adapters/ode/ode_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "adapters/ode/ode_joint_ends.h"
#include "adapters/ode/ode_library.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline adapters {

const OdeJoints::Axis OdeJoints::kHinge = {dJointSetHingeParam, dJointGetHingeParam};
const OdeJoints::Axis OdeJoints::kSlider = {dJointSetSliderParam, dJointGetSliderParam};

// Our conventions and ODE's: both give anchors and axes in W at t = 0. Points of a distance joint are in the bodies'
// frames here and in W there. A joint type has equivalent rows in both. ODE's slider has its axis in its first body and
// its offset in its second, which is the same line without relative rotation.
struct OdeJoints::Maker {
  dWorldID world;
  const OdeJointEnds& ends;
  dBodyID first, second;  // the second null for what stays

  dJointID attached(dJointID id) const {
    dJointAttach(id, first, second);
    return id;
  }

  dJointID operator()(const BallJoint& ball) const {
    const dJointID id = attached(dJointCreateBall(world, nullptr));
    dJointSetBallAnchor(id, ball.anchor.x(), ball.anchor.y(), ball.anchor.z());
    return id;
  }
  dJointID operator()(const CylindricalJoint& cylinder) const {
    const dJointID id = attached(dJointCreatePiston(world, nullptr));
    dJointSetPistonAnchor(id, cylinder.anchor.x(), cylinder.anchor.y(), cylinder.anchor.z());
    dJointSetPistonAxis(id, cylinder.axis.x(), cylinder.axis.y(), cylinder.axis.z());
    return id;
  }
  dJointID operator()(const HingeJoint& hinge) const {
    const dJointID id = attached(dJointCreateHinge(world, nullptr));
    dJointSetHingeAnchor(id, hinge.anchor.x(), hinge.anchor.y(), hinge.anchor.z());
    dJointSetHingeAxis(id, hinge.axis.x(), hinge.axis.y(), hinge.axis.z());
    return id;
  }
  dJointID operator()(const SliderJoint& slider) const {
    const dJointID id = attached(dJointCreateSlider(world, nullptr));
    dJointSetSliderAxis(id, slider.axis.x(), slider.axis.y(), slider.axis.z());
    return id;
  }
  dJointID operator()(const FixedJoint&) const {
    const dJointID id = attached(dJointCreateFixed(world, nullptr));
    dJointSetFixed(id);
    return id;
  }
  dJointID operator()(const DistanceJoint& distance) const {
    const dJointID id = attached(dJointCreateDBall(world, nullptr));
    const auto [one, other] = ends.points(distance);
    dJointSetDBallAnchor1(id, one.x(), one.y(), one.z());
    dJointSetDBallAnchor2(id, other.x(), other.y(), other.z());  // with it, the distance
    return id;
  }
  dJointID operator()(const CompoundAxis&) const { return nullptr; }  // none of these is among the features
  dJointID operator()(const CompoundJoint&) const { return nullptr; }
  dJointID operator()(const PlanarJoint&) const { return nullptr; }
  dJointID operator()(const ScrewJoint&) const { return nullptr; }
  dJointID operator()(const UniversalJoint& universal) const {
    const dJointID id = attached(dJointCreateUniversal(world, nullptr));
    const auto [one, other] = ends.axes(universal);
    dJointSetUniversalAnchor(id, universal.anchor.x(), universal.anchor.y(), universal.anchor.z());
    {
      // ODE computes the cross after each axis, now with a second axis of its own, which may be parallel to the first.
      const ode_library::WithoutMessages halfway;
      dJointSetUniversalAxis1(id, one.x(), one.y(), one.z());
    }
    dJointSetUniversalAxis2(id, other.x(), other.y(), other.z());
    return id;
  }
};

void refuse_shared_motors(const Scene& scene) {
  for (auto motor = scene.motors.begin(); motor != scene.motors.end(); ++motor) {
    for (auto other = scene.motors.begin(); other != motor; ++other) {
      const bool share = motor->speed && other->speed && other->joint == motor->joint && other->from < motor->until &&
                         motor->from < other->until;
      if (!share) continue;
      throw InputError(fmt::format("ode keeps one speed of a joint at a time; {} has two motors from {} s on",
                                   scene.joint_name(static_cast<std::size_t>(motor->joint)),
                                   std::max(motor->from, other->from)));
    }
  }
}

OdeJoints::OdeJoints(const Scene& scene, dWorldID world, const std::vector<dBodyID>& bodies, Track track,
                     bool native_servos) {
  for (const Joint& joint : scene.joints) {
    const OdeJointEnds ends(scene, joint);
    const Maker maker{world, ends, bodies[ends.bodies.first],
                      ends.bodies.second == kWorld ? nullptr : bodies[ends.bodies.second]};
    const Axis* axis = !free_axis(joint) ? nullptr : turns(joint) ? &kHinge : &kSlider;
    const double sign = ends.sign();
    joints_.push_back({std::visit(maker, joint.type), sign, axis, sign > 0 ? joint.lower : -joint.upper,
                       sign > 0 ? joint.upper : -joint.lower, ends.bodies.first});
    if (joint.has_limits()) set_limits(joint, joints_.back(), track);
  }
  for (const Motor& motor : scene.motors) {
    if (motor.speed) motors_.push_back(motor);  // an effort is one of the loads
    has_servos_ = has_servos_ || motor.servo;
    if (motor.servo && native_servos) add_servo(scene, motor);
  }
}

// A stop has no bound of its force, and where both stops stand at one place ODE leaves out the joint's motor.
void OdeJoints::add_servo(const Scene& scene, const Motor& motor) {
  const auto refuse = [&](const char* what) {
    throw EngineFailure(FailureKind::unsupported,
                        fmt::format("the servo of {} {}, which ODE's stops do not; servo=computed does",
                                    scene.joint_name(static_cast<std::size_t>(motor.joint)), what));
  };
  const auto shares_the_joint = [&](const Motor& other) { return other.speed && other.joint == motor.joint; };
  if (motor.servo->period > 0) refuse("samples");
  if (motor.from > 0 || std::isfinite(motor.until)) refuse("begins late or ends");
  if (std::isfinite(motor.servo->most)) refuse("has a bound of its effort");
  if (motor.servo->kp == 0) refuse("has no kp");
  if (scene.joints[static_cast<std::size_t>(motor.joint)].has_limits()) refuse("acts beside limits");
  if (std::any_of(scene.motors.begin(), scene.motors.end(), shares_the_joint))
    refuse("acts beside friction or a motor of given speed");
  servos_.push_back(motor);
}

void OdeJoints::aim(double t, double dt) {
  for (const Motor& motor : servos_) {
    const Servo& servo = *motor.servo;
    const Held& held = joints_[static_cast<std::size_t>(motor.joint)];
    const bool turns = held.axis == &kHinge;
    const double at = turns ? dJointGetHingeAngle(held.id) : dJointGetSliderPosition(held.id);
    double behind = servo.target.at(t + dt) - held.sign * at;
    if (turns) behind = std::remainder(behind, 2 * std::numbers::pi);
    const double target = at + held.sign * (behind + servo.kd / servo.kp * servo.target_speed);
    held.axis->set(held.id, dParamLoStop, target), held.axis->set(held.id, dParamHiStop, target);
    held.axis->set(held.id, dParamStopERP, dt * servo.kp / (dt * servo.kp + servo.kd));
    held.axis->set(held.id, dParamStopCFM, 1 / (dt * servo.kp + servo.kd));
  }
}

// ODE pushes back a share dParamStopERP of an overshoot per step, by a speed that stays. A stop without restitution
// would rebound with up to that share of the speed at any step size. On the matched track the small overshoot stays,
// and falls with the step.
void OdeJoints::set_limits(const Joint& joint, const Held& held, Track track) {
  assert(held.axis && "only a hinge and a slider are read with limits");
  if (std::isfinite(held.low)) held.axis->set(held.id, dParamLoStop, held.low);
  if (std::isfinite(held.high)) held.axis->set(held.id, dParamHiStop, held.high);
  held.axis->set(held.id, dParamBounce, joint.restitution);
  if (track == Track::matched) held.axis->set(held.id, dParamStopERP, 0);
}

void OdeJoints::ask_for_reactions() {
  feedback_.assign(joints_.size(), {});
  for (std::size_t k = 0; k < joints_.size(); ++k) dJointSetFeedback(joints_[k].id, &feedback_[k]);
}

// ODE's, too, are in W, and its torque is about the body's centre of mass.
std::vector<ReportedReaction> OdeJoints::reactions() const {
  if (!servos_.empty()) return {};  // they would hold the servos' efforts
  std::vector<ReportedReaction> reactions;
  for (std::size_t k = 0; k < feedback_.size(); ++k) {
    const dJointFeedback& of = feedback_[k];
    reactions.push_back({joints_[k].first, {of.f1[0], of.f1[1], of.f1[2]}, {of.t1[0], of.t1[1], of.t1[2]}});
  }
  return reactions;
}

bool OdeJoints::Held::has_limits() const { return std::isfinite(low) || std::isfinite(high); }

// ODE measures a hinge's angle from -pi to pi and compares it directly with the stops. The stops are shifted by the
// hinge's whole turns.
void OdeJoints::unwind() {
  constexpr double kTurn = 2 * std::numbers::pi;
  for (Held& held : joints_) {
    if (held.axis != &kHinge || !held.has_limits()) continue;
    const double angle = dJointGetHingeAngle(held.id), turned = std::round((held.angle - angle) / kTurn) * kTurn;
    held.angle = angle + turned;
    if (std::isfinite(held.low)) held.axis->set(held.id, dParamLoStop, held.low - turned);
    if (std::isfinite(held.high)) held.axis->set(held.id, dParamHiStop, held.high - turned);
  }
}

void OdeJoints::drive(double t) {
  unwind();
  const auto acts = [t](const Motor& motor) { return motor.from <= t && t < motor.until; };
  for (const Motor& motor : motors_) joints_[motor.joint].axis->set(joints_[motor.joint].id, dParamFMax, 0);
  for (const Motor& motor : motors_) {
    if (!acts(motor)) continue;
    const Held& held = joints_[motor.joint];
    held.axis->set(held.id, dParamVel, held.sign * *motor.speed);
    held.axis->set(held.id, dParamFMax, motor.most);
  }
}

void OdeJoints::set_cfm(double cfm) {
  for (const Held& held : joints_) {
    if (held.axis) {
      held.axis->set(held.id, dParamCFM, cfm);
      held.axis->set(held.id, dParamStopCFM, cfm);
      continue;
    }
    const dJointType type = dJointGetType(held.id);
    if (type == dJointTypeBall) dJointSetBallParam(held.id, dParamCFM, cfm);
    if (type == dJointTypeFixed) dJointSetFixedParam(held.id, dParamCFM, cfm);
    if (type == dJointTypeDBall) dJointSetDBallParam(held.id, dParamCFM, cfm);
  }
}

SettingsInForce OdeJoints::settings_in_force() const {
  if (joints_.empty()) return {};
  SettingsInForce settings = {{"springs, dampers and efforts of joints", "user forces, recomputed before each step"}};
  if (has_servos_)
    settings.emplace_back("servos", servos_.empty()
                                        ? "efforts that Rigor computes from the state at each step's start"
                                        : "ODE's stops at the target, softened to kp and kd: implicit Euler");
  for (const Held& held : joints_) {
    const dJointType type = dJointGetType(held.id);
    const bool has_own = type == dJointTypeBall || type == dJointTypeFixed || type == dJointTypeDBall;
    if (!has_own) continue;  // all are set alike
    const dReal erp = type == dJointTypeBall    ? dJointGetBallParam(held.id, dParamERP)
                      : type == dJointTypeFixed ? dJointGetFixedParam(held.id, dParamERP)
                                                : dJointGetDBallParam(held.id, dParamERP);
    settings.emplace_back("erp of ball, distance and fixed joints", fmt::format("{:g}", erp));
    break;
  }
  const auto limited = std::find_if(joints_.begin(), joints_.end(), [](const Held& held) { return held.has_limits(); });
  if (limited != joints_.end()) {  // all are set alike
    settings.emplace_back("joint stop erp", fmt::format("{:g}", limited->axis->get(limited->id, dParamStopERP)));
    settings.emplace_back("joint stop cfm", fmt::format("{:g}", limited->axis->get(limited->id, dParamStopCFM)));
  }
  return settings;
}

}  // namespace rigor::inline adapters
