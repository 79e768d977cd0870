#include "cases/report/wording/repeats.h"

#include <fmt/format.h>

#include "cases/report/layout.h"

namespace rigor::inline report {
namespace {

std::string difference_text(const RepeatOutcome& outcome) {
  const BitDifference& difference = *outcome.difference;
  // Only hashes are known of another process.
  if (difference.column < 0)
    return fmt::format("{} from step {} on", outcome.must_hold ? "DIFFERS" : "processor-dependent", difference.step);
  const std::string head = outcome.must_hold ? "DIFFERS" : "order-dependent";
  return fmt::format("{} from step {} on: {} of '{}' by {:.3g}; at the end {:.3g} m and {:.3g} rad, {}", head,
                     difference.step, kColumnNames[static_cast<std::size_t>(difference.column)], outcome.body,
                     difference.there, difference.position, difference.angle,
                     outcome.is_like_rounding ? "as roundings make" : "more than roundings make");
}

std::string outcome_text(const RepeatOutcome& outcome) {
  if (outcome.has_failed) return "FAILED: " + outcome.why;
  if (!outcome.is_run) return "not applicable: " + outcome.why;
  return outcome.difference ? difference_text(outcome) : "same bits";
}

}  // namespace

std::string text_of(const RepeatReport& report) {
  constexpr std::size_t kWidth = 29;
  std::string text =
      fmt::format("{}: {} at {} s, {} steps\n", report.case_id, report.run.text, report.dt.text, report.steps);
  for (const RepeatOutcome& outcome : report.outcomes)
    text += fmt::format("  {:<16}{:<11}{}\n", outcome.change, outcome.label, wrapped(outcome_text(outcome), kWidth));
  return text + fmt::format("  {}\n", report.repeats() ? "It repeats." : "It does not repeat.");
}

}  // namespace rigor::inline report
