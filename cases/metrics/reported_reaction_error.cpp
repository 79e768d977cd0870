// The difference between the joint loads that an engine reports and the truth's; a user reads them from its feedback.
// The engine's value is the mean over a step, because it holds velocities at the step's end. The truth's value is the
// mean of those at the step's two ends, which is correct to second order. Directions and missing values are those of
// reaction_error.cpp.
#include <algorithm>

#include "cases/metrics/measures/joints/joint_series.h"
#include "cases/metrics/measures/joints/reaction_difference.h"
#include "cases/metrics/measures/joints/reported_at_joint.h"

namespace rigor::inline metric {
namespace {

class ReportedReactions {
 public:
  explicit ReportedReactions(const JudgedRun& run) : run_(run), reactions_(run.scene) {
    for (const Joint& joint : run.scene.joints) geometry_.emplace_back(run.scene, joint);
  }

  // In the step that ends with a sample.
  std::optional<ComparedReactions> at(std::size_t n) {
    const Sample &before = run_.trajectory.samples[n - 1], &sample = run_.trajectory.samples[n];
    const BodyColumns start = run_.truth->bodies[n - 1].columns(), end = run_.truth->bodies[n].columns();
    const auto first = reactions_.at(start, before.time), last = reactions_.at(end, sample.time);
    const auto unique = reactions_.unique();
    if (!unique || !first || !last) return std::nullopt;
    ComparedReactions all{*unique, {}, {}};
    for (std::size_t k = 0; k < geometry_.size(); ++k) {
      const JointReaction &at_start = (*first)[k], &at_end = (*last)[k];
      all.found.push_back(
          reported_at_joint(run_.scene.joints[k], geometry_[k], sample.reactions[k], before.bodies.columns()));
      all.expected.push_back({0.5 * (at_start.force + at_end.force), 0.5 * (at_start.couple + at_end.couple)});
    }
    return all;
  }

 private:
  const JudgedRun& run_;
  JointReactions reactions_;
  std::vector<JointGeometry> geometry_;
};

MetricResult measure_reports(const JudgedRun& run, const ReactionPart& part) {
  if (const std::string why = why_reactions_are_unknown(run.scene); !why.empty()) return {{}, why};
  const std::vector<Sample>& samples = run.trajectory.samples;
  if (!run.truth) return {{}, kNoTruth};
  const auto is_reported = [](const Sample& sample) { return !sample.reactions.empty(); };
  if (samples.size() < 2 || std::none_of(samples.begin(), samples.end(), is_reported))
    return {{}, "the engine does not say what joints carry"};
  constexpr double kOneStep = 1.5;
  if (samples[1].time > kOneStep * run.trajectory.dt) return {{}, "steps are not recorded one by one"};
  std::optional<ReportedReactions> reported;  // made only where something is not known yet
  // The first step is left out. It begins with velocities of its own instant, so an engine that holds them at the ends
  // of steps does not yet carry the loads of rotation.
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  std::vector<std::size_t> compared;
  for (std::size_t n = 2; n < count; ++n) {
    if (is_reported(samples[n])) compared.push_back(n);
  }
  return largest_reaction_difference(run, part, compared, run.reactions.reported, [&](std::size_t n) {
    if (!reported) reported.emplace(run);
    return reported->at(n);
  });
}

}  // namespace

MetricRow reported_reaction_error() {
  return {.name = "reported_reaction_error",
          .unit = "N",
          .summary = "largest difference of the force that the engine says a joint carries from the truth's",
          .measure =
              [](const JudgedRun& run) {
                return measure_reports(run, {"reported force", &JointReaction::force, &UniqueReaction::force});
              },
          .needs = {.truth = true, .reactions = true}};
}

MetricRow reported_reaction_torque_error() {
  return {
      .name = "reported_reaction_torque_error",
      .unit = "N m",
      .summary =
          "largest difference of the couple that the engine says a joint carries, about its point, from the truth's",
      .measure =
          [](const JudgedRun& run) {
            if (!run.scene.joints.empty() && !any_holds_angle(run.scene)) return MetricResult{{}, kNoAngle};
            return measure_reports(run, {"reported couple", &JointReaction::couple, &UniqueReaction::couple});
          },
      .needs = {.truth = true, .reactions = true}};
}

}  // namespace rigor::inline metric
