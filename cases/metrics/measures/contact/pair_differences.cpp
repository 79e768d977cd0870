#include "cases/metrics/measures/contact/pair_differences.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "cases/metrics/measures/contact/impacts_at_samples.h"
#include "cases/metrics/measures/contact/true_wrenches.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
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

// What is reported of a pair, and what is due, as means over one step or several.
struct PairMeans {
  PairWrench found;
  DueWrench due;
  int steps = 0;

  PairMeans and_step(const PairWrench& next_found, const DueWrench& next_due) const {
    if (steps == 0) return {next_found, next_due, 1};
    const auto mean = [&](const PairWrench& before, const PairWrench& next) {
      return PairWrench{(steps * before.force + next.force) / (steps + 1),
                        (steps * before.moment + next.moment) / (steps + 1)};
    };
    const auto both = [](const Mat3& before, const Mat3& next) {
      return counts_fully(before) && counts_fully(next) ? before : Mat3::Zero();
    };
    return {mean(found, next_found),
            {mean(due.wrench, next_due.wrench), both(due.force_counts, next_due.force_counts),
             both(due.moment_counts, next_due.moment_counts)},
            steps + 1};
  }
};

// The means of the steps around an impact that falls on a sample; of other steps themselves.
class AroundImpacts {
 public:
  explicit AroundImpacts(const JudgedRun& run) : run_(run) {}

  // Over the step that ends with sample n and those before it that wait for it; none if the pair still waits.
  std::optional<PairMeans> add(std::size_t n, const BodyPair& pair, const PairWrench& found, const DueWrench& due) {
    if (n != known_of_) {
      const auto& samples = run_.trajectory.samples;
      at_sample_ =
          pairs_with_impact_at(run_.scene, run_.truth->bodies[n].columns(), samples[n].time - samples[n - 1].time);
      known_of_ = n;
    }
    PairMeans& means = waiting_[pair];
    means = means.and_step(found, due);
    if (at_sample_.count(pair) > 0) return std::nullopt;
    return waiting_.extract(pair).mapped();
  }

 private:
  const JudgedRun& run_;
  std::map<BodyPair, PairMeans> waiting_;
  std::set<BodyPair> at_sample_;
  std::size_t known_of_ = 0;
};

}  // namespace

MetricResult largest_pair_difference(const JudgedRun& run, const std::string& what, Mat3 DueWrench::*counts,
                                     const DifferenceOfPair& difference) {
  TrueWrenches truth(run);
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  AroundImpacts around_impacts(run);
  LeftOut left_out;
  TimeSeries series;
  series.add(0, {0, kWorld, what, 0, 0});
  bool is_any = false, is_met = false, is_asked = false;
  for (std::size_t n = 1; n < count; ++n) {
    const Equilibrium& expected = truth.of_step(n);
    PairWrenches found = reported_pair_wrenches(run, n);
    for (const auto& [pair, due] : expected.pairs) found.try_emplace(pair);
    const double time = run.trajectory.samples[n].time;
    double largest = 0;
    Instant worst{time, kWorld, what, 0, 0};
    for (const auto& [pair, wrench] : found) {
      is_met = true;
      const std::optional<PairMeans> means = around_impacts.add(n, pair, wrench, expected.due(pair));
      if (!means) continue;
      is_asked = true;
      const DueWrench& due = means->due;
      left_out.add(pair, due.*counts);
      if ((due.*counts).isZero(0)) continue;
      const std::optional<PairDifference> off = difference({n, pair, means->found, due});
      if (!off) continue;
      is_any = true;
      if (off->size <= largest) continue;
      largest = off->size;
      worst = {time, pair.second, name_of(run, what, pair), off->found, off->expected};
    }
    series.add(largest, worst);
  }
  const std::string note = left_out.note(run.scene);
  if (is_met && !is_asked) return {{}, "no contact but for impacts on the last sample"};
  if (!is_any && is_met)
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

}  // namespace rigor::inline metric
