#include "cases/metrics/measures/joints/joint_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rigor::inline metric {
namespace {

double angle_of(const Vec3& u, const Vec3& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); }

}  // namespace

MovingEnd end_motion(const JointEnd& end, BodyColumns bodies) {
  MovingEnd motion;
  if (end.body != kWorld) {
    const auto i = static_cast<std::size_t>(end.body);
    motion.R = bodies.rotation(i), motion.orientation = bodies.orientation(i);
    motion.centre = bodies.position(i), motion.velocity = bodies.velocity(i), motion.w = bodies.angular_velocity(i);
  }
  motion.arm = motion.R * end.point, motion.axis = motion.R * end.axis;
  return motion;
}

JointGeometry::JointGeometry(const Scene& scene, const Joint& joint)
    : a_{joint.a, Vec3::Zero(), Vec3::Zero()}, b_{joint.b, Vec3::Zero(), Vec3::Zero()} {
  const BodyPose pose_a = scene.pose(joint.a), pose_b = scene.pose(joint.b);
  start_turn_ = pose_a.orientation.conjugate() * pose_b.orientation;
  set_ends(pose_a, pose_b, joint);
  const Vec3 axis_a = pose_a.orientation * a_.axis, axis_b = pose_b.orientation * b_.axis;
  start_angle_ = angle_of(axis_a, axis_b);
  const Vec3 apart = pose_b.position + pose_b.orientation * b_.point - pose_a.position - pose_a.orientation * a_.point;
  start_length_ = apart.norm();
}

void JointGeometry::set_ends(const BodyPose& pose_a, const BodyPose& pose_b, const Joint& joint) {
  const auto share = [&](const Vec3& place) {
    a_.point = pose_a.orientation.conjugate() * (place - pose_a.position);
    b_.point = pose_b.orientation.conjugate() * (place - pose_b.position);
  };
  const auto axes = [&](const Vec3& of_a, const Vec3& of_b) {
    a_.axis = pose_a.orientation.conjugate() * of_a, b_.axis = pose_b.orientation.conjugate() * of_b;
  };
  const ForJoints set{
      [&](const UniversalJoint& type) { share(type.anchor), axes(type.axis, type.axis2), holds_ = Angle::right_angle; },
      [&](const DistanceJoint& type) { a_.point = type.point_a, b_.point = type.point_b, place_ = Place::distance; },
      [&](const CompoundAxis&) { place_ = Place::anywhere; },
      [&](const CompoundJoint& type) {
        series_.emplace(type.axes, pose_a, pose_b), place_ = Place::series, holds_ = Angle::series;
      },
      [&](const PlanarJoint& type) {
        share(type.anchor), axes(type.normal, type.normal), place_ = Place::plane, holds_ = Angle::axis;
      },
      [&](const ScrewJoint& type) {
        share(type.anchor), axes(type.axis, type.axis), place_ = Place::thread, holds_ = Angle::axis;
        pitch_ = type.pitch;
      },
      [&]<typename Type>(const Type&) {
        constexpr unsigned locks = Type::descriptor().locks.value(), turns = locks & Lock::turns;
        const Vec3 *anchor = anchor_of(joint), *axis = axis_of(joint);
        share(anchor ? *anchor : pose_b.position);
        if (axis) axes(*axis, *axis);
        holds_ = turns == Lock::turns ? Angle::all : turns == Lock::tilt ? Angle::axis : Angle::none;
        place_ = (locks & Lock::shifts) == Lock::across ? Place::line : Place::point;
      }};
  std::visit(set, joint.type);
}

// The locked rows of a compound joint: of forces, or of torques.
double JointGeometry::series_size(BodyColumns bodies, bool of_turns, double AxisSeries::Row::*what) const {
  const MovingEnd a = end_motion(a_, bodies), b = end_motion(b_, bodies);
  const AxisSeries::Rows rows = series_->at({a.centre, a.velocity, a.w, a.R}, {b.centre, b.velocity, b.w, b.R});
  double size = 0;
  for (int k = 0; k < rows.count; ++k) {
    const AxisSeries::Row& row = rows.locked[static_cast<std::size_t>(k)];
    if (row.force.isZero(0) == of_turns) size = std::hypot(size, row.*what);
  }
  return size;
}

