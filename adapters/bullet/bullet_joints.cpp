#include "adapters/bullet/bullet_joints.h"

#include <algorithm>
#include <numbers>

#include "adapters/bullet/bullet_convert.h"
#include "core/dynamics/model/loads/loads.h"

namespace rigor::inline adapters::bullet {
namespace {

constexpr double kFar = 1e30;  // m: a limit that is never reached

// Axes in W of a frame of which the given ones are taken as they are.
Mat3 frame_with_z(const Vec3& z) {
  const Vec3 x = z.unitOrthogonal();
  Mat3 frame;
  frame << x, z.cross(x), z;
  return frame;
}
Mat3 frame_with_x(const Vec3& x) {
  const Vec3 y = x.unitOrthogonal();
  Mat3 frame;
  frame << x, y, x.cross(y);
  return frame;
}

// A frame that both bodies share at t = 0, in each body's own frame. Bullet's bodies use principal frames.
struct SharedFrame {
  btTransform in_a, in_b;

  SharedFrame(const btRigidBody& a, const btRigidBody& b, const Vec3& origin_W, const Mat3& axes_W) {
    const btTransform frame_W(to_bullet(axes_W), to_bullet(origin_W));
    in_a = a.getCenterOfMassTransform().inverse() * frame_W;
    in_b = b.getCenterOfMassTransform().inverse() * frame_W;
  }
};

// Bullet's signs for a coordinate without limits: the lower above the upper one.
void free_all(btGeneric6DofSpring2Constraint& constraint) {
  for (int axis = 0; axis < 6; ++axis) constraint.setLimit(axis, 1, -1);
}

void set_limits(btHingeConstraint& hinge, double lower, double upper, double restitution, bool matched) {
  const btAngularLimit shipped;
  hinge.setLimit(lower, upper, shipped.getSoftness(), matched ? 1 : shipped.getBiasFactor(), restitution);
}

struct Make {
  const Joint& joint;
  btRigidBody &a, &b;
  Vec3 center_b;  // m, in W
  Joints::Set set;

  std::unique_ptr<btTypedConstraint> operator()(const BallJoint& ball) const {
    const btVector3 anchor = to_bullet(ball.anchor);
    return std::make_unique<btPoint2PointConstraint>(a, b, a.getCenterOfMassTransform().inverse() * anchor,
                                                     b.getCenterOfMassTransform().inverse() * anchor);
  }
  std::unique_ptr<btTypedConstraint> operator()(const CylindricalJoint& cylinder) const {
    const SharedFrame frame(a, b, cylinder.anchor, frame_with_x(cylinder.axis));
    auto constraint = std::make_unique<btSliderConstraint>(a, b, frame.in_a, frame.in_b, true);
    constraint->setLowerAngLimit(1), constraint->setUpperAngLimit(-1);  // free, by Bullet's signs
    return constraint;
  }
  std::unique_ptr<btTypedConstraint> operator()(const HingeJoint& hinge) const {
    const SharedFrame frame(a, b, hinge.anchor, frame_with_z(hinge.axis));
    auto constraint = std::make_unique<btHingeConstraint>(a, b, frame.in_a, frame.in_b, true);
    // The two forms are the same equations. The one with "frame offset" converges in few sweeps; the other one is that
    // of the direct solver's twin.
    if (set == Joints::Set::for_direct_solver) constraint->setUseFrameOffset(false);
    if (joint.has_limits()) limit(*constraint);
    return constraint;
  }
  std::unique_ptr<btTypedConstraint> operator()(const SliderJoint& slider) const {
    const SharedFrame frame(a, b, center_b, frame_with_x(slider.axis));
    return std::make_unique<btSliderConstraint>(a, b, frame.in_a, frame.in_b, true);
  }
  std::unique_ptr<btTypedConstraint> operator()(const FixedJoint&) const {
    const SharedFrame frame(a, b, center_b, Mat3::Identity());
    return std::make_unique<btFixedConstraint>(a, b, frame.in_a, frame.in_b);
  }
  // None of these is among the features.
  std::unique_ptr<btTypedConstraint> operator()(const CompoundAxis&) const { return nullptr; }
  std::unique_ptr<btTypedConstraint> operator()(const CompoundJoint&) const { return nullptr; }
  std::unique_ptr<btTypedConstraint> operator()(const PlanarJoint&) const { return nullptr; }
  std::unique_ptr<btTypedConstraint> operator()(const ScrewJoint&) const { return nullptr; }
  std::unique_ptr<btTypedConstraint> operator()(const UniversalJoint& universal) const {
    const Vec3 z = universal.axis, x = universal.square_axis2();
    Mat3 axes;
    axes << x, z.cross(x), z;
    const SharedFrame frame(a, b, universal.anchor, axes);
    auto constraint = std::make_unique<btGeneric6DofSpring2Constraint>(a, b, frame.in_a, frame.in_b, RO_XYZ);
    free_all(*constraint);
    for (const int locked : {0, 1, 2, 4}) constraint->setLimit(locked, 0, 0);
    return constraint;
  }
  std::unique_ptr<btTypedConstraint> operator()(const DistanceJoint&) const { return nullptr; }  // refused before

