// What the metrics of joints' reactions share: what joints carry, found in one way or another, held against the truth's
// in the directions in which it is unique, at a hundred instants or so, evenly through the run: a reaction takes a
// hundred times what a distance does.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/metrics/measures/joints/joint_reactions.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor {

// The force or the couple, and what it is called: "reported force".
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

// From one sample compared to the next, of so many.
std::size_t samples_between_reactions(std::size_t samples);

// At the samples, by their numbers; with the reason where there is none. What is `known` is not compared again.
MetricResult largest_reaction_difference(const JudgedRun& run, const ReactionPart& part,
                                         const std::vector<std::size_t>& samples, ReactionsBySample& known,
                                         const CompareReactions& compare);

}  // namespace rigor
