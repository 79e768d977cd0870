// The energy of the motion about the common centre of mass, with that of the springs: E - ½ M V² + M g·X. König's
// theorem parts it from the motion of the centre, which is the same for every run of a scene that nothing outside
// holds. A long fall adds kinetic energy in which a loss of this energy would be too small to see.
#pragma once

#include "cases/metrics/measures/energy_series.h"

namespace rigor::inline metric {

// `stagger`: see energy_series.h. The energy expected is that of the start, and so is the scale. Not applicable where
// something outside holds the bodies, where something takes or gives energy, or where the total says the same.
EnergySeries internal_energy_series(const JudgedRun& run, double stagger);

}  // namespace rigor::inline metric
