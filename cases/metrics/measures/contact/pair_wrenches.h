// The resultant force and moment of a pair's contact points: those that an engine reports, and those that the truth's
// motion implies. Where a pair's force is determined (pair_forces.h), its moment is, too.
#pragma once

#include <map>
#include <optional>

#include "cases/metrics/measures/contact/pair_forces.h"

namespace rigor {

// On the pair's second body, in W, as a mean over the step; the moment is about that body's centre of mass.
struct PairWrench {
  Vec3 force = Vec3::Zero();   // N
  Vec3 moment = Vec3::Zero();  // N m
};
using PairWrenches = std::map<BodyPair, PairWrench>;

// N m about the origin of W on each moving body over a step, by angular momentum: d(R I R'w + x × m v)/dt − x × m g −
// the moments of the timed forces. The mean position over the step is that of a cubic through its ends.
std::vector<Vec3> moments_on_bodies(const Scene& scene, BodyColumns before, BodyColumns after, double t, double dt);

// Of the step that ends with sample n. The arms are those at its start.
PairWrenches reported_pair_wrenches(const JudgedRun& run, std::size_t n);

// What the truth's motion implies for that step; empty if it is undetermined.
std::optional<PairWrenches> true_pair_wrenches(const JudgedRun& run, std::size_t n);

// Why there is none to compare; empty if there is.
std::string why_no_wrenches(const JudgedRun& run);

inline constexpr const char* kLoopOfContacts =
    "the touching bodies form a loop, which leaves their forces undetermined";

}  // namespace rigor
