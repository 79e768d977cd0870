// A joint as the rows that it puts on its two ends. One kind of joint, one file; joint_constraint.cpp is the table.
// What a joint holds is taken from the scene's poses at t = 0, so that its gap is zero there.
#pragma once

#include <memory>

#include "core/dynamics/joints/constraint_rows.h"
#include "core/scene/scene.h"

namespace rigor {

class JointConstraint {
 public:
  virtual ~JointConstraint() = default;
  virtual int rows() const = 0;
  // Writes rows() rows to `out`.
  virtual void evaluate(const EndMotion& a, const EndMotion& b, ConstraintRow* out) const = 0;
  // Writes only the gaps of the rows, from the poses of the ends.
  virtual void find_gaps(const EndMotion& a, const EndMotion& b, double* out) const = 0;
};

// For a joint that says what its rows are once, in a template fill(a, b, out) for either kind of row.
template <typename Own>
class JointOf : public JointConstraint {
 public:
  void evaluate(const EndMotion& a, const EndMotion& b, ConstraintRow* out) const final { own().fill(a, b, out); }
  void find_gaps(const EndMotion& a, const EndMotion& b, double* out) const final { own().fill(a, b, out); }

 private:
  const Own& own() const { return static_cast<const Own&>(*this); }
};

// The poses of the two ends at t = 0, and the conversion of data given in W to each end's frame.
struct EndsAtStart {
  EndMotion a, b;
  Vec3 in_a(const Vec3& point_W) const { return a.R.transpose() * (point_W - a.position); }
  Vec3 in_b(const Vec3& point_W) const { return b.R.transpose() * (point_W - b.position); }
  Vec3 direction_in_a(const Vec3& v) const { return a.R.transpose() * v; }
  Vec3 direction_in_b(const Vec3& v) const { return b.R.transpose() * v; }
};

std::unique_ptr<JointConstraint> make_ball(const BallJoint& joint, const EndsAtStart& ends);
std::unique_ptr<JointConstraint> make_distance(const DistanceJoint& joint, const EndsAtStart& ends);
std::unique_ptr<JointConstraint> make_fixed(const FixedJoint& joint, const EndsAtStart& ends);
std::unique_ptr<JointConstraint> make_hinge(const HingeJoint& joint, const EndsAtStart& ends);
std::unique_ptr<JointConstraint> make_slider(const SliderJoint& joint, const EndsAtStart& ends);
std::unique_ptr<JointConstraint> make_universal(const UniversalJoint& joint, const EndsAtStart& ends);

std::unique_ptr<JointConstraint> make_constraint(const Scene& scene, const Joint& joint);

}  // namespace rigor
