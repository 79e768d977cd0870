#include "cases/metrics/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/metrics/measures/energy_in_play.h"
#include "cases/metrics/measures/energy_series.h"
#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/system.h"
#include "core/scene/contact_laws.h"

namespace rigor {
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

std::optional<Stability> energy_explosion(const Scene& scene, const Trajectory& trajectory, double largest) {
  if (trajectory.samples.empty()) return {};
  const double start = energy(scene, trajectory.samples.front().bodies.columns());
  const bool may_lose = contact_may_lose(scene);
  for (const Sample& sample : trajectory.samples) {
    const BodyColumns bodies = sample.bodies.columns();
    const double change = energy(scene, bodies) - start;
    if (is_bounded(change, largest, may_lose)) continue;
    const int body = liveliest_body(scene, bodies);
    return Stability{Verdict::blown_up, sample.time, body,
                     fmt::format("at {:.4g} s the energy is {:.3g} J from its start, more than {} times the energy "
                                 "in play, {:.3g} J; '{}' has most of it",
                                 sample.time, change, kBlownUp, largest, scene.body_name(body))};
  }
  return {};
}

}

}  // namespace

bool is_bounded(double change, double energy_in_play, bool may_lose) {
  return may_lose ? change <= kBlownUp * energy_in_play : std::abs(change) <= kBlownUp * energy_in_play;
}

Stability judge_stability(const JudgedRun& run, const std::optional<NotFinite>& not_finite,
                          double largest_kinetic_energy, double largest_energy_change) {
  const double in_play = std::max(largest_kinetic_energy, largest_energy_change);
  if (const auto explosion = energy_explosion(run.scene, run.trajectory, in_play)) return *explosion;
  if (!not_finite) return verdict_on(run);
  return {Verdict::blown_up, not_finite->time, not_finite->body,
          fmt::format("at {:.4g} s the state of '{}' is no longer finite", not_finite->time,
                      run.scene.body_name(not_finite->body))};
}

double largest_kinetic_energy(const Scene& scene, const Truth* truth, double duration) {
  // Milliseconds apart over a usual run: between two samples little is missed, and it serves as a scale.
  constexpr int kSamples = 4096;
  BodyTable bodies(scene.bodies.size());
  double largest = 0;
  for (int n = 0; truth && n <= kSamples; ++n) {
    truth->at(duration * n / kSamples, bodies.columns());
    largest = std::max(largest, kinetic_energy(scene, bodies.columns()));
  }
  return largest > 0 ? largest : energy_in_play(scene, duration);
}

double largest_energy_change(const Scene& scene, const Truth* truth, double duration) {
  if (!truth) return 0;
  constexpr int kSamples = 1024;  // losses and gains take their time; nothing is missed between two of them
  BodyTable bodies(scene.bodies.size());
  double start = 0, largest = 0;
  for (int n = 0; n <= kSamples; ++n) {
    truth->at(duration * n / kSamples, bodies.columns());
    const double now = energy(scene, bodies.columns());
    if (n == 0) start = now;
    largest = std::max(largest, std::abs(now - start));
  }
  return largest;
}

}  // namespace rigor
