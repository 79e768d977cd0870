// A fixed joint: b keeps its pose in a. Six rows: b's centre is a point of a, and three pairs of directions stay at
// right angles. One direction of each pair belongs to a, the other to b.
#include "core/dynamics/joints/joint_constraint.h"

namespace rigor {
namespace {

class Fixed : public JointOf<Fixed> {
 public:
  explicit Fixed(const EndsAtStart& ends)
      : arm_a_(ends.in_a(ends.b.position)), axes_a_(ends.a.R.transpose() * ends.b.R) {}

  int rows() const override { return 6; }
  template <typename Row>
  void fill(const EndMotion& a, const EndMotion& b, Row* out) const {
    keep_together(a, a.R * arm_a_, b, Vec3::Zero(), out);
    const Mat3 axes = a.R * axes_a_;
    for (int k = 0; k < 3; ++k) keep_right_angle(a, axes.col(k), b, b.R.col((k + 1) % 3), out + 3 + k);
  }

 private:
  Vec3 arm_a_;   // m, of b's centre, in a's frame
  Mat3 axes_a_;  // b's axes at t = 0, in a's frame
};

}  // namespace

std::unique_ptr<JointConstraint> make_fixed(const FixedJoint&, const EndsAtStart& ends) {
  return std::make_unique<Fixed>(ends);
}

}  // namespace rigor
