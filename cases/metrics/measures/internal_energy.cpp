#include "cases/metrics/measures/internal_energy.h"

#include "cases/metrics/measures/momentum_series.h"
#include "cases/metrics/measures/synchronised.h"
#include "core/dynamics/model/energy.h"

namespace rigor::inline metric {
namespace {

double moving_mass(const Scene& scene) {
  double sum = 0;
  for (const Body& body : scene.bodies) sum += body.fixed ? 0 : body.mass;
  return sum;
}

std::string why_no_internal_energy(const JudgedRun& run) {
  const Scene& scene = run.scene;
  if (run.trajectory.samples.empty()) return "the run has no finite sample";
  if (const std::string why = why_held_from_outside(scene); !why.empty()) return why;
  if (may_change_energy(scene)) return "contact, dampers, limits, forces or motors may change it";
  if (!(moving_mass(scene) > 0)) return "no body moves";
  const Vec3 momentum = linear_momentum(scene, run.trajectory.samples.front().bodies.columns());
  if (scene.gravity.isZero(0) && momentum.isZero(0)) return "the centre of mass rests: energy_drift says the same";
  return "";
}

}  // namespace

EnergySeries internal_energy_series(const JudgedRun& run, double stagger) {
  EnergySeries series;
  series.not_applicable = why_no_internal_energy(run);
  if (!series.not_applicable.empty()) return series;
  Scene weightless = run.scene;
  weightless.gravity.setZero();
  const double mass = moving_mass(run.scene);
  const Synchroniser synchroniser(run.scene, run.trajectory, stagger);
  BodyTable bodies;
  for (std::size_t n = 0; n < run.trajectory.samples.size(); ++n) {
    bodies = run.trajectory.samples[n].bodies.columns();
    synchroniser.apply(n, bodies.columns());
    const BodyColumns now = static_cast<const BodyTable&>(bodies).columns();
    series.found.push_back(energy(weightless, now) - 0.5 * linear_momentum(weightless, now).squaredNorm() / mass);
  }
  constexpr double kTrace = 1e-9;  // of the energy in play: less is rounding
  series.scale = series.found.front();
  if (!(series.scale > kTrace * energy_scale(run)))
    series.not_applicable = "nothing moves about the centre of mass, and no spring is tense";
  series.expected.assign(series.found.size(), series.found.front());
  series.unexpected = {series.found, series.found};
  return series;
}

}  // namespace rigor::inline metric
