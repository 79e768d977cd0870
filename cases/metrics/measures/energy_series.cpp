#include "cases/metrics/measures/energy_series.h"

#include <algorithm>
#include <cmath>

#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/synchronised.h"
#include "core/dynamics/model/energy.h"
#include "core/scene/contact_laws.h"

namespace rigor {
namespace {

enum class Exchange { none, contact, damping, driving };

Exchange exchange_of(const Scene& scene) {
  if (!scene.forces.empty()) return Exchange::driving;
  if (contact_may_lose(scene)) return Exchange::contact;
  const bool damped =
      std::any_of(scene.springs.begin(), scene.springs.end(), [](const Spring& s) { return s.damping != 0; });
  return damped ? Exchange::damping : Exchange::none;
}

std::vector<double> energies(const JudgedRun& run, double lag) {
  Synchroniser synchroniser(run.scene, run.trajectory.dt, lag);
  std::vector<double> found;
  BodyTable bodies;
  for (const Sample& sample : run.trajectory.samples) {
    bodies = sample.bodies.columns();
    synchroniser.apply(sample.time, bodies.columns());
    found.push_back(energy(run.scene, bodies.columns()));
  }
  return found;
}

std::vector<double> truths_energies(const JudgedRun& run, std::size_t count) {
  std::vector<double> energies;
  for (std::size_t n = 0; n < count; ++n) energies.push_back(energy(run.scene, run.truth->bodies[n].columns()));
  return energies;
}

bool stays(const std::vector<double>& energies, double scale) {
  constexpr double kRounding = 1e-9;  // of the energy scale: far above roundings, far below any real loss
  return !energies.empty() && std::all_of(energies.begin(), energies.end(), [&](double e) {
    return std::abs(e - energies.front()) <= kRounding * scale;
  });
}

std::vector<double> lowest_so_far(const std::vector<double>& found) {
  std::vector<double> lowest = found;
  for (std::size_t n = 1; n < lowest.size(); ++n) lowest[n] = std::min(lowest[n - 1], found[n]);
  return lowest;
}

}  // namespace

// The default law counts even where each pair has its own: that can only make the judgement milder.
bool contact_may_lose(const Scene& scene) {
  if (!anything_can_touch(scene)) return false;
  const auto loses = [](const ContactLaw& law) { return law.restitution < 1 || law.friction > 0; };
  const auto& pairs = scene.contact_pairs;
  return loses(scene.contact_default) ||
         std::any_of(pairs.begin(), pairs.end(), [&](const ContactPair& pair) { return loses(pair.law); });
}

bool may_change_energy(const Scene& scene) { return exchange_of(scene) != Exchange::none; }

double energy_scale(const JudgedRun& run) {
  if (run.truth && run.truth->largest_kinetic_energy > 0) return run.truth->largest_kinetic_energy;
  const auto& samples = run.trajectory.samples;
  const double kinetic = kinetic_energy(run.scene, samples.front().bodies.columns());
  if (kinetic > 0) return kinetic;
  const double start = potential_energy(run.scene, samples.front().bodies.columns());
  double lowest = start;
  for (const Sample& sample : samples) {
    lowest = std::min(lowest, potential_energy(run.scene, sample.bodies.columns()));
  }
  return lowest < start ? start - lowest : 1;
}

EnergySeries energy_series(const JudgedRun& run, double lag) {
  EnergySeries series;
  if (run.trajectory.samples.empty()) {
    series.not_applicable = "the run has no finite sample";
    return series;
  }
  series.scale = energy_scale(run);
  const Exchange exchange = exchange_of(run.scene);
  const bool is_lag_known = exchange != Exchange::driving || !contact_may_lose(run.scene);
  series.found = energies(run, is_lag_known ? lag : 0);
  const auto truth = truths_energies(run, samples_within(run, kTruthNeededPosition));
  const bool conserved = exchange == Exchange::none || (exchange == Exchange::contact && stays(truth, series.scale));
  if (conserved) {
    series.expected.assign(series.found.size(), series.found.front());
  } else if (exchange == Exchange::contact || (exchange == Exchange::damping && truth.empty())) {
    series.expected = lowest_so_far(series.found);
  } else if (!truth.empty()) {
    series.found.resize(truth.size());
    for (const double e : truth) series.expected.push_back(series.found.front() + e - truth.front());
  } else {
    series.not_applicable = "forces drive the scene, and there is no truth to say what energy they give it";
  }
  return series;
}

}  // namespace rigor
