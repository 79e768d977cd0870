#include "cases/results/results.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace rigor::inline results {
namespace {
// In the order of the enumeration.
constexpr const char* kStatusWords[] = {"pass",     "fail",    "known-deviation", "unexpected-pass", "unsupported",
                                        "diverged", "crashed", "timed-out",       "invalid"};
constexpr const char* kAnswerWords[] = {"held",        "failed", "not checked", "known deviation", "unexpected pass",
                                        "not recorded"};
}  // namespace

std::string word_of(Status status) { return kStatusWords[static_cast<int>(status)]; }

Status status_of(const std::string& word) {
  const auto found = std::find(std::begin(kStatusWords), std::end(kStatusWords), word);
  if (found == std::end(kStatusWords)) throw std::runtime_error("no such status: " + word);
  return static_cast<Status>(found - std::begin(kStatusWords));
}

MetricValue condensed(const MetricResult& result, const Trajectory& trajectory) {
  MetricValue out;
  out.not_applicable = result.not_applicable;
  if (!result.measurement) return out;
  const Measurement& measured = *result.measurement;
  if (measured.series.empty()) out.first_second = std::numeric_limits<double>::quiet_NaN();
  out.value = measured.value, out.worst = measured.worst, out.compared_until = measured.compared_until;
  for (std::size_t i = 0; i < measured.series.size() && trajectory.samples[i].time <= 1 + 1e-9; ++i) {
    if (std::abs(measured.series[i]) > std::abs(out.first_second)) out.first_second = measured.series[i];
  }
  return out;
}

bool is_failure(GateAnswer answer) {
  return answer == GateAnswer::failed || answer == GateAnswer::not_checked || answer == GateAnswer::unexpected_pass;
}

std::string word_of(SkipReason reason) {
  return reason == SkipReason::not_asked_for ? "not asked for" : "of another shard";
}

std::string word_of(GateAnswer answer) { return kAnswerWords[static_cast<int>(answer)]; }

StepSize coarsest_dt(const CaseResult& result) {
  return *std::max_element(result.definition.dt.begin(), result.definition.dt.end(),
                           [](const StepSize& a, const StepSize& b) { return a.seconds < b.seconds; });
}

bool is_in_house(const Results& results, std::size_t run) {
  return std::any_of(results.engines.begin(), results.engines.end(), [&](const EngineInfo& engine) {
    return engine.name == results.runs[run].engine && engine.is_in_house;
  });
}

}  // namespace rigor::inline results
