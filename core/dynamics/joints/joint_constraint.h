// A joint as rows on its two ends. masked_constraint.cpp has the rows of every joint that a mask of locked motions
// describes; other types have their own files. The scene's poses at t = 0 define the held pose, where the gap is zero.
#pragma once

#include <memory>

#include "core/dynamics/joints/constraint_rows.h"
#include "core/scene/scene.h"

namespace rigor::inline dynamics {

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

// Locks the motions of `mask` (joint_descriptor.h) at an anchor and about an axis, both in W at t = 0. Without an
// anchor the point is b's centre. The axis may be null where the mask needs none.
std::unique_ptr<JointConstraint> make_masked(unsigned mask, const Vec3* anchor, const Vec3* axis,
                                             const EndsAtStart& ends);
std::unique_ptr<JointConstraint> make_distance(const DistanceJoint& joint, const EndsAtStart& ends);
std::unique_ptr<JointConstraint> make_screw(const ScrewJoint& joint, const EndsAtStart& ends);
std::unique_ptr<JointConstraint> make_series(const CompoundJoint& joint, const BodyPose& a, const BodyPose& b);
std::unique_ptr<JointConstraint> make_axis_of_series();
std::unique_ptr<JointConstraint> make_universal(const UniversalJoint& joint, const EndsAtStart& ends);

std::unique_ptr<JointConstraint> make_constraint(const Scene& scene, const Joint& joint);

}  // namespace rigor::inline dynamics
