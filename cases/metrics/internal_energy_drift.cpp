// |E_int - E_int(0)|/E_int(0) of the energy about the common centre of mass (internal_energy.h), with the velocities at
// the positions' time. It shows a loss that the kinetic energy of a long fall would hide.
#include <cmath>

#include "cases/metrics/measures/internal_energy.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_internal_energy_drift(const JudgedRun& run) {
  const EnergySeries energies = internal_energy_series(run, run.leapfrog_stagger);
  if (!energies.not_applicable.empty()) return {{}, energies.not_applicable};
  TimeSeries series;
  for (std::size_t n = 0; n < energies.found.size(); ++n) {
    series.add(std::abs(energies.found[n] - energies.expected[n]) / energies.scale,
               {run.trajectory.samples[n].time, kWorld, "internal energy", energies.found[n], energies.expected[n]});
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow internal_energy_drift() {
  return {.name = "internal_energy_drift",
          .unit = "1",
          .summary = "largest deviation of the energy about the centre of mass, relative to that of the start",
          .measure = measure_internal_energy_drift,
          .needs = {}};
}

}  // namespace rigor::inline metric
