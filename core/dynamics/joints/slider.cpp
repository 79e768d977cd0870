// A slider: b does not rotate relative to a, and its centre moves along an axis fixed in a. Five rows: three pairs of
// directions stay at right angles, and two offsets across the axis keep their values of t = 0.
#include "core/dynamics/joints/joint_constraint.h"

namespace rigor {
namespace {

class Slider : public JointOf<Slider> {
 public:
  Slider(const SliderJoint& joint, const EndsAtStart& ends) : axes_a_(ends.a.R.transpose() * ends.b.R) {
    const Across across = directions_across(joint.axis);
    const Vec3 line = ends.b.position - ends.a.position;
    across_a_[0] = ends.direction_in_a(across.first), across_a_[1] = ends.direction_in_a(across.second);
    offset_[0] = across.first.dot(line), offset_[1] = across.second.dot(line);
  }

  int rows() const override { return 5; }
  template <typename Row>
  void fill(const EndMotion& a, const EndMotion& b, Row* out) const {
    for (int k = 0; k < 2; ++k) keep_offset(a, a.R * across_a_[k], b, offset_[k], out + k);
    const Mat3 axes = a.R * axes_a_;
    for (int k = 0; k < 3; ++k) keep_right_angle(a, axes.col(k), b, b.R.col((k + 1) % 3), out + 2 + k);
  }

 private:
  Mat3 axes_a_;       // b's axes at t = 0, in a's frame
  Vec3 across_a_[2];  // unit, in a's frame
  double offset_[2];  // m
};

}  // namespace

std::unique_ptr<JointConstraint> make_slider(const SliderJoint& joint, const EndsAtStart& ends) {
  return std::make_unique<Slider>(joint, ends);
}

}  // namespace rigor
