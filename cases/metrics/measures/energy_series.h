// A run's energy over time, and its expected energy: the basis of both energy metrics and of the verdicts on energy.
#pragma once

#include <string>
#include <vector>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {

struct EnergySeries {
  std::vector<double> found, expected;  // J, one for each sample compared
  EnergyBounds unexpected;              // J, the energy less its expected change; empty where only gains count
  double scale = 1;                     // J, the scale of a drift
  bool only_gains_count = false;        // expected: the lowest so far
  std::string not_applicable;           // why there is nothing to expect; empty if there is
};

// `stagger`: the steps by which the velocities are first brought forward, see synchronised.h. 0 takes them as they are
// read.
//
// What is expected, the first that applies:
//   nothing takes or gives energy                        what it was at the start
//   a truth of the whole run whose energy is constant    likewise (an elastic bounce, say)
//   timed forces, or dampers, and a truth                its own start plus the truth's change, up to its horizon;
//                                                        bounces at limits in step (joints/limit_bounces.h)
//   timed forces without a truth                         nothing
//   contact that may lose energy, or dampers             at most the lowest so far: only gains count
// Where the energy has bounds, `found` and `expected` are the nearest values that the bounds admit.
EnergySeries energy_series(const JudgedRun& run, double stagger);

// With the velocities brought forward by `stagger` steps. With 0 steps both bounds are the energy as read.
const EnergyBounds& energies_of(const JudgedRun& run, double stagger);
std::vector<double> lowest_so_far(const std::vector<double>& energies);  // J, the sample itself included

// J, at each sample: the rise of the energy above the lowest before. The smallest over all readings counts. As read, a
// bounce seems to gain the difference between the velocity's time and the position's. Brought forward, an impact may
// seem to gain, because it is no acceleration. A real gain shows in every reading, and above every bound.
std::vector<double> rises_of(const std::vector<EnergyBounds>& readings);

// Whether contact may remove energy: an impact with restitution below 1, or friction, even an infinite one when a body
// slips as it lands.
bool contact_may_lose(const Scene& scene);

// Whether timed forces or motors act.
bool is_driven(const Scene& scene);

// Whether contact, dampers or limits, timed forces or motors may take or give energy.
bool may_change_energy(const Scene& scene);

// J: the scale of an energy change. It is the truth's largest kinetic energy. Without a truth, or if nothing moves in
// it, it is the scene's energy in play (energy_in_play.h) over the run's duration.
double energy_scale(const JudgedRun& run);

}  // namespace rigor::inline metric
