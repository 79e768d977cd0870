#include "cases/metrics/measures/joints/reaction_difference.h"

#include <algorithm>
#include <utility>

namespace rigor::inline metric {
namespace {

// Of one sample. Whether any joint's part is unique there.
bool add_differences(const JudgedRun& run, const ReactionPart& part, double time, const ComparedReactions& reactions,
                     TimeSeries& series) {
  bool is_any = false;
  for (std::size_t k = 0; k < run.scene.joints.size(); ++k) {
    const Mat3& counts = reactions.unique[k].*part.unique;
    if (counts.isZero(0)) continue;
    is_any = true;
    const Vec3 found = counts * (reactions.found[k].*part.of), expected = counts * (reactions.expected[k].*part.of);
    const Joint& joint = run.scene.joints[k];
    series.add((found - expected).norm(),
               {time, joint.b == kWorld ? joint.a : joint.b, part.what + " of " + run.scene.joint_name(k), found.norm(),
                expected.norm()});
  }
  return is_any;
}

}  // namespace

std::size_t samples_between_reactions(std::size_t samples) {
  constexpr std::size_t kInstants = 100;
  return std::max<std::size_t>(1, samples / kInstants);
}

MetricResult largest_reaction_difference(const JudgedRun& run, const ReactionPart& part,
                                         const std::vector<std::size_t>& samples, ReactionsBySample& known,
                                         const CompareReactions& compare) {
  if (samples.empty()) return {{}, kNoSamples};
  TimeSeries series;
  bool is_any = false;
  for (const std::size_t n : samples) {
    const auto [place, is_new] = known.try_emplace(n);
    auto& reactions = place->second;
    if (is_new) {
      if (auto compared = compare(n)) reactions = std::make_shared<const ComparedReactions>(*std::move(compared));
    }
    if (reactions) is_any |= add_differences(run, part, run.trajectory.samples[n].time, *reactions, series);
  }
  if (!is_any) return {{}, "the equations of motion leave no joint's " + part.what + " unique"};
  Measurement measurement = std::move(series).finish();
  measurement.series.clear();
  return {std::move(measurement), ""};
}

}  // namespace rigor::inline metric
