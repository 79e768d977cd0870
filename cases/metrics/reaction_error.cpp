// By how much the forces and couples that joints carry at the run's own states differ from those at the truth's: what a
// designer of bearings reads from a simulation. Both are worked out from the equations of motion (joint_reactions.h),
// none is asked of an engine (reported_reaction_error.cpp does), and each counts in the directions in which it is
// unique. At up to a hundred instants, evenly through the run: a reaction takes a hundred times what a distance does.
#include <algorithm>

#include "cases/metrics/measures/joints/joint_reactions.h"
#include "cases/metrics/measures/joints/joint_series.h"

namespace rigor {
namespace {

using Part = Vec3 JointReaction::*;
using UniquePart = Mat3 UniqueReaction::*;

MetricResult measure_reaction(const JudgedRun& run, const std::string& what, Part part, UniquePart unique_part) {
  const Scene& scene = run.scene;
  if (const std::string why = why_reactions_are_unknown(scene); !why.empty()) return {{}, why};
  if (!run.truth) return {{}, kNoTruth};
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  if (count == 0) return {{}, kNoSamples};
  JointReactions reactions(scene);
  TimeSeries series;
  bool is_anything_unique = false;
  constexpr std::size_t kInstants = 100;
  for (std::size_t n = 0; n < count; n += std::max<std::size_t>(1, count / kInstants)) {
    const Sample& sample = run.trajectory.samples[n];
    const auto unique = reactions.unique_at(run.truth->bodies[n].columns());
    const auto expected = reactions.at(run.truth->bodies[n].columns(), sample.time);
    const auto found = reactions.at(sample.bodies.columns(), sample.time);
    if (!unique || !expected || !found) continue;
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
      const Mat3& counts = (*unique)[k].*unique_part;
      if (counts.isZero(0)) continue;
      is_anything_unique = true;
      const Vec3 mine = counts * ((*found)[k].*part), its = counts * ((*expected)[k].*part);
      const Joint& joint = scene.joints[k];
      series.add((mine - its).norm(), {sample.time, joint.b == kWorld ? joint.a : joint.b,
                                       what + " of " + scene.joint_name(k), mine.norm(), its.norm()});
    }
  }
  if (!is_anything_unique) return {{}, "the equations of motion leave no joint's " + what + " unique"};
  Measurement measurement = std::move(series).finish();
  measurement.series.clear();
  return {std::move(measurement), ""};
}

}  // namespace

MetricRow reaction_error() {
  return {"reaction_error", "N", "largest difference of the force that a joint carries from that at the truth's state",
          [](const JudgedRun& run) {
            return measure_reaction(run, "force", &JointReaction::force, &UniqueReaction::force);
          }};
}

MetricRow reaction_torque_error() {
  return {"reaction_torque_error", "N m",
          "largest difference of the couple that a joint carries, about its point, from that at the truth's state",
          [](const JudgedRun& run) {
            if (!run.scene.joints.empty() && !any_holds_angle(run.scene)) return MetricResult{{}, kNoAngle};
            return measure_reaction(run, "couple", &JointReaction::couple, &UniqueReaction::couple);
          }};
}

}  // namespace rigor
