// Contact forces of a scene that stands still. Ripple: the standard deviation of a pair's force over its mean, in the
// second half of the run. Peak: its largest force at any step, over the force that the truth's rest implies.
#include <cmath>

#include "cases/metrics/measures/built_at_rest.h"
#include "cases/metrics/measures/contact/true_wrenches.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

// The force of each pair at rest, where the equations of motion determine it and it is not zero.
struct AtRest {
  PairForces forces;
  const char* note = "";
};

AtRest forces_at_rest(const JudgedRun& run) {
  AtRest found;
  for (const auto& [pair, due] : wrenches_at_rest(run.scene, run.truth->bodies.front().columns()).pairs) {
    if (!counts_fully(due.force_counts)) {
      found.note = " (other pairs are not determined)";
    } else if (!due.wrench.force.isZero(0)) {
      found.forces[pair] = due.wrench.force;
    }
  }
  return found;
}

std::string why_none(const JudgedRun& run) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return why;
  if (!run.truth) return kNoTruth;
  if (!run.scene.springs.empty() || !run.scene.joints.empty()) return "springs or joints hold bodies";
  return why_not_built_at_rest(run);
}

constexpr const char* kUndetermined = "statics determines no pair's force, or all are zero";

MetricResult measure_peak(const JudgedRun& run) {
  if (const std::string why = why_none(run); !why.empty()) return {{}, why};
  const auto [due, note] = forces_at_rest(run);
  if (due.empty()) return {{}, kUndetermined};
  TimeSeries series;
  for (const Sample& sample : run.trajectory.samples) {
    double largest = 0;
    Instant worst{sample.time, kWorld, "force", 0, 0};
    for (const auto& [pair, force] : reported_pair_forces(run.scene, sample)) {
      const auto rest = due.find(pair);
      if (rest == due.end() || force.norm() / rest->second.norm() <= largest) continue;
      largest = force.norm() / rest->second.norm();
      worst = {sample.time, pair.second, name_of(run.scene, pair) + note, force.norm(), rest->second.norm()};
    }
    series.add(largest, worst);
  }
  return {std::move(series).finish(), ""};
}

MetricResult measure_ripple(const JudgedRun& run) {
  if (const std::string why = why_none(run); !why.empty()) return {{}, why};
  const auto [due, note] = forces_at_rest(run);
  if (due.empty()) return {{}, kUndetermined};
  const std::vector<Sample>& samples = run.trajectory.samples;
  const std::size_t first = (samples.size() + 1) / 2;
  double largest = 0;
  Instant worst{samples.back().time, kWorld, "force", 0, 0};
  for (const auto& [pair, rest] : due) {
    double sum = 0, squares = 0;
    std::vector<double> sizes;
    for (std::size_t n = first; n < samples.size(); ++n) {
      const PairForces forces = reported_pair_forces(run.scene, samples[n]);
      const auto found = forces.find(pair);
      sizes.push_back(found == forces.end() ? 0 : found->second.norm());
      sum += sizes.back();
    }
    const double mean = sum / static_cast<double>(sizes.size());
    for (const double size : sizes) squares += (size - mean) * (size - mean);
    const double deviation = std::sqrt(squares / static_cast<double>(sizes.size()));
    // A pair that bears nothing where it should bear a load has no ripple to its mean: the load counts instead.
    const double ripple = mean > 0 ? deviation / mean : 1;
    if (ripple <= largest) continue;
    largest = ripple;
    worst = {samples.back().time, pair.second, name_of(run.scene, pair) + note, mean, rest.norm()};
  }
  TimeSeries series;
  series.add(largest, worst);
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow force_peak() {
  return {.name = "force_peak",
          .unit = "1",
          .summary = "largest contact force of a pair in a scene at rest, over its static force",
          .measure = measure_peak,
          .needs = {.truth = true, .contacts = true}};
}

MetricRow force_ripple() {
  return {.name = "force_ripple",
          .unit = "1",
          .summary = "standard deviation of a pair's contact force over its mean, in a scene at rest",
          .measure = measure_ripple,
          .needs = {.truth = true, .contacts = true}};
}

}  // namespace rigor::inline metric
