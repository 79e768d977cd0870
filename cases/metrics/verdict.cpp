#include "cases/metrics/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "cases/metrics/measures/built_at_rest.h"
#include "cases/metrics/measures/contact/overlaps.h"
#include "cases/metrics/measures/contact/tunnelling.h"
#include "cases/metrics/measures/energy_series.h"
#include "cases/metrics/measures/internal_energy.h"
#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/shape_gap.h"
#include "core/base/error.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

// Relative to the energy in play. A drift must exceed the random variation of the means of tenths. A rise is in both
// readings of the energy, whose only noise is rounding. Half of that is reported, which two digits of a verdict show.
constexpr double kMoved = 0.01, kRisen = 0.005;

constexpr Verdict kVerdicts[] = {Verdict::stable,    Verdict::drifting,  Verdict::overlapping, Verdict::gaining,
                                 Verdict::collapsed, Verdict::tunnelled, Verdict::blown_up};

double mean_of(const std::vector<double>& values, std::size_t first, std::size_t count) {
  return std::accumulate(values.begin() + static_cast<long>(first), values.begin() + static_cast<long>(first + count),
                         0.0) /
         static_cast<double>(count);
}

std::size_t tenth_of(const std::vector<double>& values) { return std::max<std::size_t>(1, values.size() / 10); }

// Bounded oscillations average out.
std::vector<double> means_of_tenths(const std::vector<double>& values) {
  const std::size_t tenth = tenth_of(values);
  std::vector<double> means;
  for (std::size_t first = 0; first + tenth <= values.size(); first += tenth)
    means.push_back(mean_of(values, first, tenth));
  return means;
}

// J, from the mean of the first tenth to the mean of the last. Of all changes that the bounds admit, the smallest.
double least_change(const EnergyBounds& energies) {
  const std::size_t tenth = tenth_of(energies.least), last = energies.least.size() - tenth;
  const double from = mean_of(energies.least, 0, tenth), to = mean_of(energies.least, last, tenth),
               most_from = mean_of(energies.most, 0, tenth), most_to = mean_of(energies.most, last, tenth);
  return to > most_from ? to - most_from : most_to < from ? most_to - from : 0;
}

// Drifting or not, where the energy should be something. Means of tenths, because a bounded oscillation of the energy
// is no drift.
Stability drift(const JudgedRun& run, const EnergySeries& energies, const char* which = "energy") {
  const bool is_known = energies.unexpected.least == energies.unexpected.most;
  const double share = least_change(energies.unexpected) / energies.scale,
               time = run.trajectory.samples[energies.found.size() - 1].time;
  const Verdict verdict = std::abs(share) > kMoved ? Verdict::drifting : Verdict::stable;
  return {verdict, 0, kWorld,
          fmt::format("from the first to the last tenth of {:.4g} s the {} moved by {}{:+.3g} % of the {:.3g} J in "
                      "play from where it should be",
                      time, which, is_known ? "" : "at least ", 100 * share, energies.scale),
          share};
}

// Gaining or not, at any sample. Springs make the energy of a symplectic step oscillate: there means of tenths are
// compared.
Stability gain(const JudgedRun& run, double scale) {
  std::vector<EnergyBounds> readings = {energies_of(run, 0), energies_of(run, run.leapfrog_stagger)};
  const auto& joints = run.scene.joints;
  const bool oscillates =
      !run.scene.springs.empty() ||
      std::any_of(joints.begin(), joints.end(), [](const Joint& joint) { return joint.stiffness != 0; });
  for (EnergyBounds& energies : readings) {
    if (oscillates) energies = {means_of_tenths(energies.least), means_of_tenths(energies.most)};
  }
  const std::vector<double> rises = rises_of(readings);
  const auto most = std::max_element(rises.begin(), rises.end());
  const std::size_t samples_each = run.trajectory.samples.size() / rises.size(),
                    sample = samples_each * static_cast<std::size_t>(most - rises.begin() + 1) - 1;
  const double share = *most / scale, time = run.trajectory.samples[sample].time;
  return {share > kRisen ? Verdict::gaining : Verdict::stable, time, kWorld,
          fmt::format("nothing drives the energy, and by {:.4g} s it has risen by {:.3g} % of the {:.3g} J in play",
                      time, 100 * share, scale),
          share};
}

// m, of overlap that a pair may have: with a fixed body the thickness of the thinner of the two; of two that move, half
// of that, so that none has its middle inside the other.
double deepest_allowed(const Body& a, const Body& b) {
  const double thinner = std::min(inradius(*a.shape), inradius(*b.shape));
  return a.fixed || b.fixed ? 2 * thinner : thinner;
}

int mover_of(const Scene& scene, int a, int b) { return scene.bodies[a].fixed ? b : a; }

