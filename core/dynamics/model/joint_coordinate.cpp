#include "core/dynamics/model/joint_coordinate.h"

#include <cmath>
#include <numbers>

#include "core/scene/turn_window.h"

namespace rigor::inline dynamics {
namespace {

SeriesEnd end_state(BodyColumns bodies, int body) {
  if (body == kWorld) return {};
  const auto i = static_cast<std::size_t>(body);
  return {bodies.position(i), bodies.velocity(i), bodies.angular_velocity(i), bodies.rotation(i)};
}

}  // namespace

JointCoordinate::JointCoordinate(const Scene& scene, const Joint& joint)
    : a_(joint.a), b_(joint.b), turns_(rigor::turns(joint)), middle_(middle_of_turn(joint).value_or(0)) {
  const BodyPose a = scene.pose(joint.a), b = scene.pose(joint.b);
  if (const auto* of_compound = std::get_if<CompoundAxis>(&joint.type))
    series_.emplace(of_compound->axes, a, b), index_ = of_compound->index;
  const Vec3 axis = *free_axis(joint), across = axis.unitOrthogonal();
  axis_a_ = a.orientation.conjugate() * axis;
  angle_ = {a.orientation.conjugate() * across, b.orientation.conjugate() * across,
            b.orientation.conjugate() * axis.cross(across)};
  start_ = axis.dot(b.position - a.position);
}

JointCoordinate::Value JointCoordinate::at(BodyColumns bodies) const {
  Value value = series_ ? in_series(bodies) : on_axis(bodies);
  if (middle_ != 0) value.x = with_turns(value.x, middle_);
  return value;
}

JointCoordinate::Value JointCoordinate::on_axis(BodyColumns bodies) const {
  const SeriesEnd a = end_state(bodies, a_), b = end_state(bodies, b_);
  const Vec3 axis = a.R * axis_a_;
  Value value;
  if (turns_) {
    value.x = angle_.at(axis, a.R, b.R);
    value.rate = axis.dot(b.angular_velocity - a.angular_velocity);
    value.bias = a.angular_velocity.cross(axis).dot(b.angular_velocity);
    value.torque_a = -axis, value.torque_b = axis;
    return value;
  }
  // The effort acts on both along the line through b's centre, so that the pair keeps its angular momentum.
  const Vec3 line = b.position - a.position;
  value.x = axis.dot(line) - start_;
  value.torque_a = axis.cross(line);
  const Vec3 coming = b.velocity - a.velocity, turning = a.angular_velocity.cross(axis);
  value.rate = axis.dot(coming) + a.angular_velocity.dot(value.torque_a);
  value.bias = 2 * turning.dot(coming) + a.angular_velocity.cross(turning).dot(line);
  value.force = axis;
  return value;
}

JointCoordinate::Value JointCoordinate::in_series(BodyColumns bodies) const {
  const SeriesEnd a = end_state(bodies, a_), b = end_state(bodies, b_);
  const AxisSeries::Row row = series_->at(a, b).coordinates[index_];
  Value value;
  value.x = row.gap, value.rate = row.rate, value.bias = row.bias;
  value.force = row.force, value.torque_b = row.torque;
  value.torque_a = -row.torque - (b.position - a.position).cross(row.force);
  return value;
}

double JointCoordinate::with_turns(double x, double near) const {
  if (!turns_) return x;
  constexpr double kTurn = 2 * std::numbers::pi;
  return x + kTurn * std::round((near - x) / kTurn);
}

}  // namespace rigor::inline dynamics
