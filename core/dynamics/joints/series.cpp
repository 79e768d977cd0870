// A compound joint: the motions that its axes in series lock (core/scene/joints/axis_series.h); and an axis of one,
// which locks none by itself.
#include "core/dynamics/joints/joint_constraint.h"
#include "core/scene/joints/axis_series.h"

namespace rigor::inline dynamics {
namespace {

SeriesEnd end_of(const EndMotion& motion) {
  return {motion.position, motion.velocity, motion.angular_velocity, motion.R};
}

class Series : public JointConstraint {
 public:
  explicit Series(const AxisSeries& series) : series_(series) {}

  int rows() const override { return series_.locked(); }
  void evaluate(const EndMotion& a, const EndMotion& b, ConstraintRow* out) const override {
    const AxisSeries::Rows rows = series_.at(end_of(a), end_of(b));
    const Vec3 line = b.position - a.position;
    for (int k = 0; k < rows.count; ++k) {
      const AxisSeries::Row& row = rows.locked[static_cast<std::size_t>(k)];
      out[k] = {-joined(row.force, row.torque + line.cross(row.force)), joined(row.force, row.torque), row.gap,
                row.bias};
    }
  }
  void find_gaps(const EndMotion& a, const EndMotion& b, double* out) const override {
    const AxisSeries::Rows rows = series_.at(end_of(a), end_of(b));
    for (int k = 0; k < rows.count; ++k) out[k] = rows.locked[static_cast<std::size_t>(k)].gap;
  }

 private:
  AxisSeries series_;
};

class LocksNothing : public JointConstraint {
 public:
  int rows() const override { return 0; }
  void evaluate(const EndMotion&, const EndMotion&, ConstraintRow*) const override {}
  void find_gaps(const EndMotion&, const EndMotion&, double*) const override {}
};

}  // namespace

std::unique_ptr<JointConstraint> make_series(const CompoundJoint& joint, const BodyPose& a, const BodyPose& b) {
  return std::make_unique<Series>(AxisSeries(joint.axes, a, b));
}

std::unique_ptr<JointConstraint> make_axis_of_series() { return std::make_unique<LocksNothing>(); }

}  // namespace rigor::inline dynamics