std::optional<Stability> overlapping(const JudgedRun& run) {
  const Scene& scene = run.scene;
  if (!anything_can_touch(scene)) return {};
  const Overlaps overlaps(scene);
  std::optional<Stability> worst;
  double most = 1;  // relative to the allowed value
  for (const Sample& sample : run.trajectory.samples) {
    overlaps.visit(sample.bodies.columns(), [&](const Overlap& found) {
      const double share = found.depth / deepest_allowed(scene.bodies[found.a], scene.bodies[found.b]);
      if (!(share > most)) return;
      most = share;
      const int mover = mover_of(scene, found.a, found.b), other = mover == found.a ? found.b : found.a;
      worst = {Verdict::overlapping, sample.time, mover,
               fmt::format("at {:.4g} s '{}' and '{}' overlap by {:.3g} m", sample.time, scene.bodies[mover].name,
                           scene.bodies[other].name, found.depth),
               found.depth};
    });
  }
  return worst;
}

std::optional<Stability> tunnelled(const JudgedRun& run) {
  const Scene& scene = run.scene;
  Tunnelling tunnelling(scene);
  const auto& samples = run.trajectory.samples;
  for (std::size_t n = 0; tunnelling.is_possible() && n < samples.size(); ++n) {
    const bool is_step = n > 0 && samples[n].time - samples[n - 1].time < 1.5 * run.trajectory.dt;
    const auto passage = tunnelling.go_on(samples[n].time, samples[n].bodies.columns(), is_step);
    if (!passage) continue;
    const int mover = mover_of(scene, passage->a, passage->b), other = mover == passage->a ? passage->b : passage->a;
    return Stability{Verdict::tunnelled, passage->time, mover,
                     fmt::format("by {:.4g} s '{}' has passed through '{}'", passage->time, scene.bodies[mover].name,
                                 scene.bodies[other].name)};
  }
  return {};
}

std::optional<Stability> collapsed(const JudgedRun& run) {
  if (!run.truth || !why_not_built_at_rest(run).empty()) return {};
  const auto fell = collapse_of(run);
  const std::size_t known = samples_within(run, kTruthNeededPosition);
  if (!fell || known == 0 || fell->time > run.trajectory.samples[known - 1].time) return {};
  return Stability{Verdict::collapsed, fell->time, fell->body,
                   fmt::format("it was built to stand, and at {:.4g} s '{}' is {:.3g} m away from its place",
                               fell->time, run.scene.body_name(fell->body), fell->found)};
}

// The word is the worst of them; the sentence lists the others.
Stability worst_of(std::vector<Stability> found) {
  std::stable_sort(found.begin(), found.end(),
                   [](const Stability& a, const Stability& b) { return a.verdict > b.verdict; });
  Stability worst = found.front();
  for (std::size_t i = 1; i < found.size(); ++i) worst.why += "; " + found[i].why;
  return worst;
}

}  // namespace

std::string word_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::stable:
      return "stable";
    case Verdict::drifting:
      return "drifting";
    case Verdict::overlapping:
      return "overlapping";
    case Verdict::gaining:
      return "gaining";
    case Verdict::collapsed:
      return "collapsed";
    case Verdict::tunnelled:
      return "tunnelled";
    case Verdict::blown_up:
      return "blown up";
  }
  return "";
}

Verdict verdict_of(const std::string& word) {
  for (const Verdict verdict : kVerdicts) {
    if (word_of(verdict) == word) return verdict;
  }
  throw InputError("no such verdict: " + word);
}

std::string phrase_of(const Stability& stability) {
  const std::string word = word_of(stability.verdict);
  switch (stability.verdict) {
    case Verdict::gaining:
      return stability.amount < 1 ? fmt::format("{} {:.2g} %", word, 100 * stability.amount)
                                  : fmt::format("{} {:.0f} %", word, 100 * stability.amount);
    case Verdict::overlapping:
      return fmt::format("{} {:.2g} m", word, stability.amount);
    case Verdict::collapsed:
    case Verdict::tunnelled:
    case Verdict::blown_up:
      return fmt::format("{} {:.2f} s", word, stability.time);
    default:
      return word;
  }
}

Stability verdict_on(const JudgedRun& run) {
  const EnergySeries energies = energy_series(run, run.leapfrog_stagger);
  std::vector<Stability> found;
  if (!energies.not_applicable.empty()) {
    found.push_back({Verdict::stable, 0, kWorld,
                     "the energy stays bounded; whether it drifts is not known: " + energies.not_applicable});
  } else {
    if (!energies.only_gains_count) found.push_back(drift(run, energies));
    if (!is_driven(run.scene) && (energies.only_gains_count || anything_can_touch(run.scene)))
      found.push_back(gain(run, energies.scale));
  }
  const EnergySeries internal = internal_energy_series(run, run.leapfrog_stagger);
  if (internal.not_applicable.empty()) found.push_back(drift(run, internal, "energy about the centre of mass"));
  if (const auto overlap = overlapping(run)) found.push_back(*overlap);
  if (const auto fall = collapsed(run)) found.push_back(*fall);
  if (const auto passage = tunnelled(run)) found.push_back(*passage);
  return worst_of(found);
}

}  // namespace rigor::inline metric
