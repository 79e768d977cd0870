// Shared code of the joint metrics: the worst joint at each sample.
#pragma once

#include <string>
#include <vector>

#include "cases/metrics/measures/joints/joint_geometry.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {

inline constexpr const char* kNoJoints = "the scene has no joints";
inline constexpr const char* kNoAngle = "no joint of the scene holds an angle";

using OfJoint = double (JointGeometry::*)(BodyColumns bodies) const;

// `what` is said of the worst joint: "gap of the hinge of 'world' and 'rod'".
inline MetricResult worst_joint(const JudgedRun& run, const std::string& what, OfJoint quantity) {
  const Scene& scene = run.scene;
  if (run.trajectory.samples.empty()) return {{}, "the run has no finite sample"};
  std::vector<JointGeometry> joints;
  for (const Joint& joint : scene.joints) joints.emplace_back(scene, joint);
  TimeSeries series;
  double largest = -1;
  for (const Sample& sample : run.trajectory.samples) {
    double worst = -1;
    std::size_t at = 0;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const double value = (joints[k].*quantity)(sample.bodies.columns());
      if (value > worst) worst = value, at = k;
    }
    const Joint& joint = scene.joints[at];
    Instant instant{sample.time, joint.b == kWorld ? joint.a : joint.b, "", worst, 0};
    if (worst > largest) largest = worst, instant.component = what + " of " + scene.joint_name(at);
    series.add(worst, instant);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace rigor::inline metric
