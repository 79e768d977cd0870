// A screw: b's point stays on the axis, the axes of both stay parallel, and the way along the axis is k times the
// angle, with k = pitch / 2 pi. The way tells how many whole turns the angle has. Five rows.
#include <cmath>
#include <numbers>

#include "core/dynamics/joints/joint_constraint.h"
#include "core/dynamics/model/hinge_angle.h"

namespace rigor::inline dynamics {
namespace {

class Screw : public JointConstraint {
 public:
  Screw(const ScrewJoint& joint, const EndsAtStart& ends)
      : runs_(make_masked(Lock::across | Lock::tilt, &joint.anchor, &joint.axis, ends)),
        pitch_(joint.pitch),
        axis_a_(ends.direction_in_a(joint.axis)),
        angle_{ends.direction_in_a(joint.axis.unitOrthogonal()), ends.direction_in_b(joint.axis.unitOrthogonal()),
               ends.direction_in_b(joint.axis.cross(joint.axis.unitOrthogonal()))},
        arm_b_(ends.in_b(joint.anchor)),
        start_(joint.axis.dot(joint.anchor - ends.a.position)) {}

  int rows() const override { return 5; }

  void evaluate(const EndMotion& a, const EndMotion& b, ConstraintRow* out) const override {
    runs_->evaluate(a, b, out);
    ConstraintRow& row = out[4];
    const Vec3 axis = a.R * axis_a_, arm = b.R * arm_b_;
    keep_offset(a, axis, b, arm, start_, &row);
    const double k = pitch_ / (2 * std::numbers::pi);
    row.on_a.tail<3>() += k * axis, row.on_b.tail<3>() -= k * axis;
    row.bias -= k * a.angular_velocity.cross(axis).dot(b.angular_velocity);
    row.gap = thread_gap(a, b, row.gap);
  }

  void find_gaps(const EndMotion& a, const EndMotion& b, double* out) const override {
    runs_->find_gaps(a, b, out);
    double way;
    keep_offset(a, a.R * axis_a_, b, b.R * arm_b_, start_, &way);
    out[4] = thread_gap(a, b, way);
  }

 private:
  double thread_gap(const EndMotion& a, const EndMotion& b, double way) const {
    const double turns = angle_.at(a.R * axis_a_, a.R, b.R) / (2 * std::numbers::pi);
    const double off = way / pitch_ - turns;
    return pitch_ * (off - std::round(off));
  }

  std::unique_ptr<JointConstraint> runs_;  // as a cylindrical joint
  double pitch_;                           // m per turn
  Vec3 axis_a_;                            // unit
  HingeAngle angle_;
  Vec3 arm_b_;    // m, in b's frame
  double start_;  // m: of the point along the axis, from a's centre
};

}  // namespace

std::unique_ptr<JointConstraint> make_screw(const ScrewJoint& joint, const EndsAtStart& ends) {
  return std::make_unique<Screw>(joint, ends);
}

}  // namespace rigor::inline dynamics
