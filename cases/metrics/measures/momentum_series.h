// Shared code of the momentum metrics: when a momentum is known without a truth, and the comparison with it.
#pragma once

#include <functional>
#include <string>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {

// Why something outside the moving bodies acts on them, besides gravity and timed forces: a spring or joint to the
// world or to a fixed body, or contact with a fixed body. If empty, the forces alone determine the momenta.
std::string why_held_from_outside(const Scene& scene);

// Seconds of [0, t] during which the force acts.
double acting_time(const TimedForce& force, double t);

using MomentumOf = std::function<Vec3(BodyColumns bodies)>;  // of the system, in W
using MomentumGained = std::function<Vec3(double t)>;        // since the start, in W

// The distance from the run's start plus `gained`, over the whole run.
MetricResult against_law(const JudgedRun& run, const std::string& symbol, const MomentumOf& momentum,
                         const MomentumGained& gained);
// The distance from the truth's momentum, up to its horizon; not applicable, because of `why`, without one.
MetricResult against_truth(const JudgedRun& run, const std::string& symbol, const MomentumOf& momentum,
                           const std::string& why);

}  // namespace rigor::inline metric
