// The resultant force and moment of a pair's contact points that an engine reports, and the sums of moments that a
// motion implies.
#pragma once

#include <map>

#include "cases/metrics/measures/contact/pair_forces.h"

namespace rigor::inline metric {

// On the pair's second body, in W, as a mean over the step; the moment is about that body's centre of mass.
struct PairWrench {
  Vec3 force = Vec3::Zero();   // N
  Vec3 moment = Vec3::Zero();  // N m
};
using PairWrenches = std::map<BodyPair, PairWrench>;

// m, over a step: that of a cubic through its ends.
Vec3 mean_position(BodyColumns before, BodyColumns after, std::size_t body, double dt);

// N m about the origin of W on each moving body over a step, by angular momentum: d(R I R'w + x × m v)/dt − x × m g −
// the moments of the timed forces.
std::vector<Vec3> moments_on_bodies(const Scene& scene, BodyColumns before, BodyColumns after, double t, double dt);

// Of the step that ends with sample n. The arms are those at its start.
PairWrenches reported_pair_wrenches(const JudgedRun& run, std::size_t n);

}  // namespace rigor::inline metric
