#include "cases/metrics/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/metrics/measures/energy_in_play.h"
#include "cases/metrics/measures/energy_series.h"
#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/system.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

constexpr double kBlownUp = 10;  // times the energy in play

int liveliest_body(const Scene& scene, BodyColumns bodies) {
  int liveliest = kWorld;
  double most = -1;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double energy = kinetic_energy_of(scene, bodies, i);
    if (energy > most) most = energy, liveliest = static_cast<int>(i);
  }
  return liveliest;
}

std::optional<Stability> energy_explosion(const JudgedRun& run, double largest) {
  const Scene& scene = run.scene;
  const std::vector<double>& energies = energies_of(run, 0).least;
  const bool may_lose = contact_may_lose(scene);
  for (std::size_t n = 0; n < energies.size(); ++n) {
    const double change = energies[n] - energies.front();
    if (is_bounded(change, largest, may_lose)) continue;
    const Sample& sample = run.trajectory.samples[n];
    const int body = liveliest_body(scene, sample.bodies.columns());
    return Stability{Verdict::blown_up, sample.time, body,
                     fmt::format("at {:.4g} s the energy is {:.3g} J from its start, more than {} times the energy "
                                 "in play, {:.3g} J; '{}' has most of it",
                                 sample.time, change, kBlownUp, largest, scene.body_name(body))};
  }
  return {};
}

}  // namespace

bool is_bounded(double change, double energy_in_play, bool may_lose) {
  return may_lose ? change <= kBlownUp * energy_in_play : std::abs(change) <= kBlownUp * energy_in_play;
}

Stability judge_stability(const JudgedRun& run, const std::optional<NotFinite>& not_finite,
                          double largest_kinetic_energy, double largest_energy_change) {
  const double in_play = std::max(largest_kinetic_energy, largest_energy_change);
  if (const auto explosion = energy_explosion(run, in_play)) return *explosion;
  if (!not_finite) return verdict_on(run);
  return {Verdict::blown_up, not_finite->time, not_finite->body,
          fmt::format("at {:.4g} s the state of '{}' is no longer finite", not_finite->time,
                      run.scene.body_name(not_finite->body))};
}

EnergyExtremes energy_extremes(const Scene& scene, const Truth* truth, double duration) {
  // The samples are milliseconds apart in a usual run, so little is missed between two of them, and the value serves as
  // a scale. Losses and gains are slow; every fourth sample shows them.
  constexpr int kSamples = 4096, kEach = 4;
  BodyTable bodies(scene.bodies.size());
  EnergyExtremes found;
  double start = 0;
  for (int n = 0; truth && n <= kSamples; ++n) {
    truth->at(duration * n / kSamples, bodies.columns());
    found.kinetic = std::max(found.kinetic, kinetic_energy(scene, bodies.columns()));
    if (n % kEach != 0) continue;
    const double now = energy(scene, bodies.columns());
    if (n == 0) start = now;
    found.change = std::max(found.change, std::abs(now - start));
  }
  // A truth near an equilibrium, for example a balanced pole, does not show how much energy may come into motion. A
  // body counts as hardly moving below 1/30,000 of the speed that the scene has in play.
  constexpr double kHardlyMoves = 1e-9;  // of the energy
  const double of_scene = energy_in_play(scene, duration);
  constexpr double kStill = 1e-24;  // of the energy: a speed of 1e-12 of the scene's is rounding
  found.is_still = truth && !(found.kinetic > kStill * of_scene);
  if (!(std::max(found.kinetic, found.change) > kHardlyMoves * of_scene)) found.kinetic = of_scene;
  return found;
}

}  // namespace rigor::inline metric
