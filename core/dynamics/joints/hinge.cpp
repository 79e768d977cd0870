// A hinge: one point and one direction are shared. Five rows.
#include "core/dynamics/joints/joint_constraint.h"

namespace rigor {
namespace {

class Hinge : public JointOf<Hinge> {
 public:
  Hinge(const HingeJoint& joint, const EndsAtStart& ends)
      : arm_a_(ends.in_a(joint.anchor)), arm_b_(ends.in_b(joint.anchor)), axis_b_(ends.direction_in_b(joint.axis)) {
    const Across across = directions_across(joint.axis);
    first_a_ = ends.direction_in_a(across.first), second_a_ = ends.direction_in_a(across.second);
  }

  int rows() const override { return 5; }
  template <typename Row>
  void fill(const EndMotion& a, const EndMotion& b, Row* out) const {
    keep_together(a, a.R * arm_a_, b, b.R * arm_b_, out);
    const Vec3 axis = b.R * axis_b_;
    keep_right_angle(a, a.R * first_a_, b, axis, out + 3);
    keep_right_angle(a, a.R * second_a_, b, axis, out + 4);
  }

 private:
  Vec3 arm_a_, arm_b_;       // m, of the anchor, in each end's frame
  Vec3 axis_b_;              // unit, in b's frame
  Vec3 first_a_, second_a_;  // unit, across the axis, in a's frame
};

}  // namespace

std::unique_ptr<JointConstraint> make_hinge(const HingeJoint& joint, const EndsAtStart& ends) {
  return std::make_unique<Hinge>(joint, ends);
}

}  // namespace rigor
