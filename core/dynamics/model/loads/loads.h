// The forces and torques on a scene's bodies by gravity, springs, timed forces, and the springs, dampers and motors of
// its joints. Constraint forces of joints are not included. The core's integrators use them. Adapters of engines
// without such springs use them before each step, so all engines have the same law.
#pragma once

#include <optional>
#include <vector>

#include "core/dynamics/model/joint_coordinate.h"
#include "core/dynamics/model/loads/force_schedule.h"
#include "core/dynamics/model/loads/servo_drive.h"
#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline dynamics {

// Force [N] and torque about the centre of mass [N m], both in W.
struct Wrench {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
};
using Wrenches = std::vector<Wrench>;  // one for each body of the scene

// A point of a body, or of the world, as it moves.
struct PointMotion {
  Vec3 arm = Vec3::Zero();       // m, from the centre of mass, in W; the point itself for the world
  Vec3 position = Vec3::Zero();  // m, in W
  Vec3 velocity = Vec3::Zero();  // m/s, in W
};
PointMotion point_motion(BodyColumns bodies, int body, const Vec3& point);

// The share of the step from t to t + dt, which may go backward, in which the force acts; at dt = 0, whether it does.
double share_of_step(double from, double until, double t, double dt);
inline double share_of_step(const TimedForce& force, double t, double dt) {
  return share_of_step(force.from, force.until, t, dt);
}

// Acts on a joint's coordinate x: -elastic_effort(x - rest) - damping x', and the efforts of its motors.
struct JointDrive {
  JointCoordinate coordinate;
  std::size_t joint;  // index
  double stiffness, quadratic_stiffness, damping, rest;
  std::vector<Motor> motors = {};  // that give an effort
  std::vector<ServoDrive> servos = {};
  double push = 0;  // N m, N: of motors that are on the way to their speed; see Loads::set_push()

  // Over the step from t to t + dt, an effort that changes in time counts with its mean. A method whose stages belong
  // to an `instant` of a smooth part gets the value of that instant.
  double effort(const JointCoordinate::Value& at, double t, double dt, std::optional<double> instant = {}) const;
};

// A servo on a sum of joint coordinates.
struct SumDrive {
  struct Term {
    JointCoordinate coordinate;
    double ratio;
  };
  std::vector<Term> terms;
  ServoDrive servo;

  // On a coordinate of ratio 1, as JointDrive::effort().
  double effort(BodyColumns bodies, double t, double dt, std::optional<double> instant = {}) const;
};

class Loads {
 public:
  explicit Loads(const Scene& scene);

  // All loads except gravity, over a step [t, t + dt] that begins with `bodies`. A timed force counts with its mean
  // over the step, so that its impulse is exact for any dt. dt = 0 takes its value at t.
  void evaluate(BodyColumns bodies, double t, double dt, Wrenches& out) const;
  // The same, with m g added for every body that is not fixed.
  void evaluate_with_gravity(BodyColumns bodies, double t, double dt, Wrenches& out) const;

  // The first instant strictly between t and `end` at which a timed force or motor begins, ends or turns a corner, or a
  // servo samples; `end` if there is none.
  double next_switch(double t, double end) const;
  // Calls part(from, length) in order for each part of the step [t, t + dt] in which no timed force begins or ends.
  // Methods of high order thus never step across a jump.
  template <typename Part>
  void for_each_smooth_part(double t, double dt, const Part& part) const {
    double from = t;
    for (double to = next_switch(t, t + dt); to != t + dt; to = next_switch(from, t + dt)) {
      part(from, to - from);
      from = to;
    }
    part(from, from == t ? dt : t + dt - from);
  }

  const std::vector<Spring>& springs() const { return springs_; }
  const std::vector<TimedForce>& forces() const { return forces_; }
  // Calls visit(force, share) for each timed force that acts in the step [t, t + dt], in their order.
  template <typename Visit>
  void for_each_acting(double t, double dt, const Visit& visit) const {
    const auto visit_one = [&](const TimedForce& force) {
      const double share = share_of_step(force, t, dt);
      if (share != 0) visit(force, share);
    };
    constexpr std::size_t kFew = 32;  // to look at each of so many takes less than to find those that act
    if (forces_.size() <= kFew) {
      for (const TimedForce& force : forces_) visit_one(force);
    } else {
      for (const std::size_t i : schedule_.acting(t, t + dt)) visit_one(forces_[i]);
    }
  }
  // Sets the effort of a joint's motors [N m, N] on its coordinate from now on, for a joint with a motor of given
  // speed.
  void set_push(std::size_t joint, double effort);
  // Samples the servos of which a sample is due at t. Methods that do not locate events call it before each step.
  void sample_servos(BodyColumns bodies, double t);
  double next_sample(double t, double end) const;  // the first instant between the two at which a servo samples
  double shortest_period() const;                  // s: of the servos that sample; infinite if there are none
  std::vector<ServoDrive>* servos_of(std::size_t joint);
  bool drives_joints() const { return !drives_.empty() || !sums_.empty(); }
  // Calls add(body, effort, force, torque) for both ends of each coordinate that is driven: effort times the force and
  // torque acts on the body. Arguments as of JointDrive::effort().
  template <typename Add>
  void for_each_drive(BodyColumns bodies, double t, double dt, std::optional<double> instant, const Add& add) const {
    const auto add_ends = [&](const JointCoordinate& coordinate, const JointCoordinate::Value& at, double effort) {
      add(coordinate.a(), effort, -at.force, at.torque_a);
      add(coordinate.b(), effort, at.force, at.torque_b);
    };
    for (const JointDrive& drive : drives_) {
      const JointCoordinate::Value at = drive.coordinate.at(bodies);
      add_ends(drive.coordinate, at, drive.effort(at, t, dt, instant));
    }
    for (const SumDrive& sum : sums_) {
      const double effort = sum.effort(bodies, t, dt, instant);
      for (const auto& [coordinate, ratio] : sum.terms) add_ends(coordinate, coordinate.at(bodies), ratio * effort);
    }
  }
  bool empty() const { return springs_.empty() && forces_.empty() && !drives_joints(); }
  bool damped() const { return damped_; }
  bool quadratic() const { return quadratic_; }  // whether any spring between points is
  // Of motors that push, and of servos.
  template <typename Archive>
  void archive_state(Archive& archive) {
    archive.each(drives_, [&](JointDrive& drive) {
      archive(drive.push);
      archive.each(drive.servos, [&](ServoDrive& servo) { archive(servo); });
    });
  }

 private:
  void add_drive(const Scene& scene, std::size_t joint);
  void add_sum(const Scene& scene, const Motor& motor);

  Vec3 gravity_;
  std::vector<double> masses_;  // kg; 0 for a fixed body
  std::vector<Spring> springs_;
  std::vector<TimedForce> forces_;
  ForceSchedule schedule_;
  std::vector<JointDrive> drives_;
  std::vector<SumDrive> sums_;
  bool damped_ = false, quadratic_ = false;
};

}  // namespace rigor::inline dynamics
