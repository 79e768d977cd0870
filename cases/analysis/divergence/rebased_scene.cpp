#include "cases/analysis/divergence/rebased_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace rigor::inline analysis {
namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi;

// How a body has moved since t = 0: where its point p of t = 0 is, and how its directions turn.
struct Carrier {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  Quat turn = Quat::Identity();

  Vec3 point(const Vec3& p) const { return to + turn * (p - from); }
};

Carrier carrier_of(const Scene& scene, const std::vector<BodyState>& bodies, int body) {
  if (body == kWorld || scene.bodies[static_cast<std::size_t>(body)].fixed) return {};
  const BodyPose start = scene.pose(body);
  const BodyState& now = bodies[static_cast<std::size_t>(body)];
  return {start.position, now.position, (now.orientation * start.orientation.conjugate()).normalized()};
}

// rad, from -pi to pi.
double angle_about(const Vec3& axis, const Quat& turn) {
  return std::remainder(2 * std::atan2(turn.vec().dot(axis), turn.w()), kWholeTurn);
}

// The end of a compound joint at these states.
SeriesEnd end_of(const Scene& scene, const std::vector<BodyState>& bodies, int body) {
  SeriesEnd end;
  if (body == kWorld) return end;
  const bool stays = scene.bodies[static_cast<std::size_t>(body)].fixed;
  const BodyState& now = bodies[static_cast<std::size_t>(body)];
  const BodyPose pose = stays ? scene.pose(body) : BodyPose{now.position, now.orientation.normalized()};
  end.position = pose.position, end.R = matrix_of(pose.orientation);
  return end;
}

double coordinate_of(const Scene& scene, const Joint& joint, const std::vector<BodyState>& bodies) {
  const Vec3* axis = free_axis(joint);
  if (!axis) return 0;
  const Carrier a = carrier_of(scene, bodies, joint.a), b = carrier_of(scene, bodies, joint.b);
  if (turns(joint)) return angle_about(*axis, a.turn.conjugate() * b.turn);
  const Vec3 centre = scene.pose(joint.b == kWorld ? joint.a : joint.b).position;
  if (joint.b == kWorld) return -(a.turn * *axis).dot(a.to - centre);
  return (a.turn * *axis).dot(b.point(centre) - a.point(centre));
}

void move_axes(Joint& joint, const std::vector<SeriesAxis>& axes) {
  if (auto* whole = std::get_if<CompoundJoint>(&joint.type)) whole->axes = axes;
  if (auto* one = std::get_if<CompoundAxis>(&joint.type)) one->axes = axes;
}

void move_vectors(Joint& joint, const Carrier& a, const Carrier& b) {
  for_each_vector(joint.type, [&](const char* key, JointVector kind, Vec3& vector) {
    // A universal joint's second axis is fixed in b.
    const Carrier& carrier = std::strcmp(key, "axis2") == 0 ? b : a;
    if (kind == JointVector::point) vector = carrier.point(vector);
    if (kind == JointVector::direction) vector = (carrier.turn * vector).normalized();
  });
}

void move_coordinate(Joint& joint, double x) {
  joint.rest -= turns(joint) ? std::remainder(x, kWholeTurn) : x;
  joint.lower = std::min(0.0, joint.lower - x), joint.upper = std::max(0.0, joint.upper - x);
}

void shift(TimeTable& table, double t, double value) {
  if (!table.is_constant()) {
    for (double& time : table.times) time -= t;
  }
  for (double& each : table.values) each -= value;
}

// A servo that samples keeps a start before 0, from which its samples are counted.
void shift(Motor& motor, double t, double x) {
  const bool samples = motor.servo && motor.servo->period > 0;
  motor.from = samples ? motor.from - t : std::max(0.0, motor.from - t);
  motor.until -= t;
  if (motor.efforts) shift(*motor.efforts, t, 0);
  if (motor.servo) shift(motor.servo->target, t, x);
}

}  // namespace

JointCoordinates::JointCoordinates(const Scene& scene)
    : scene_(scene), series_(scene.joints.size()), values_(scene.joints.size(), 0.0) {
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    if (const auto* whole = std::get_if<CompoundJoint>(&joint.type))
      series_[k].emplace(whole->axes, scene.pose(joint.a), scene.pose(joint.b));
  }
}

void JointCoordinates::follow(const std::vector<BodyState>& bodies) {
  AxisSeries::Rows rows;  // of the last compound joint, whose axes stand behind it
  for (std::size_t k = 0; k < scene_.joints.size(); ++k) {
    const Joint& joint = scene_.joints[k];
    if (series_[k]) rows = series_[k]->at(end_of(scene_, bodies, joint.a), end_of(scene_, bodies, joint.b));
    const auto* axis = std::get_if<CompoundAxis>(&joint.type);
    const double x = axis ? rows.coordinates[axis->index].gap : coordinate_of(scene_, joint, bodies);
    values_[k] = turns(joint) ? values_[k] + std::remainder(x - values_[k], kWholeTurn) : x;
  }
}

Scene rebased(const Scene& scene, const std::vector<BodyState>& bodies, const std::vector<double>& coordinates,
              double t) {
  Scene out = scene;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    Body& body = out.bodies[i];
    if (body.fixed) continue;
    body.position = bodies[i].position, body.orientation = bodies[i].orientation.normalized();
    body.velocity = bodies[i].velocity, body.angular_velocity = bodies[i].angular_velocity;
  }
  std::vector<SeriesAxis> axes;  // of the last compound joint, whose axes stand behind it
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    if (const auto* whole = std::get_if<CompoundJoint>(&joint.type))
      axes = AxisSeries(whole->axes, scene.pose(joint.a), scene.pose(joint.b))
                 .axes_at(end_of(scene, bodies, joint.a), end_of(scene, bodies, joint.b));
    move_vectors(out.joints[k], carrier_of(scene, bodies, joint.a), carrier_of(scene, bodies, joint.b));
    move_axes(out.joints[k], axes);
    move_coordinate(out.joints[k], coordinates[k]);
  }
  for (Motor& motor : out.motors) {
    const auto k = static_cast<std::size_t>(motor.joint);
    double x = coordinates[k];
    for (const JointTerm& term : motor.plus) x += term.ratio * coordinates[static_cast<std::size_t>(term.joint)];
    const bool is_angle = motor.plus.empty() && turns(scene.joints[k]);
    shift(motor, t, is_angle ? std::remainder(x, kWholeTurn) : x);
  }
  std::erase_if(out.motors, [](const Motor& motor) { return motor.until <= 0; });
  for (TimedForce& force : out.forces) force.from = std::max(0.0, force.from - t), force.until -= t;
  std::erase_if(out.forces, [](const TimedForce& force) { return force.until <= 0; });
  return out;
}

}  // namespace rigor::inline analysis
