// The most that a run's energy ever rises above the lowest it has had before, relative to the largest kinetic energy.
// Nothing but a driving force may add energy: an impact or friction takes it or leaves it, and so does a damper. What
// rises is the scheme's doing (overlap pushed out as speed, an impact answered too fast); what falls is not judged
// here, for friction and restitution may well ask for it. The velocities are brought to the positions' time first.
#include <algorithm>
#include <limits>

#include "cases/metrics/measures/energy_series.h"
#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/synchronised.h"
#include "core/dynamics/model/energy.h"

namespace rigor {
namespace {

MetricResult measure(const JudgedRun& run) {
  if (!run.scene.forces.empty()) return {{}, "forces drive the scene and may add energy"};
  if (run.trajectory.samples.empty()) return {{}, "the run has no finite sample"};
  const double scale = energy_scale(run);
  Synchroniser synchroniser(run.scene, run.trajectory.dt, run.leapfrog_stagger);
  double lowest = std::numeric_limits<double>::infinity();
  TimeSeries series;
  BodyTable bodies;
  for (const Sample& sample : run.trajectory.samples) {
    bodies = sample.bodies.columns();
    synchroniser.apply(sample.time, bodies.columns());
    const double now = energy(run.scene, bodies.columns());
    lowest = std::min(lowest, now);
    series.add((now - lowest) / scale, {sample.time, kWorld, "energy", now, lowest});
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow energy_gain() {
  return {"energy_gain", "1",
          "largest rise of the energy above the lowest before, relative to the largest kinetic energy", measure};
}

}  // namespace rigor
