// A run's energy over time beside what it should be: the ground of both energy metrics and of the verdict "drifting".
#pragma once

#include <string>
#include <vector>

#include "cases/metrics/metric.h"

namespace rigor {

struct EnergySeries {
  std::vector<double> found, expected;  // J, one for each sample compared
  double scale = 1;                     // J, what a drift is relative to
  std::string not_applicable;           // why there is nothing to expect; empty if there is
};

// `lag`: the velocities are first brought forward by that many steps, see synchronised.h; 0 takes them as they are
// read. So they are, too, where forces push what contact brakes: the push alone, without the friction that all but
// balances it, would bring them further from the positions' time than they were.
//
// What is expected, the first that applies:
//   nothing takes or gives energy                        what it was at the start
//   a truth whose energy stays what it was               likewise (an elastic bounce, say)
//   timed forces, or dampers, and a truth                its own start plus the truth's change, up to its horizon
//   timed forces without a truth                         nothing
//   contact that may lose energy, or dampers             not above the lowest so far: only gains count
EnergySeries energy_series(const JudgedRun& run, double lag);

// Whether contact may take energy: an impact below restitution 1 does, and so does friction, even an infinite one when
// a body slips as it lands.
bool contact_may_lose(const Scene& scene);

// Whether contact, dampers or timed forces may take or give energy.
bool may_change_energy(const Scene& scene);

// J: what a change of energy is relative to. The truth's largest kinetic energy; else the run's at the start; else the
// depth to which its potential energy falls, which is what its motion can have come from; else 1 J, for nothing moves.
double energy_scale(const JudgedRun& run);

}  // namespace rigor