// How far b is along the axis from where its angle puts it. The angle is known up to whole turns.
double JointGeometry::thread_gap(const MovingEnd& a, const MovingEnd& b) const {
  const Quat turn = a.orientation.conjugate() * b.orientation * start_turn_.conjugate();
  const double angle = 2 * std::atan2(a_.axis.dot(turn.vec()), turn.w());
  const double off = a.axis.dot(b.point() - a.point()) / pitch_ - angle / (2 * std::numbers::pi);
  return pitch_ * (off - std::round(off));
}

double JointGeometry::gap(BodyColumns bodies) const {
  if (place_ == Place::anywhere) return 0;
  if (place_ == Place::series) return series_size(bodies, false, &AxisSeries::Row::gap);
  const MovingEnd a = end_motion(a_, bodies), b = end_motion(b_, bodies);
  const Vec3 apart = b.point() - a.point();
  if (place_ == Place::distance) return std::abs(apart.norm() - start_length_);
  if (place_ == Place::plane) return std::abs(a.axis.dot(apart));
  if (place_ == Place::thread) return std::hypot(a.axis.cross(apart).norm(), thread_gap(a, b));
  return place_ == Place::line ? a.axis.cross(apart).norm() : apart.norm();
}

double JointGeometry::gap_rate(BodyColumns bodies) const {
  if (place_ == Place::anywhere) return 0;
  if (place_ == Place::series) return series_size(bodies, false, &AxisSeries::Row::rate);
  const MovingEnd a = end_motion(a_, bodies), b = end_motion(b_, bodies);
  if (place_ == Place::distance) {
    const Vec3 apart = b.point() - a.point(), rate = b.point_velocity() - a.point_velocity();
    return apart.isZero(0) ? rate.norm() : std::abs(apart.normalized().dot(rate));
  }
  const bool is_in_frame_of_a = holds_ == Angle::all || place_ != Place::point;
  const Vec3 rate = b.point_velocity() - (is_in_frame_of_a ? a.velocity_at(b.point()) : a.point_velocity());
  if (place_ == Place::plane) return std::abs(a.axis.dot(rate));
  if (place_ == Place::thread) {
    const double off = a.axis.dot(rate) - pitch_ / (2 * std::numbers::pi) * a.axis.dot(b.w - a.w);
    return std::hypot(a.axis.cross(rate).norm(), off);
  }
  return place_ == Place::line ? a.axis.cross(rate).norm() : rate.norm();
}

double JointGeometry::twist(BodyColumns bodies) const {
  if (holds_ == Angle::series) return series_size(bodies, true, &AxisSeries::Row::gap);
  if (holds_ == Angle::none) return 0;
  const MovingEnd a = end_motion(a_, bodies), b = end_motion(b_, bodies);
  if (holds_ == Angle::all) return angle_between(start_turn_, a.orientation.conjugate() * b.orientation);
  return std::abs(angle_of(a.axis, b.axis) - (holds_ == Angle::right_angle ? start_angle_ : 0));
}

double JointGeometry::twist_rate(BodyColumns bodies) const {
  if (holds_ == Angle::series) return series_size(bodies, true, &AxisSeries::Row::rate);
  if (holds_ == Angle::none) return 0;
  const MovingEnd a = end_motion(a_, bodies), b = end_motion(b_, bodies);
  const Vec3 rate = b.w - a.w;
  if (holds_ == Angle::all) return rate.norm();
  if (holds_ == Angle::axis) return a.axis.cross(rate).norm();
  const Vec3 across = a.axis.cross(b.axis);
  return across.isZero(0) ? rate.norm() : std::abs(across.normalized().dot(rate));
}

bool any_holds_angle(const Scene& scene) {
  return std::any_of(scene.joints.begin(), scene.joints.end(),
                     [&](const Joint& joint) { return JointGeometry(scene, joint).holds_angle(); });
}

}  // namespace rigor::inline metric
