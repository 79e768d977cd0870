#include "cases/metrics/measures/joints/reported_at_joint.h"

namespace rigor::inline metric {

JointReaction reported_at_joint(const Joint& joint, const JointGeometry& geometry, const ReportedReaction& reported,
                                BodyColumns bodies) {
  const MovingEnd a = end_motion(geometry.a(), bodies), b = end_motion(geometry.b(), bodies);
  const bool is_on_b = reported.body == joint.b;
  const Vec3 arm = is_on_b ? b.arm : geometry.slides() ? Vec3(b.point() - a.centre) : a.arm;
  const double sign = is_on_b ? 1 : -1;
  return {sign * reported.force, sign * (reported.torque - arm.cross(reported.force))};
}

}  // namespace rigor::inline metric
