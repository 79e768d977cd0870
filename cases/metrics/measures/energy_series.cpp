#include "cases/metrics/measures/energy_series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cases/metrics/measures/energy_in_play.h"
#include "cases/metrics/measures/joints/limit_bounces.h"
#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/synchronised.h"
#include "core/dynamics/model/energy.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

enum class Exchange { none, contact, damping, driving };

bool is_damped(const Scene& scene) {
  return std::any_of(scene.springs.begin(), scene.springs.end(), [](const Spring& s) { return s.damping != 0; }) ||
         std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) {
           return joint.damping != 0 || (joint.has_limits() && joint.restitution < 1);
         });
}

// A soft contact stores energy that belongs to no body, and gives it back.
bool any_contact_is_soft(const Scene& scene) {
  return anything_can_touch(scene) && any_law(scene, [](const ContactLaw& law) { return law.is_soft(); });
}

Exchange exchange_of(const Scene& scene) {
  if (is_driven(scene)) return Exchange::driving;
  if (contact_may_lose(scene)) return Exchange::contact;
  return is_damped(scene) ? Exchange::damping : Exchange::none;
}

std::vector<double> truths_energies(const JudgedRun& run, std::size_t count) {
  if (count == 0) return {};
  auto& known = run.energies.of_truth;
  if (!known) {
    known.emplace();
    for (const KeptBodies& bodies : run.truth->bodies) known->push_back(energy(run.scene, bodies.columns()));
  }
  return {known->begin(), known->begin() + static_cast<long>(count)};
}

bool stays(const std::vector<double>& energies, double scale) {
  constexpr double kRounding = 1e-9;  // of the energy scale: far above roundings, far below any real loss
  return !energies.empty() && std::all_of(energies.begin(), energies.end(), [&](double e) {
    return std::abs(e - energies.front()) <= kRounding * scale;
  });
}

// The expected energy: any that the bounds admit at the start, plus a known change.
void expect_changes(EnergySeries& series, const EnergyBounds& bounds, const std::vector<double>& changes) {
  for (std::size_t n = 0; n < changes.size(); ++n) {
    const double least = bounds.least.front() + changes[n], most = bounds.most.front() + changes[n];
    series.expected.push_back(std::clamp(std::max(bounds.least[n], least), least, most));
    series.found.push_back(std::clamp(series.expected.back(), bounds.least[n], bounds.most[n]));
    series.unexpected.least.push_back(bounds.least[n] - changes[n]);
    series.unexpected.most.push_back(bounds.most[n] - changes[n]);
  }
}

void expect_no_gain(EnergySeries& series, const EnergyBounds& bounds) {
  const std::vector<double> lowest = lowest_so_far(bounds.most);
  for (std::size_t n = 0; n < lowest.size(); ++n) {
    series.expected.push_back(lowest[n]);
    series.found.push_back(std::max(lowest[n], bounds.least[n]));
  }
  series.only_gains_count = true;
}

}  // namespace

const EnergyBounds& energies_of(const JudgedRun& run, double stagger) {
  const auto [known, is_new] = run.energies.by_stagger.try_emplace(stagger);
  EnergyBounds& found = known->second;
  if (!is_new) return found;
  const Synchroniser synchroniser(run.scene, run.trajectory, stagger);
  BodyTable least, most;
  for (std::size_t n = 0; n < run.trajectory.samples.size(); ++n) {
    least = run.trajectory.samples[n].bodies.columns(), most = least;
    synchroniser.apply_bounds(n, least.columns(), most.columns());
    found.least.push_back(energy(run.scene, std::as_const(least).columns()));
    found.most.push_back(energy(run.scene, std::as_const(most).columns()));
  }
  return found;
}

std::vector<double> lowest_so_far(const std::vector<double>& found) {
  std::vector<double> lowest = found;
  for (std::size_t n = 1; n < lowest.size(); ++n) lowest[n] = std::min(lowest[n - 1], found[n]);
  return lowest;
}

std::vector<double> rises_of(const std::vector<EnergyBounds>& readings) {
  std::vector<double> rises(readings.front().least.size(), std::numeric_limits<double>::infinity());
  for (const EnergyBounds& energies : readings) {
    const std::vector<double> lowest = lowest_so_far(energies.most);
    for (std::size_t n = 0; n < rises.size(); ++n)
      rises[n] = std::min(rises[n], std::max(0.0, energies.least[n] - lowest[n]));
  }
  return rises;
}

// The default law counts even where each pair has its own: that can only make the judgement milder.
bool contact_may_lose(const Scene& scene) {
  if (!anything_can_touch(scene)) return false;
  const auto loses = [](const ContactLaw& law) {
    return law.restitution < 1 || law.friction > 0 || law.resists_turning() || law.is_soft();
  };
  const auto& pairs = scene.contact_pairs;
  return loses(scene.contact_default) || std::any_of(pairs.begin(), pairs.end(), [&](const ContactPair& pair) {
           return pair.law.collides && loses(pair.law);
         });
}

bool is_driven(const Scene& scene) {
  return !scene.forces.empty() || !scene.motors.empty() || any_contact_is_soft(scene);
}

bool may_change_energy(const Scene& scene) { return exchange_of(scene) != Exchange::none; }

double energy_scale(const JudgedRun& run) {
  if (run.truth && run.truth->largest_kinetic_energy > 0) return run.truth->largest_kinetic_energy;
  const auto& samples = run.trajectory.samples;
  return energy_in_play(run.scene, std::max(run.duration, samples.empty() ? 0 : samples.back().time));
}

EnergySeries energy_series(const JudgedRun& run, double stagger) {
  EnergySeries series;
  if (run.trajectory.samples.empty()) {
    series.not_applicable = "the run has no finite sample";
    return series;
  }
  series.scale = energy_scale(run);
  const Exchange exchange = exchange_of(run.scene);
  const EnergyBounds& bounds = energies_of(run, stagger);
  const auto truth = truths_energies(run, samples_within(run, kTruthNeededPosition));
  // A truth that ends before the run does not show that later impacts lose nothing.
  const bool truth_stays = truth.size() == bounds.least.size() && stays(truth, series.scale);
  const bool conserved = exchange == Exchange::none || (exchange == Exchange::contact && truth_stays);
  if (conserved) {
    expect_changes(series, bounds, std::vector<double>(bounds.least.size(), 0));
  } else if (exchange == Exchange::contact || (exchange == Exchange::damping && truth.empty())) {
    expect_no_gain(series, bounds);
  } else if (!truth.empty()) {
    std::vector<double> changes = with_bounces_in_step(run, truth);
    for (double& e : changes) e -= truth.front();
    expect_changes(series, bounds, changes);
  } else {
    series.not_applicable = "forces or motors drive the scene, and there is no truth to say what energy they give it";
  }
  return series;
}

}  // namespace rigor::inline metric
