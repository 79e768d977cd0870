// The impacts of a recorded run: for each pair of bodies, the instants at which they stop approaching each other. The
// samples before and after are carried to the touch along their own free flight (constant velocities and gravity), so
// that neither the speeds nor the time of an impact depend on where in a step it fell.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "cases/metrics/metric.h"

namespace rigor {

struct ImpactSpeeds {
  double time = 0;    // s, at the touch
  double before = 0;  // m/s, the speed of approach at the touch
  double after = 0;   // m/s, the speed of separation at the touch; 0 if they stay together
};

// By pair (a < b), in order of time. Left out are impacts near a third body, for several impulses may make one speed
// there; of bodies with corners all but the first, for the next may be of another corner; and those slower than a tenth
// of the pair's fastest: a ball that comes to rest makes any number of them, the last of which no finite step resolves.
std::map<std::pair<int, int>, std::vector<ImpactSpeeds>> impacts_of(const Scene& scene, const Trajectory& trajectory,
                                                                    double leapfrog_stagger);

inline constexpr const char* kNoImpact = "no two bodies run into each other";

}  // namespace rigor
