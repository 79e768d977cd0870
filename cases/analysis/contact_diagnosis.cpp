#include "cases/analysis/contact_diagnosis.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "cases/analysis/metric_over_steps.h"

namespace rigor::inline analysis {
namespace {

std::string how_it_corrects(const Cell& cell) {
  const std::string split = in_its_words(cell, "split impulse threshold");
  return split.empty() ? in_its_words(cell, "erp") : split;
}

// In a pile some balls graze each other. The overlap of a step then changes the normal, which is no error of
// restitution.
bool is_pile(const CaseResult& result) {
  constexpr std::size_t kMostTellable = 60;  // bodies
  return result.definition.scene.bodies.size() > kMostTellable;
}

// Bodies that should stay together separate at a share of their approach speed. A body that keeps more than half of it
// was not stopped at all.
std::optional<Diagnosis> overlap_given_back(const CaseResult& result, const MetricOverSteps& restitution) {
  constexpr double kNotable = 0.02, kMostGivenBack = 0.5;
  for (std::size_t i = restitution.values.size(); i-- > 0;) {
    const Instant& worst = restitution.values[i]->worst;
    if (worst.expected != 0 || worst.found < kNotable || worst.found > kMostGivenBack) continue;
    Diagnosis one =
        diagnosis_of(kOverlapGivenBack, result, restitution, i, worst.found, how_it_corrects(*restitution.cells[i]));
    one.over = {one.over[i]};
    return one;
  }
  return std::nullopt;
}

// The error of a first-order engine falls with dt. Here the error at some finer step exceeds that at the coarsest.
std::optional<Diagnosis> unconverged(const CaseResult& result, const MetricOverSteps& restitution) {
  constexpr double kNotable = 0.05;
  if (restitution.values.size() < 2 || is_pile(result)) return std::nullopt;
  double later = 0;
  std::size_t at = 0;
  for (std::size_t i = 1; i < restitution.values.size(); ++i) {
    if (restitution.values[i]->worst.expected > 0 && restitution.values[i]->value > later)
      later = restitution.values[i]->value, at = i;
  }
  if (later < kNotable || later <= restitution.values.front()->value) return std::nullopt;
  return diagnosis_of(kUnconverged, result, restitution, at, later,
                      in_its_words(*restitution.cells.front(), "restitution"));
}

std::optional<Diagnosis> friction_with_directions(const CaseResult& result, const MetricOverSteps& anisotropy) {
  constexpr double kNotable = 0.1;
  if (anisotropy.values.empty() || anisotropy.values.back()->value < kNotable) return std::nullopt;
  return diagnosis_of(kFrictionDirections, result, anisotropy, anisotropy.values.size() - 1,
                      anisotropy.values.back()->value, in_its_words(*anisotropy.cells.back(), "friction"));
}

// Recovery of an overlap within one step gives an impulse that does not depend on dt: the force goes with 1/dt.
std::optional<Diagnosis> force_spikes(const CaseResult& result, const MetricOverSteps& peak) {
  constexpr double kNotable = 2, kGrowth = 1.5;
  if (peak.values.size() < 2) return std::nullopt;
  std::size_t at = 0;
  for (std::size_t i = 1; i < peak.values.size(); ++i)
    if (peak.values[i]->value > peak.values[at]->value) at = i;
  const double largest = peak.values[at]->value;
  if (at == 0 || largest < kNotable || largest < kGrowth * peak.values.front()->value) return std::nullopt;
  return diagnosis_of(kForceSpikes, result, peak, at, largest, how_it_corrects(*peak.cells[at]));
}

// At the finest step, where settling is least. A body that has settled was farthest from its place before the end.
std::optional<Diagnosis> creeping(const CaseResult& result, const MetricOverSteps& creep) {
  constexpr double kNotable = 1e-3, kAtEnd = 0.95;  // of the body's bounding radius; of the duration
  if (creep.values.empty()) return std::nullopt;
  const MetricValue& finest = *creep.values.back();
  const auto& bodies = result.definition.scene.bodies;
  if (finest.worst.body < 0 || finest.worst.time < kAtEnd * result.definition.duration) return std::nullopt;
  const Body& body = bodies[static_cast<std::size_t>(finest.worst.body)];
  if (!body.shape || finest.value < kNotable * bounding_radius(*body.shape)) return std::nullopt;
  const std::string stiffness = in_its_words(*creep.cells.back(), "impratio");
  return diagnosis_of(kCreeps, result, creep, creep.values.size() - 1, finest.value,
                      stiffness.empty() ? how_it_corrects(*creep.cells.back()) : stiffness);
}

// A body that leaves again within the step of its impact has a gap, too: scenes that bounce are left out.
std::optional<Diagnosis> hovering(const CaseResult& result, const MetricOverSteps& hover) {
  constexpr double kNotable = 0.01, kFall = 0.5;  // of the smallest moving body; of the gap at the coarsest step
  const Scene& scene = result.definition.scene;
  if (hover.values.size() < 2 || any_law(scene, [](const ContactLaw& law) { return law.restitution > 0; }))
    return std::nullopt;
  double size = std::numeric_limits<double>::infinity();
  for (const Body& body : scene.bodies)
    if (body.shape && !body.fixed) size = std::min(size, bounding_radius(*body.shape));
  const double coarse = hover.values.front()->value;
  if (!(coarse >= kNotable * size) || hover.values.back()->value > kFall * coarse) return std::nullopt;
  return diagnosis_of(kHovers, result, hover, 0, coarse, in_its_words(*hover.cells.front(), "contacts"));
}

// Forces that are reported in full explain the motion to rounding. In single precision PhysX leaves 4e-7 of the weight
// of a box at rest.
std::optional<Diagnosis> forces_missing(const CaseResult& result, const MetricOverSteps& balance) {
  constexpr double kNotable = 0.01;  // of the largest weight
  const Scene& scene = result.definition.scene;
  double weight = 0;
  for (const Body& body : scene.bodies)
    if (!body.fixed) weight = std::max(weight, body.mass * scene.gravity.norm());
  if (balance.empty() || weight == 0) return std::nullopt;
  const double least = std::min(balance.values.front()->value, balance.values.back()->value);
  if (!(least > kNotable * weight)) return std::nullopt;
  return diagnosis_of(kForcesMissing, result, balance, balance.values.size() - 1, balance.values.back()->value,
                      in_its_words(*balance.cells.back(), "contact forces"));
}

}  // namespace

std::vector<Diagnosis> contact_diagnoses(const CaseResult& result) {
  std::vector<Diagnosis> all;
  for (const std::size_t run : runs_of(result)) {
    const MetricOverSteps restitution = metric_over_steps(result, run, "restitution_error");
    auto impacts = overlap_given_back(result, restitution);
    if (!impacts) impacts = unconverged(result, restitution);
    if (impacts) all.push_back(std::move(*impacts));
    auto friction = friction_with_directions(result, metric_over_steps(result, run, "friction_anisotropy"));
    if (friction) all.push_back(std::move(*friction));
    auto spikes = force_spikes(result, metric_over_steps(result, run, "force_peak"));
    if (spikes) all.push_back(std::move(*spikes));
    auto creep = creeping(result, metric_over_steps(result, run, "creep"));
    if (creep) all.push_back(std::move(*creep));
    auto hover = hovering(result, metric_over_steps(result, run, "hover"));
    if (hover) all.push_back(std::move(*hover));
    auto missing = forces_missing(result, metric_over_steps(result, run, "contact_balance"));
    if (missing) all.push_back(std::move(*missing));
  }
  return all;
}

}  // namespace rigor::inline analysis
