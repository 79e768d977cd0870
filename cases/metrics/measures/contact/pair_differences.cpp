#include "cases/metrics/measures/contact/pair_differences.h"

#include <fmt/format.h>

#include <set>

#include "cases/metrics/measures/contact/true_wrenches.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor {
namespace {

// "moment of a on b" for "moment"
std::string name_of(const JudgedRun& run, const std::string& what, const BodyPair& pair) {
  return what + name_of(run.scene, pair).substr(std::string("force").size());
}

// The pairs whose wrench is not determined in full at some step.
class LeftOut {
 public:
  void add(const BodyPair& pair, const Mat3& counts) {
    if (counts_fully(counts)) return;
    pairs_.insert(pair);
    in_part_ = in_part_ || !counts.isZero(0);
  }
  std::string note(const Scene& scene) const {
    if (pairs_.empty()) return "";
    constexpr std::size_t kNamed = 2;
    std::string names;
    std::size_t count = 0;
    for (const auto& [first, second] : pairs_) {
      if (count++ == kNamed) break;
      names += fmt::format("{}{} on {}", names.empty() ? "" : ", ", scene.body_name(first), scene.body_name(second));
    }
    if (pairs_.size() > kNamed) names += fmt::format(" and {} more", pairs_.size() - kNamed);
    return fmt::format(" (not determined{} at some steps: {})", in_part_ ? ", or in part," : "", names);
  }

 private:
  std::set<BodyPair> pairs_;
  bool in_part_ = false;
};

}  // namespace

MetricResult largest_pair_difference(const JudgedRun& run, const std::string& what, Mat3 DueWrench::*counts,
                                     const DifferenceOfPair& difference) {
  TrueWrenches truth(run);
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  LeftOut left_out;
  TimeSeries series;
  series.add(0, {0, kWorld, what, 0, 0});
  bool is_any = false, is_none_met = true;
  for (std::size_t n = 1; n < count; ++n) {
    const Equilibrium& expected = truth.of_step(n);
    PairWrenches found = reported_pair_wrenches(run, n);
    for (const auto& [pair, due] : expected.pairs) found.try_emplace(pair);
    const double time = run.trajectory.samples[n].time;
    double largest = 0;
    Instant worst{time, kWorld, what, 0, 0};
    for (const auto& [pair, wrench] : found) {
      const DueWrench due = expected.due(pair);
      left_out.add(pair, due.*counts);
      is_none_met = false;
      if ((due.*counts).isZero(0)) continue;
      const std::optional<PairDifference> off = difference({n, pair, wrench, due});
      if (!off) continue;
      is_any = true;
      if (off->size <= largest) continue;
      largest = off->size;
      worst = {time, pair.second, name_of(run, what, pair), off->found, off->expected};
    }
    series.add(largest, worst);
  }
  const std::string note = left_out.note(run.scene);
  if (!is_any && !is_none_met)
    return {{},
            note.empty() ? "no pair of bodies presses on a plane contact"
                         : "the equations of motion determine no pair's " + what};
  Measurement measurement = std::move(series).finish();
  measurement.worst.component += note;
  return {std::move(measurement), ""};
}

std::string why_no_pairs(const JudgedRun& run) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return why;
  if (!run.truth) return kNoTruth;
  if (!run.scene.springs.empty() || !run.scene.joints.empty())
    return "springs or joints hold bodies, and their forces are not among the contacts'";
  return samples_within(run, kTruthNeededPosition) < 2 ? kNoSamples : "";
}

}  // namespace rigor
