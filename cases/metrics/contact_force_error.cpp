// The difference between the contact force that an engine reports for a pair and the one that the truth's motion
// implies (pair_forces.h). Both are means over a step.
#include "cases/metrics/measures/contact/pair_forces.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor {
namespace {

constexpr const char* kHeldOtherwise = "springs or joints hold bodies, and their forces are not among the contacts'";

MetricResult measure_force_error(const JudgedRun& run) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return {{}, why};
  if (!run.truth) return {{}, kNoTruth};
  if (!run.scene.springs.empty() || !run.scene.joints.empty()) return {{}, kHeldOtherwise};
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  if (count < 2) return {{}, kNoSamples};
  TimeSeries series;
  series.add(0, {0, kWorld, "force", 0, 0});
  for (std::size_t n = 1; n < count; ++n) {
    const Sample& sample = run.trajectory.samples[n];
    const std::optional<PairForces> expected = true_pair_forces(run, n);
    if (!expected) return {{}, "the touching bodies form a loop, which leaves their forces undetermined"};
    PairForces found = reported_pair_forces(run.scene, sample);
    for (const auto& [pair, force] : *expected) found.try_emplace(pair, Vec3::Zero());
    double largest = 0;
    Instant worst{sample.time, kWorld, "force", 0, 0};
    for (const auto& [pair, force] : found) {
      const auto due = expected->find(pair);
      const Vec3 wanted = due == expected->end() ? Vec3::Zero() : due->second;
      const double error = (force - wanted).norm();
      if (error <= largest) continue;
      largest = error;
      worst = {sample.time, pair.second, name_of(run.scene, pair), force.norm(), wanted.norm()};
    }
    series.add(largest, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow contact_force_error() {
  return {.name = "contact_force_error",
          .unit = "N",
          .summary = "largest difference of a pair's reported contact force from that which the truth's motion implies",
          .measure = measure_force_error,
          .needs = {.truth = true, .contacts = true}};
}

}  // namespace rigor
