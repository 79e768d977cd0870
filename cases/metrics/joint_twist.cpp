// The relative rotation of the two ends of a joint and its rate, in the directions that the joint locks
// (joint_geometry.h).
#include "cases/metrics/measures/joints/joint_series.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_twist(const JudgedRun& run, const std::string& what, OfJoint quantity) {
  if (run.scene.joints.empty()) return {{}, kNoJoints};
  if (!any_holds_angle(run.scene)) return {{}, kNoAngle};
  return worst_joint(run, what, quantity);
}

}  // namespace

MetricRow joint_twist() {
  return {.name = "joint_twist",
          .unit = "rad",
          .summary = "largest angle by which a joint's ends have turned where it does not let them",
          .measure = [](const JudgedRun& run) { return measure_twist(run, "twist", &JointGeometry::twist); },
          .needs = {}};
}

MetricRow joint_twist_rate() {
  return {
      .name = "joint_twist_rate",
      .unit = "rad/s",
      .summary = "largest rate, as read, at which a joint's ends turn where it does not let them",
      .measure = [](const JudgedRun& run) { return measure_twist(run, "twist's rate", &JointGeometry::twist_rate); },
      .needs = {}};
}

}  // namespace rigor::inline metric
