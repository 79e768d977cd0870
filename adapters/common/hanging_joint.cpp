#include "adapters/common/hanging_joint.h"

namespace rigor::inline adapters {

HangingJoint::HangingJoint(const Scene& scene, int joint, int body) : body_(body) {
  const Joint& of = scene.joints[static_cast<std::size_t>(joint)];
  if (free_axis(of)) coordinate_.emplace(scene, of);
  const BodyPose pose = scene.pose(body);
  if (turns(of)) anchor_ = pose.orientation.conjugate() * (*anchor_of(of) - pose.position);
}

ReportedReaction HangingJoint::reaction(BodyColumns start, Vec3 force, Vec3 torque) const {
  if (!coordinate_) return {body_, force, torque};
  const JointCoordinate::Value at = coordinate_->at(start);
  const bool is_b = coordinate_->b() == body_;
  // Of a unit of effort on the body; its power at x' = 1 is 1.
  const Vec3 unit_force = is_b ? at.force : Vec3(-at.force), unit_torque = is_b ? at.torque_b : at.torque_a;
  const Vec3 arm = start.orientation(static_cast<std::size_t>(body_)) * anchor_;
  const double effort = coordinate_->turns() ? unit_torque.dot(torque - arm.cross(force)) : unit_force.dot(force);
  return {body_, force - effort * unit_force, torque - effort * unit_torque};
}

}  // namespace rigor::inline adapters
