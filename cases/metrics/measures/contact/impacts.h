// The impacts of a recorded run: for each pair of bodies, the instants at which they stop approaching each other. The
// samples before and after are extrapolated to the contact along their own free flight (constant velocities and
// gravity). The speeds and the time of an impact thus do not depend on its position inside a step.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {

struct ImpactSpeeds {
  double time = 0;    // s, at the touch
  double before = 0;  // m/s, the speed of approach at the touch
  double after = 0;   // m/s, the speed of separation at the touch; 0 if they stay together
};

// By pair (a < b), in order of time. Four kinds of impacts are left out:
// - those near a third body, because several impulses may add up to one speed;
// - of bodies with corners all but the first, because the next may be of another corner;
// - those slower than a tenth of the pair's fastest. A ball that comes to rest makes any number of them, and no finite
//   step resolves the last.
// - those that touch no faster than three times the speed that gravity adds between two samples. A body at rest gets
//   two thirds of that within the two samples in which its contact is resolved, and roundings would decide whether it
//   has an impact.
// No rounding decides what counts: speeds and gaps that a whole number of steps leaves lie away from every threshold.
std::map<std::pair<int, int>, std::vector<ImpactSpeeds>> impacts_of(const Scene& scene, const Trajectory& trajectory,
                                                                    double leapfrog_stagger);

inline constexpr const char* kNoImpact = "no two bodies run into each other";

}  // namespace rigor::inline metric
