// The difference between the joint loads at the run's own states and those at the truth's, which a designer of bearings
// reads from a simulation. Both follow from the equations of motion (joint_reactions.h). Loads that an engine reports
// are judged in reported_reaction_error.cpp. Each counts in the directions in which it is unique.
#include "cases/metrics/measures/joints/joint_series.h"
#include "cases/metrics/measures/joints/reaction_difference.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_reaction(const JudgedRun& run, const ReactionPart& part) {
  if (const std::string why = why_reactions_are_unknown(run.scene); !why.empty()) return {{}, why};
  if (!run.truth) return {{}, kNoTruth};
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  std::vector<std::size_t> compared;
  for (std::size_t n = 0; n < count; n += samples_between_reactions(count)) compared.push_back(n);
  std::optional<JointReactions> reactions;  // made only where something is not known yet
  const auto compare = [&](std::size_t n) -> std::optional<ComparedReactions> {
    if (!reactions) reactions.emplace(run.scene);
    const Sample& sample = run.trajectory.samples[n];
    const BodyColumns truth = run.truth->bodies[n].columns();
    const auto expected = reactions->at(truth, sample.time);
    const auto unique = reactions->unique();
    const auto found = reactions->at(sample.bodies.columns(), sample.time);
    if (!unique || !expected || !found) return std::nullopt;
    return ComparedReactions{*unique, *found, *expected};
  };
  return largest_reaction_difference(run, part, compared, run.reactions.at_states, compare);
}

}  // namespace

MetricRow reaction_error() {
  return {"reaction_error", "N", "largest difference of the force that a joint carries from that at the truth's state",
          [](const JudgedRun& run) {
            return measure_reaction(run, {"force", &JointReaction::force, &UniqueReaction::force});
          }};
}

MetricRow reaction_torque_error() {
  return {"reaction_torque_error", "N m",
          "largest difference of the couple that a joint carries, about its point, from that at the truth's state",
          [](const JudgedRun& run) {
            if (!run.scene.joints.empty() && !any_holds_angle(run.scene)) return MetricResult{{}, kNoAngle};
            return measure_reaction(run, {"couple", &JointReaction::couple, &UniqueReaction::couple});
          }};
}

}  // namespace rigor::inline metric
