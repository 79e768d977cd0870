// A run's energy over time beside what it should be: the ground of both energy metrics and of the verdicts on energy.
#pragma once

#include <string>
#include <vector>

#include "cases/metrics/metric.h"

namespace rigor {

struct EnergySeries {
  std::vector<double> found, expected;  // J, one for each sample compared
  double scale = 1;                     // J, what a drift is relative to
  bool only_gains_count = false;        // expected: the lowest so far
  std::string not_applicable;           // why there is nothing to expect; empty if there is
};

// `stagger`: the velocities are first brought forward by that many steps, see synchronised.h; 0 takes them as they are
// read. So they are, too, where forces push what contact brakes: the push alone, without the friction that all but
// balances it, would bring them further from the positions' time than they were.
//
// What is expected, the first that applies:
//   nothing takes or gives energy                        what it was at the start
//   a truth whose energy stays what it was               likewise (an elastic bounce, say)
//   timed forces, or dampers, and a truth                its own start plus the truth's change, up to its horizon;
//                                                        bounces at limits in step (joints/limit_bounces.h)
//   timed forces without a truth                         nothing
//   contact that may lose energy, or dampers             not above the lowest so far: only gains count
EnergySeries energy_series(const JudgedRun& run, double stagger);

// J, at each sample, with the velocities brought forward by `stagger` steps.
const std::vector<double>& energies_of(const JudgedRun& run, double stagger);
std::vector<double> lowest_so_far(const std::vector<double>& energies);  // J, the sample itself included

// J, at each sample: by how much the energy has risen above the lowest before, in both of its readings, whichever says
// less. As read, a bounce seems to gain what lies between the velocity's time and the position's; brought forward by
// the free acceleration, so does a body that comes to rest on another, which holds it. No real gain is missed by
// either.
std::vector<double> rises_of(const std::vector<double>& as_read, const std::vector<double>& synchronised);

// Whether contact may take energy: an impact below restitution 1 does, and so does friction, even an infinite one when
// a body slips as it lands.
bool contact_may_lose(const Scene& scene);

// Whether timed forces or motors act.
bool is_driven(const Scene& scene);

// Whether contact, dampers or limits, timed forces or motors may take or give energy.
bool may_change_energy(const Scene& scene);

// J: what a change of energy is relative to: the truth's largest kinetic energy; without one, or where nothing moves in
// it, what the scene has in play (energy_in_play.h) over the run's duration.
double energy_scale(const JudgedRun& run);

}  // namespace rigor
