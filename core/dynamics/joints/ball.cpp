// A ball joint: one point is shared. Three rows.
#include "core/dynamics/joints/joint_constraint.h"

namespace rigor {
namespace {

class Ball : public JointOf<Ball> {
 public:
  Ball(const BallJoint& joint, const EndsAtStart& ends)
      : arm_a_(ends.in_a(joint.anchor)), arm_b_(ends.in_b(joint.anchor)) {}

  int rows() const override { return 3; }
  template <typename Row>
  void fill(const EndMotion& a, const EndMotion& b, Row* out) const {
    keep_together(a, a.R * arm_a_, b, b.R * arm_b_, out);
  }

 private:
  Vec3 arm_a_, arm_b_;  // m, of the anchor, in each end's frame
};

}  // namespace

std::unique_ptr<JointConstraint> make_ball(const BallJoint& joint, const EndsAtStart& ends) {
  return std::make_unique<Ball>(joint, ends);
}

}  // namespace rigor
