#include "cases/report/wording/findings/recorded_finding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "cases/report/wording/cell_claim.h"
#include "cases/report/wording/wording.h"
#include "cases/results/main_error.h"
#include "cases/results/trial_results.h"

namespace rigor::inline report {
namespace {

// None where the recording is no witness of the cell.
const MetricValue* error_in(const Cell& cell, const std::string& metric) {
  const auto found = cell.metrics.find(metric);
  const bool counts = found != cell.metrics.end() && found->second.not_applicable.empty() &&
                      !found->second.is_held_to_itself && std::isfinite(found->second.value);
  return counts ? &found->second : nullptr;
}

class RecordedCase {
 public:
  RecordedCase(const Results& results, const CaseResult& result)
      : results_(results), result_(result), metric_(main_error(result)) {
    for (const Cell& cell : result.cells) {
      if (error_in(cell, metric_)) (has_every_trial(cell) ? compared_ : partial_).push_back(&cell);
    }
  }

  // "Nearest to the recording: mujoco at 1/148 s (14.2 %), the mean over 275 trials." Then the other engines, the core,
  // and what could not be compared. Empty without a cell to compare.
  std::string nearest(Claims& claims) {
    others_.clear(), ours_.clear(), is_paired_ = false;
    const std::vector<const Cell*> best = best_of_each_engine();
    const auto first =
        std::find_if(best.begin(), best.end(), [&](const Cell* cell) { return !is_in_house(results_, cell->run); });
    for (const Cell* cell : best) {
      const bool is_compared = first != best.end() && cell != *first;
      (is_in_house(results_, cell->run) ? ours_ : others_.emplace_back()) =
          with_error(*cell, is_compared ? *first : nullptr, claims);
    }
    if (others_.empty() && ours_.empty()) return "";
    if (others_.empty()) std::swap(ours_, others_.emplace_back());
    return fmt::format("Nearest to the recording{}: {}{}.", of_case(), others_.front(), over_trials(claims));
  }

  std::string others() const {
    std::string text;
    const auto add = [&](const std::string& what, const std::string& list) {
      if (!list.empty()) text += fmt::format("{}{}{}: {}.", text.empty() ? "" : " ", what, of_case(), list);
    };
    if (!others_.empty()) add("Then", fmt::format("{}", fmt::join(others_.begin() + 1, others_.end(), ", ")));
    add("Rigor's core stands apart", ours_);
    if (is_paired_) text += " Differences from the nearest engine are paired by trial, with intervals of 95 %.";
    add("Not compared, because trials have no error", not_compared());
    return text;
  }

 private:
  std::string of_case() const { return results_.cases.size() < 2 ? "" : " on " + result_.definition.id; }

  bool has_every_trial(const Cell& cell) const {
    const std::vector<TrialResult> trials = trials_of(cell);
    const auto spread = spread_over(trials, metric_);
    return trials.empty() || (spread && spread->count == trials.size());
  }

  double error_of(const Cell& cell) const { return error_in(cell, metric_)->value; }

  // Nearest first.
  std::vector<const Cell*> best_of_each_engine() const {
    std::map<std::string, const Cell*> best;
    for (const Cell* cell : compared_) {
      const Cell*& nearest = best[results_.runs[cell->run].engine];
      if (!nearest || error_of(*cell) < error_of(*nearest)) nearest = cell;
    }
    std::vector<const Cell*> sorted;
    for (const auto& [engine, cell] : best) sorted.push_back(cell);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const Cell* a, const Cell* b) { return error_of(*a) < error_of(*b); });
    return sorted;
  }

  // `than`: the cell that it is compared with, if any.
  std::string with_error(const Cell& cell, const Cell* than, Claims& claims) {
    const std::string error =
        claims.printed(claim_of_cell(results_, result_, cell, metric_, error_of(cell)),
                       fmt::format("{} {}", three_digits(error_of(cell)), unit_of_metric(metric_)));
    return fmt::format("{} at {} s ({}{})", results_.runs[cell.run].text, cell.dt.text, error,
                       than ? difference(cell, *than, claims) : "");
  }

  // "; 4.6 to 6.5 more", "; 0.1 to 0.6 less", "; no certain difference: -0.3 to 0.7"
  std::string difference(const Cell& cell, const Cell& than, Claims& claims) {
    const auto paired = paired_difference(trials_of(cell), trials_of(than), metric_);
    if (!paired) return "";
    is_paired_ = true;
    const double sign = paired->high < 0 ? -1 : 1;
    const std::string low = bound("low end", cell, than, sign * (sign < 0 ? paired->high : paired->low), claims),
                      high = bound("high end", cell, than, sign * (sign < 0 ? paired->low : paired->high), claims);
    if (!paired->is_certain()) return fmt::format("; no certain difference: {} to {}", low, high);
    return fmt::format("; {} to {} {}", low, high, sign < 0 ? "less" : "more");
  }

  std::string bound(const std::string& which, const Cell& cell, const Cell& than, double value, Claims& claims) const {
    Claim claim = claim_of_cell(results_, result_, cell, which + " of the difference of " + metric_, value);
    claim.part = fmt::format("{} at {}", results_.runs[than.run].text, than.dt.text);
    return claims.printed(claim, two_digits(value));
  }

  std::string over_trials(Claims& claims) const {
    const std::size_t trials = trials_of(*compared_.front()).size();
    if (trials < 2) return "";
    return fmt::format(", the mean over {} trials",
                       claims.count(claim_of_scene(result_, "trials", static_cast<double>(trials))));
  }

  std::string not_compared() const {
    std::vector<std::string> names;
    for (const Cell* cell : partial_) {
      const std::vector<TrialResult> trials = trials_of(*cell);
      const auto spread = spread_over(trials, metric_);
      names.push_back(fmt::format("{} at {} s ({} of {} have one)", results_.runs[cell->run].text, cell->dt.text,
                                  spread ? spread->count : 0, trials.size()));
    }
    return fmt::format("{}", fmt::join(names, ", "));
  }

  const Results& results_;
  const CaseResult& result_;
  std::string metric_;
  std::vector<const Cell*> compared_, partial_;
  std::vector<std::string> others_;  // the best of each engine with its error, nearest first
  std::string ours_;
  bool is_paired_ = false;
};

}  // namespace

std::optional<Message> recorded_finding(const Results& results) {
  Message finding{"recorded", ""};
  Claims claims;
  const auto add = [](std::string& text, const std::string& sentence) {
    if (!sentence.empty()) text += (text.empty() ? "" : " ") + sentence;
  };
  for (const CaseResult& result : results.cases) {
    if (result.definition.truth != "recording") continue;
    RecordedCase recorded(results, result);
    add(finding.text, recorded.nearest(claims));
    add(finding.more, recorded.others());
  }
  if (finding.text.empty()) std::swap(finding.text, finding.more);
  if (finding.text.empty()) return std::nullopt;
  finding.claims = claims.take();
  return finding;
}

}  // namespace rigor::inline report
