// The gap between the two ends of a joint and its rate, in the directions that the joint holds (joint_geometry.h). It
// distinguishes stabilisations best. Without one the gap grows with time, Baumgarte's method and ERP keep it at a level
// that depends on dt, and a projection keeps it at rounding.
#include "cases/metrics/measures/joints/joint_series.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_gap(const JudgedRun& run, const std::string& what, OfJoint quantity) {
  if (run.scene.joints.empty()) return {{}, kNoJoints};
  return worst_joint(run, what, quantity);
}

}  // namespace

MetricRow joint_gap() {
  return {.name = "joint_gap",
          .unit = "m",
          .summary = "largest distance between what a joint holds together",
          .measure = [](const JudgedRun& run) { return measure_gap(run, "gap", &JointGeometry::gap); },
          .needs = {}};
}

MetricRow joint_gap_rate() {
  return {.name = "joint_gap_rate",
          .unit = "m/s",
          .summary = "largest speed, as read, at which a joint's ends move where it holds them",
          .measure = [](const JudgedRun& run) { return measure_gap(run, "gap's rate", &JointGeometry::gap_rate); },
          .needs = {}};
}

}  // namespace rigor::inline metric
