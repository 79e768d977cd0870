// Contact forces as resultants of pairs: those that an engine reports, and the sums that a motion implies. A single
// point's force is indeterminate where two bodies touch at more than three points, and resultants often are not.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {

// A fixed body comes first, else the lower index. The second body moves.
using BodyPair = std::pair<int, int>;
using PairForces = std::map<BodyPair, Vec3>;  // N on the second, in W, as a mean over the step

BodyPair pair_of(const Scene& scene, int a, int b);

PairForces reported_pair_forces(const Scene& scene, const Sample& sample);

// N on each moving body over the step that ends with sample n, by momentum: m dv / dt - m g - the timed forces. It is
// the sum of its contact forces in a scene without springs and joints.
std::vector<Vec3> forces_on_bodies(const Scene& scene, BodyColumns before, BodyColumns after, double t, double dt);

// m/s, in W: how fast b slides along a where they touch, by the velocities of this instant.
Vec3 slip_of(const ReportedContact& contact, BodyColumns bodies);

// Why a run has no contact forces to judge; empty if it has.
std::string why_no_contacts(const JudgedRun& run);

// "force of 'a' on 'b'"
std::string name_of(const Scene& scene, const BodyPair& pair);

}  // namespace rigor::inline metric
