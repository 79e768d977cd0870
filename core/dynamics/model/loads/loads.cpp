#include "core/dynamics/model/loads/loads.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/scene/turn_window.h"

namespace rigor::inline dynamics {
namespace {

void add_force(int body, const Vec3& force, const Vec3& arm, Wrenches& out) {
  if (body == kWorld) return;
  out[body].force += force;
  out[body].torque += arm.cross(force);
}

void add_wrench(int body, const Vec3& force, const Vec3& torque, Wrenches& out) {
  if (body == kWorld) return;
  out[body].force += force;
  out[body].torque += torque;
}

// The force on b's point. If the two points coincide, the line has no direction, and a spring with a rest length has no
// force.
Vec3 spring_force(const Spring& spring, const PointMotion& a, const PointMotion& b) {
  const Vec3 line = b.position - a.position;
  const double length = line.norm();
  if (length == 0) return Vec3::Zero();
  const Vec3 direction = line / length;
  const double stretching = direction.dot(b.velocity - a.velocity);
  return -(elastic_effort(spring, length - spring.rest_length) + spring.damping * stretching) * direction;
}

}  // namespace

PointMotion point_motion(BodyColumns bodies, int body, const Vec3& point) {
  if (body == kWorld) return {point, point, Vec3::Zero()};
  const Vec3 arm = bodies.rotation(body) * point;
  return {arm, bodies.position(body) + arm, bodies.velocity(body) + bodies.angular_velocity(body).cross(arm)};
}

double share_of_step(double from, double until, double t, double dt) {
  if (dt == 0) return t >= from && t < until ? 1 : 0;
  const double first = std::min(t, t + dt), last = std::max(t, t + dt);
  return std::clamp((std::min(until, last) - std::max(from, first)) / std::abs(dt), 0.0, 1.0);
}

double JointDrive::effort(const JointCoordinate::Value& at, double t, double dt, std::optional<double> instant) const {
  double sum = push - elastic_effort(*this, at.x - rest) - damping * at.rate;
  for (const Motor& motor : motors) sum += motor.mean_effort(t, dt, instant);
  for (const ServoDrive& servo : servos) sum += servo.effort(at.x, at.rate, t, dt, instant);
  return sum;
}

double SumDrive::effort(BodyColumns bodies, double t, double dt, std::optional<double> instant) const {
  double x = 0, rate = 0;
  for (const auto& [coordinate, ratio] : terms) {
    const JointCoordinate::Value at = coordinate.at(bodies);
    x += ratio * at.x, rate += ratio * at.rate;
  }
  return servo.effort(x, rate, t, dt, instant);
}

Loads::Loads(const Scene& scene)
    : gravity_(scene.gravity), springs_(scene.springs), forces_(scene.forces), schedule_(scene.forces) {
  for (const Body& body : scene.bodies) masses_.push_back(body.fixed ? 0 : body.mass);
  for (std::size_t k = 0; k < scene.joints.size(); ++k) add_drive(scene, k);
  for (const Motor& motor : scene.motors)
    if (!motor.plus.empty()) add_sum(scene, motor);
  const auto damps = [](const auto& row) { return row.damping != 0; };
  quadratic_ = std::any_of(springs_.begin(), springs_.end(),
                           [](const Spring& spring) { return spring.quadratic_stiffness != 0; });
  damped_ = std::any_of(springs_.begin(), springs_.end(), damps) ||
            std::any_of(drives_.begin(), drives_.end(),
                        [&](const JointDrive& drive) {
                          return damps(drive) || std::any_of(drive.servos.begin(), drive.servos.end(),
                                                             [](const ServoDrive& servo) { return servo.damps(); });
                        }) ||
            std::any_of(sums_.begin(), sums_.end(), [](const SumDrive& sum) { return sum.servo.damps(); });
}

// Each of its angles is known with its whole turns, so no way round is shorter.
void Loads::add_sum(const Scene& scene, const Motor& motor) {
  SumDrive& sum = sums_.emplace_back(SumDrive{{}, ServoDrive(motor, false)});
  const auto add = [&](int joint, double ratio) {
    sum.terms.push_back({JointCoordinate(scene, scene.joints[static_cast<std::size_t>(joint)]), ratio});
  };
  add(motor.joint, 1);
  for (const JointTerm& term : motor.plus) add(term.joint, term.ratio);
}

void Loads::add_drive(const Scene& scene, std::size_t k) {
  const Joint& joint = scene.joints[k];
  std::vector<Motor> motors;
  std::vector<ServoDrive> servos;
  bool has_speed = false;
  for (const Motor& motor : scene.motors) {
    if (motor.joint != static_cast<int>(k) || !motor.plus.empty()) continue;
    has_speed |= motor.speed.has_value();
    if (motor.servo) servos.emplace_back(motor, takes_the_shorter_way(joint));
    if (motor.gives_effort()) motors.push_back(motor);
  }
  if (joint.stiffness == 0 && joint.damping == 0 && motors.empty() && servos.empty() && !has_speed) return;
  drives_.push_back({JointCoordinate(scene, joint), k, joint.stiffness, joint.quadratic_stiffness, joint.damping,
                     joint.rest, std::move(motors), std::move(servos)});
}

void Loads::set_push(std::size_t joint, double effort) {
  const auto drive = std::find_if(drives_.begin(), drives_.end(), [&](const auto& d) { return d.joint == joint; });
  assert(drive != drives_.end() && "a joint whose motor has a speed has a drive");
  drive->push = effort;
}

void Loads::evaluate(BodyColumns bodies, double t, double dt, Wrenches& out) const {
  out.assign(bodies.size(), Wrench{});
  for (const Spring& spring : springs_) {
    const PointMotion a = point_motion(bodies, spring.a, spring.point_a),
                      b = point_motion(bodies, spring.b, spring.point_b);
    const Vec3 force = spring_force(spring, a, b);
    add_force(spring.a, -force, a.arm, out);
    add_force(spring.b, force, b.arm, out);
  }
  for_each_acting(t, dt, [&](const TimedForce& force, double share) {
    add_force(force.body, share * force.force, bodies.rotation(force.body) * force.point, out);
    out[force.body].torque += share * force.torque;
  });
  for_each_drive(bodies, t, dt, {}, [&](int body, double effort, const Vec3& force, const Vec3& torque) {
    add_wrench(body, effort * force, effort * torque, out);
  });
}

void Loads::evaluate_with_gravity(BodyColumns bodies, double t, double dt, Wrenches& out) const {
  evaluate(bodies, t, dt, out);
  for (std::size_t i = 0; i < masses_.size(); ++i) out[i].force += masses_[i] * gravity_;
}

double Loads::next_switch(double t, double end) const {
  end = schedule_.next_switch(t, end);
  for (const JointDrive& drive : drives_) {
    for (const Motor& motor : drive.motors) end = motor.next_switch(t, end);
    for (const ServoDrive& servo : drive.servos) end = servo.next_switch(t, end);
  }
  for (const SumDrive& sum : sums_) end = sum.servo.next_switch(t, end);
  return end;
}

void Loads::sample_servos(BodyColumns bodies, double t) {
  for (JointDrive& drive : drives_) {
    if (drive.servos.empty()) continue;
    const JointCoordinate::Value at = drive.coordinate.at(bodies);
    for (ServoDrive& servo : drive.servos) servo.sample(at.x, at.rate, t);
  }
}

double Loads::next_sample(double t, double end) const {
  for (const JointDrive& drive : drives_) {
    for (const ServoDrive& servo : drive.servos) end = servo.next_sample(t, end);
  }
  return end;
}

double Loads::shortest_period() const {
  double shortest = std::numeric_limits<double>::infinity();
  for (const JointDrive& drive : drives_) {
    for (const ServoDrive& servo : drive.servos) {
      if (servo.period() > 0) shortest = std::min(shortest, servo.period());
    }
  }
  return shortest;
}

std::vector<ServoDrive>* Loads::servos_of(std::size_t joint) {
  const auto drive = std::find_if(drives_.begin(), drives_.end(), [&](const auto& d) { return d.joint == joint; });
  return drive == drives_.end() || drive->servos.empty() ? nullptr : &drive->servos;
}

}  // namespace rigor::inline dynamics
