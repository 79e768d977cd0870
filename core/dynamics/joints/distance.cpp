// A distance joint: two points stay as far apart as they are at t = 0. One row.
#include "core/dynamics/joints/joint_constraint.h"

namespace rigor::inline dynamics {
namespace {

class Distance : public JointOf<Distance> {
 public:
  Distance(const DistanceJoint& joint, const EndsAtStart& ends)
      : arm_a_(joint.point_a),
        arm_b_(joint.point_b),
        distance_((ends.b.position + ends.b.R * arm_b_ - ends.a.position - ends.a.R * arm_a_).norm()) {}

  int rows() const override { return 1; }
  template <typename Row>
  void fill(const EndMotion& a, const EndMotion& b, Row* out) const {
    keep_distance(a, a.R * arm_a_, b, b.R * arm_b_, distance_, out);
  }

 private:
  Vec3 arm_a_, arm_b_;  // m, in each end's frame
  double distance_;     // m
};

}  // namespace

std::unique_ptr<JointConstraint> make_distance(const DistanceJoint& joint, const EndsAtStart& ends) {
  return std::make_unique<Distance>(joint, ends);
}

}  // namespace rigor::inline dynamics
