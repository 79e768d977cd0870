// Drifting: the energy, with the velocities brought to the positions' time, has moved away from what it should be by
// more than 1 % of the largest kinetic energy between the first and the last tenth of what can be compared
// (energy_series.h says what it should be and how far). Means of tenths, because a bounded oscillation of the energy is
// no drift.
#include "cases/metrics/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/metrics/measures/energy_series.h"
#include "cases/metrics/measures/momentum_series.h"
#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/system.h"
#include "core/scene/contact_laws.h"

namespace rigor {
namespace {

constexpr double kBlownUp = 10;     // times the energy in play
constexpr double kDrifting = 0.01;  // of the largest kinetic energy

// Every body sped up straight by gravity and the timed forces on it, and what the springs store on top.
double most_kinetic_energy_from(const Scene& scene, double duration) {
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  Scene springs_alone = scene;
  springs_alone.gravity.setZero();
  double sum = potential_energy(springs_alone, start.columns());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) continue;
    double gained = scene.gravity.norm() * duration;
    for (const TimedForce& force : scene.forces) {
      if (force.body == static_cast<int>(i)) gained += acting_time(force, duration) * force.force.norm() / body.mass;
    }
    const double speed = body.velocity.norm();
    sum += kinetic_energy_of(scene, start.columns(), i) + 0.5 * body.mass * gained * (2 * speed + gained);
  }
  return sum;
}

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

// The mean deviation of the last tenth of the samples less that of the first, in J.
double secular_change(const EnergySeries& energies) {
  const std::size_t count = energies.expected.size(), tenth = std::max<std::size_t>(1, count / 10);
  const auto mean_from = [&](std::size_t first) {
    double sum = 0;
    for (std::size_t n = first; n < first + tenth; ++n) sum += energies.found[n] - energies.expected[n];
    return sum / static_cast<double>(tenth);
  };
  return mean_from(count - tenth) - mean_from(0);
}

Stability drift(const JudgedRun& run, double largest) {
  const EnergySeries energies = energy_series(run, run.leapfrog_stagger);
  if (!energies.not_applicable.empty()) {
    return {Verdict::stable, 0, kWorld,
            "the energy stays bounded; whether it drifts is not known: " + energies.not_applicable};
  }
  const double change = secular_change(energies), share = largest > 0 ? change / largest : 0;
  const Verdict verdict = std::abs(share) > kDrifting ? Verdict::drifting : Verdict::stable;
  return {
      verdict, 0, kWorld,
      fmt::format("from the first to the last tenth of {:.4g} s the energy moved by {:+.3g} % of the largest kinetic "
                  "energy from where it should be",
                  run.trajectory.samples[energies.expected.size() - 1].time, 100 * share)};
}

}  // namespace

bool is_bounded(double change, double energy_in_play, bool may_lose) {
  return may_lose ? change <= kBlownUp * energy_in_play : std::abs(change) <= kBlownUp * energy_in_play;
}

std::string word_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::stable:
      return "stable";
    case Verdict::drifting:
      return "drifting";
    case Verdict::blown_up:
      return "blown up";
  }
  return "";
}

Stability judge_stability(const Scene& scene, const Simulation& run, double largest_kinetic_energy,
                          double leapfrog_stagger, const TruthSamples* truth, double largest_energy_change) {
  const double in_play = std::max(largest_kinetic_energy, largest_energy_change);
  if (const auto explosion = energy_explosion(scene, run.trajectory, in_play)) return *explosion;
  if (run.not_finite) {
    return {Verdict::blown_up, run.not_finite->time, run.not_finite->body,
            fmt::format("at {:.4g} s the state of '{}' is no longer finite", run.not_finite->time,
                        scene.body_name(run.not_finite->body))};
  }
  return drift({scene, run.trajectory, truth, leapfrog_stagger}, largest_kinetic_energy);
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
  return largest > 0 ? largest : most_kinetic_energy_from(scene, duration);
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
