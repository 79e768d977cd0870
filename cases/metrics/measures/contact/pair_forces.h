// Contact forces as resultants of pairs: those that an engine reports, and those that the truth's motion implies. A
// single point's force is indeterminate where two bodies touch at more than three points, and resultants are not.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "cases/metrics/metric.h"

namespace rigor {

// All fixed bodies count as one, kWorld: how they share the load of a body is indeterminate.
using BodyPair = std::pair<int, int>;         // first < second
using PairForces = std::map<BodyPair, Vec3>;  // N on the second, in W, as a mean over the step

PairForces reported_pair_forces(const Scene& scene, const Sample& sample);

// N on each moving body over the step that ends with sample n, by momentum: m dv / dt - m g - the timed forces. It is
// the sum of its contact forces in a scene without springs and joints.
std::vector<Vec3> forces_on_bodies(const Scene& scene, BodyColumns before, BodyColumns after, double t, double dt);

// The forces of touching pairs from the sums on the bodies. Empty if the pairs close a loop, for these sums then leave
// the forces undetermined. `touching` has pairs of moving bodies, and of kWorld with moving bodies.
std::optional<PairForces> pair_forces_of(const std::vector<BodyPair>& touching, std::vector<Vec3> on_bodies);

// Pairs whose surfaces are no farther apart than rounding, by the judge's own geometry.
std::vector<BodyPair> touching_pairs(const Scene& scene, BodyColumns bodies);

// Why a run has no contact forces to judge; empty if it has.
std::string why_no_contacts(const JudgedRun& run);

// What the truth's motion implies for the step that ends with sample n; empty if it is undetermined.
std::optional<PairForces> true_pair_forces(const JudgedRun& run, std::size_t n);

// "force of 'a' on 'b'"
std::string name_of(const Scene& scene, const BodyPair& pair);

}  // namespace rigor
