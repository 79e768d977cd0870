#include "cases/results/results.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>

namespace rigor {
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
  assert(found != std::end(kStatusWords));
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

bool falls_short(GateAnswer answer) {
  return answer == GateAnswer::failed || answer == GateAnswer::not_checked || answer == GateAnswer::unexpected_pass;
}

std::string word_of(GateAnswer answer) { return kAnswerWords[static_cast<int>(answer)]; }

}  // namespace rigor