 private:
  // Angles lie between -pi and pi, so a limit there is none; Joints::unwind() handles limits beyond. On the matched
  // track the bounce is not multiplied by "bias". An overshoot is not pushed back ("stop ERP" 0), because that would
  // return a share of the incoming speed.
  void limit(btHingeConstraint& hinge) const {
    const double pi = std::numbers::pi;
    const bool matched = set != Joints::Set::as_shipped;
    set_limits(hinge, std::max(joint.lower, -pi), std::min(joint.upper, pi), joint.restitution, matched);
    if (matched) hinge.setParam(BT_CONSTRAINT_STOP_ERP, 0);
  }
};

// Its stop is reached in one step ("stop ERP" 1): with less Bullet would brake what only comes near.
std::unique_ptr<btTypedConstraint> limits_along(const Vec3& axis, const Make& ends) {
  const SharedFrame frame(ends.a, ends.b, ends.center_b, frame_with_x(axis));
  auto limits = std::make_unique<btGeneric6DofSpring2Constraint>(ends.a, ends.b, frame.in_a, frame.in_b, RO_XYZ);
  free_all(*limits);
  limits->setLimit(0, std::max(ends.joint.lower, -kFar), std::min(ends.joint.upper, kFar));
  limits->setBounce(0, ends.joint.restitution);
  limits->setParam(BT_CONSTRAINT_STOP_ERP, 1, 0);
  return limits;
}

void drive(btTypedConstraint& constraint, const Motor& motor, double share, double dt) {
  if (auto* hinge = dynamic_cast<btHingeConstraint*>(&constraint)) {
    hinge->enableAngularMotor(share > 0, *motor.speed, motor.most * share * dt);  // N m s
  } else if (auto* slider = dynamic_cast<btSliderConstraint*>(&constraint)) {
    slider->setPoweredLinMotor(share > 0);
    slider->setTargetLinMotorVelocity(*motor.speed);
    slider->setMaxLinMotorForce(motor.most * share);  // N
  }
}

}  // namespace

Joints::Joints(const Scene& scene, const BodyOf& body_of, Set set) : set_(set) {
  for (const Joint& joint : scene.joints) add(scene, joint, body_of);
  std::copy_if(scene.motors.begin(), scene.motors.end(), std::back_inserter(motors_),
               [](const Motor& motor) { return motor.speed.has_value(); });
}

void Joints::add(const Scene& scene, const Joint& joint, const BodyOf& body_of) {
  const Make make{joint, body_of(joint.a), body_of(joint.b), scene.pose(joint.b).position, set_};
  constraints_.push_back(std::visit(make, joint.type));
  of_joint_.push_back(constraints_.back().get());
  const bool b_moves = joint.b != kWorld && !scene.bodies[static_cast<std::size_t>(joint.b)].fixed;
  reported_.push_back({b_moves ? joint.b : joint.a, b_moves});
  const bool is_beyond = joint.lower < -std::numbers::pi || joint.upper > std::numbers::pi;
  auto* hinge = dynamic_cast<btHingeConstraint*>(of_joint_.back());
  if (hinge && joint.has_limits()) limited_.push_back(hinge);
  if (hinge && joint.has_limits() && is_beyond)
    winding_.push_back({hinge, joint.lower, joint.upper, joint.restitution});
  if (joint.has_limits() && !turns(joint)) constraints_.push_back(limits_along(*free_axis(joint), make));
}

void Joints::enter(btDynamicsWorld& world) {
  constexpr bool kApart = false;  // the scene decides whether jointed bodies may touch (Body::collides)
  for (const auto& constraint : constraints_) world.addConstraint(constraint.get(), kApart);
}

void Joints::ask_for_reactions() {
  feedback_ = std::vector<btJointFeedback>(of_joint_.size());
  for (std::size_t k = 0; k < of_joint_.size(); ++k) of_joint_[k]->setJointFeedback(&feedback_[k]);
}

// Bullet's, too, are in W, and its torques are about the bodies' centres of mass.
std::vector<ReportedReaction> Joints::reactions() const {
  std::vector<ReportedReaction> reactions;
  for (std::size_t k = 0; k < feedback_.size(); ++k) {
    const btJointFeedback& of = feedback_[k];
    const auto& [body, is_b] = reported_[k];
    reactions.push_back({body, to_rigor(is_b ? of.m_appliedForceBodyB : of.m_appliedForceBodyA),
                         to_rigor(is_b ? of.m_appliedTorqueBodyB : of.m_appliedTorqueBodyA)});
  }
  return reactions;
}

// Bullet stores a hinge's limits as an arc of less than a turn. It gets the part within reach.
void Joints::unwind() {
  constexpr double kTurn = 2 * std::numbers::pi, kReach = 3;  // rad
  for (Winding& at : winding_) {
    const double angle = at.hinge->getHingeAngle();
    at.angle = angle + std::round((at.angle - angle) / kTurn) * kTurn;
    set_limits(*at.hinge, std::max(at.lower, at.angle - kReach), std::min(at.upper, at.angle + kReach), at.restitution,
               set_ != Set::as_shipped);
  }
}

// With "frame offset" a hinge on a static body lets go of the arm in a step in which it is at a limit, and all that the
// arm carried is lost. Without it ten sweeps leave half of what a long arm carries, so that it is for such steps alone.
void Joints::choose_frame_offsets() {
  if (set_ != Set::for_sweeps) return;
  for (btHingeConstraint* hinge : limited_) {
    hinge->testLimit(hinge->getRigidBodyA().getCenterOfMassTransform(),
                     hinge->getRigidBodyB().getCenterOfMassTransform());
    hinge->setUseFrameOffset(hinge->getSolveLimit() == 0);
  }
}

void Joints::set_for_step(double t, double dt) {
  unwind();
  choose_frame_offsets();
  for (const Motor& motor : motors_) {
    btTypedConstraint& constraint = *of_joint_[static_cast<std::size_t>(motor.joint)];
    drive(constraint, motor, 0, dt);
  }
  for (const Motor& motor : motors_) {
    const double share = share_of_step(motor.from, motor.until, t, dt);
    if (share > 0) drive(*of_joint_[static_cast<std::size_t>(motor.joint)], motor, share, dt);
  }
}

}  // namespace rigor::inline adapters::bullet
