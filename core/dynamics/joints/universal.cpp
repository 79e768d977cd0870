// A universal joint: one point is shared, and an axis of a stays at right angles to an axis of b. Four rows.
#include "core/dynamics/joints/joint_constraint.h"

namespace rigor::inline dynamics {
namespace {

class Universal : public JointOf<Universal> {
 public:
  Universal(const UniversalJoint& joint, const EndsAtStart& ends)
      : arm_a_(ends.in_a(joint.anchor)),
        arm_b_(ends.in_b(joint.anchor)),
        axis_a_(ends.direction_in_a(joint.axis)),
        axis_b_(ends.direction_in_b(joint.square_axis2())) {}

  int rows() const override { return 4; }
  template <typename Row>
  void fill(const EndMotion& a, const EndMotion& b, Row* out) const {
    keep_together(a, a.R * arm_a_, b, b.R * arm_b_, out);
    keep_right_angle(a, a.R * axis_a_, b, b.R * axis_b_, out + 3);
  }

 private:
  Vec3 arm_a_, arm_b_;    // m, of the anchor, in each end's frame
  Vec3 axis_a_, axis_b_;  // unit, in each end's frame; exactly at right angles at t = 0
};

}  // namespace

std::unique_ptr<JointConstraint> make_universal(const UniversalJoint& joint, const EndsAtStart& ends) {
  return std::make_unique<Universal>(joint, ends);
}

}  // namespace rigor::inline dynamics
