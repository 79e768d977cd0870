// The rows of a joint that a mask of locked motions describes.
//   all three shifts   the point is shared                        three rows
//   two across         b's point stays on a line of a             two rows
//   one along          b's point stays in a plane of a            one row
//   all three turns    three pairs of directions stay square      three rows, one direction of each pair in a
//   two tilts          the axis is shared                         two rows
#include <cassert>

#include "core/dynamics/joints/joint_constraint.h"

namespace rigor::inline dynamics {
namespace {

template <unsigned kShifts, unsigned kTurns>
class Masked : public JointOf<Masked<kShifts, kTurns>> {
 public:
  Masked(const Vec3& point, const Vec3& axis, const EndsAtStart& ends)
      : arm_a_(ends.in_a(point)), arm_b_(ends.in_b(point)), axes_a_(ends.a.R.transpose() * ends.b.R) {
    if constexpr (kShifts != Lock::across && kShifts != Lock::shift_z && kTurns != Lock::tilt) return;
    axis_b_ = ends.direction_in_b(axis);
    const Across across = directions_across(axis);
    const Vec3 line = point - ends.a.position;
    axis_a_ = ends.direction_in_a(axis), along_ = axis.dot(line);
    const Vec3 directions[] = {across.first, across.second};
    for (int k = 0; k < 2; ++k) across_a_[k] = ends.direction_in_a(directions[k]), offset_[k] = directions[k].dot(line);
  }

  int rows() const override { return kShiftRows + (kTurns == Lock::turns ? 3 : kTurns == Lock::tilt ? 2 : 0); }

  template <typename Row>
  void fill(const EndMotion& a, const EndMotion& b, Row* out) const {
    if constexpr (kShifts == Lock::shifts) keep_together(a, a.R * arm_a_, b, b.R * arm_b_, out);
    if constexpr (kShifts == Lock::across)
      for (int k = 0; k < 2; ++k) keep_offset(a, a.R * across_a_[k], b, b.R * arm_b_, offset_[k], out + k);
    if constexpr (kShifts == Lock::shift_z) keep_offset(a, a.R * axis_a_, b, b.R * arm_b_, along_, out);
    if constexpr (kTurns == Lock::tilt) {
      const Vec3 axis = b.R * axis_b_;
      for (int k = 0; k < 2; ++k) keep_right_angle(a, a.R * across_a_[k], b, axis, out + kShiftRows + k);
    }
    if constexpr (kTurns == Lock::turns) {
      const Mat3 axes = a.R * axes_a_;
      for (int k = 0; k < 3; ++k) keep_right_angle(a, axes.col(k), b, b.R.col((k + 1) % 3), out + kShiftRows + k);
    }
  }

 private:
  static constexpr int kShiftRows = kShifts == Lock::shifts ? 3 : kShifts == Lock::across ? 2 : 1;

  Vec3 arm_a_, arm_b_;  // m, of the point, in each end's frame
  Mat3 axes_a_;         // b's axes at t = 0, in a's frame
  Vec3 axis_b_;         // unit, in b's frame
  Vec3 across_a_[2];    // unit, across the axis, in a's frame
  double offset_[2];    // m, of b's point from a's centre along them
  Vec3 axis_a_;         // unit, in a's frame
  double along_ = 0;    // m, of b's point from a's centre along the axis
};

template <unsigned kShifts, unsigned kTurns>
std::unique_ptr<JointConstraint> masked(const Vec3& point, const Vec3* axis, const EndsAtStart& ends) {
  return std::make_unique<Masked<kShifts, kTurns>>(point, axis ? *axis : Vec3::UnitZ(), ends);
}

}  // namespace

std::unique_ptr<JointConstraint> make_masked(unsigned mask, const Vec3* anchor, const Vec3* axis,
                                             const EndsAtStart& ends) {
  const Vec3 point = anchor ? *anchor : ends.b.position;
  switch (mask) {
    case Lock::shifts:
      return masked<Lock::shifts, 0>(point, axis, ends);
    case Lock::shifts | Lock::tilt:
      return masked<Lock::shifts, Lock::tilt>(point, axis, ends);
    case Lock::shifts | Lock::turns:
      return masked<Lock::shifts, Lock::turns>(point, axis, ends);
    case Lock::shift_z | Lock::tilt:
      return masked<Lock::shift_z, Lock::tilt>(point, axis, ends);
    case Lock::across | Lock::tilt:
      return masked<Lock::across, Lock::tilt>(point, axis, ends);
    case Lock::across | Lock::turns:
      return masked<Lock::across, Lock::turns>(point, axis, ends);
    default:
      assert(false && "no joint type has this mask");
      return nullptr;
  }
}

}  // namespace rigor::inline dynamics
