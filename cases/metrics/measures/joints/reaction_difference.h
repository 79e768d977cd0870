// Shared code of the reaction metrics. Joint loads, from any source, are compared with the truth's in the directions in
// which they are unique. This is done at about a hundred instants, evenly through the run, because a reaction costs a
// hundred times as much as a distance.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/metrics/measures/joints/joint_reactions.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {

// The force or the couple, and its name: "reported force".
struct ReactionPart {
  std::string what;
  Vec3 JointReaction::*of;
  Mat3 UniqueReaction::*unique;
};

// Of all joints.
struct ComparedReactions {
  std::vector<UniqueReaction> unique;
  std::vector<JointReaction> found, expected;
};
// At a sample, by its number; nothing where the equations of motion do not tell.
using CompareReactions = std::function<std::optional<ComparedReactions>(std::size_t sample)>;

// The distance between compared samples, for this many samples.
std::size_t samples_between_reactions(std::size_t samples);

// The values at these sample numbers, with the reason if there is none. `known` values are not computed again.
MetricResult largest_reaction_difference(const JudgedRun& run, const ReactionPart& part,
                                         const std::vector<std::size_t>& samples, ReactionsBySample& known,
                                         const CompareReactions& compare);

}  // namespace rigor::inline metric
