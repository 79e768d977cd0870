// The largest rise of a run's energy above its lowest earlier value, relative to the energy in play (energy_series.h:
// energy_scale, rises_of). Only a driving force may add energy; an impact, friction or a damper removes it or leaves
// it. A rise is an error of the scheme (overlap pushed out as speed, an impact answered too fast). A fall is not judged
// here, because friction and restitution may cause it.
#include "cases/metrics/measures/energy_series.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_energy_gain(const JudgedRun& run) {
  if (is_driven(run.scene)) return {{}, "forces or motors drive the scene and may add energy"};
  if (run.trajectory.samples.empty()) return {{}, "the run has no finite sample"};
  const double scale = energy_scale(run);
  const std::vector<double>& energies = energies_of(run, 0).least;
  const std::vector<double> rises = rises_of({energies_of(run, 0), energies_of(run, run.leapfrog_stagger)});
  TimeSeries series;
  for (std::size_t n = 0; n < energies.size(); ++n) {
    series.add(rises[n] / scale,
               {run.trajectory.samples[n].time, kWorld, "energy", energies[n], energies[n] - rises[n]});
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow energy_gain() {
  return {.name = "energy_gain",
          .unit = "1",
          .summary = "largest rise of the energy above the lowest before, relative to the largest kinetic energy",
          .measure = measure_energy_gain,
          .needs = {}};
}

}  // namespace rigor::inline metric
