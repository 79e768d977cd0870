// (E - E_expected) / scale, from the raw velocities. energy_series.h defines the expected energy and the scale.
#include <cmath>

#include "cases/metrics/measures/energy_series.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_with(const JudgedRun& run, double stagger) {
  const EnergySeries energies = energy_series(run, stagger);
  if (!energies.not_applicable.empty()) return {{}, energies.not_applicable};
  TimeSeries series;
  for (std::size_t n = 0; n < energies.expected.size(); ++n) {
    series.add(std::abs(energies.found[n] - energies.expected[n]) / energies.scale,
               {run.trajectory.samples[n].time, kWorld, "energy", energies.found[n], energies.expected[n]});
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow energy_drift() {
  return {"energy_drift", "1", "largest deviation of the energy, as read, relative to the largest kinetic energy",
          [](const JudgedRun& run) { return measure_with(run, 0); }};
}

MetricRow energy_drift_synchronised() {
  return {"energy_drift_synchronised", "1",
          "the same with the velocities brought to the positions' time: what the scheme itself loses or gains",
          [](const JudgedRun& run) { return measure_with(run, run.leapfrog_stagger); }};
}

}  // namespace rigor::inline metric
