// The one coordinate x of a hinge, a slider or an axis of a compound joint, on which its spring, damper, limits and
// motors act. For a hinge it is the angle [rad] of b relative to a about the axis since t = 0, within half a turn of 0
// or of the middle_of_turn() between its limits. For a slider it is the displacement [m] of b's centre along the axis.
#pragma once

#include <optional>

#include "core/dynamics/model/hinge_angle.h"
#include "core/engine/body_table.h"
#include "core/scene/joints/axis_series.h"
#include "core/scene/scene.h"

namespace rigor::inline dynamics {

class JointCoordinate {
 public:
  // The joint has a free_axis().
  JointCoordinate(const Scene& scene, const Joint& joint);

  int a() const { return a_; }
  int b() const { return b_; }

  struct Value {
    double x = 0, rate = 0;  // rad, rad/s or m, m/s
    // the part of the rate's derivative that does not depend on accelerations
    double bias = 0;
    Vec3 force = Vec3::Zero();                              // of a unit of effort on b; the opposite on a. N/N, in W
    Vec3 torque_a = Vec3::Zero(), torque_b = Vec3::Zero();  // about the centres of mass, in W
  };
  Value at(BodyColumns bodies) const;

  bool turns() const { return turns_; }
  // x and as many whole turns as bring it nearest to `near`; of a slider x itself.
  double with_turns(double x, double near) const;

 private:
  Value on_axis(BodyColumns bodies) const;
  Value in_series(BodyColumns bodies) const;

  int a_, b_;
  bool turns_;
  double middle_;                     // rad: of the turn in which the angle lies
  std::optional<AxisSeries> series_;  // of an axis of a compound joint,
  std::size_t index_ = 0;             // and which of them it is
  Vec3 axis_a_;                       // unit, in a's frame
  HingeAngle angle_;                  // of a hinge
  double start_ = 0;                  // m: where b's centre is along the axis at t = 0; of a slider
};

}  // namespace rigor::inline dynamics
