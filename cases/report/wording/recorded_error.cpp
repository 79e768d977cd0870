#include "cases/report/wording/recorded_error.h"

#include <fmt/format.h>

#include "cases/report/wording/wording.h"
#include "cases/results/trial_results.h"

namespace rigor::inline report {
namespace {

// Mean ± standard deviation, median, worst with its trial; the latter are empty for a single trial. Trials without a
// value are not in the mean, which then says how many are.
std::vector<std::string> columns_of(const Cell& cell, const std::vector<TrialResult>& trials,
                                    const std::string& metric) {
  const auto found = cell.metrics.find(metric);
  if (found == cell.metrics.end() || !found->second.not_applicable.empty()) return {"-", "", ""};
  const MetricValue& value = found->second;
  const auto spread = spread_over(trials, metric);
  const std::string mean = three_digits(value.value);
  const auto in_brackets = [&](const std::string& text) { return value.is_held_to_itself ? "(" + text + ")" : text; };
  if (!spread) return {in_brackets(mean), "", ""};
  const std::string of =
      spread->count < trials.size() ? fmt::format(", {} of {} trials", spread->count, trials.size()) : "";
  return {in_brackets(fmt::format("{} ± {}{}", mean, three_digits(spread->standard_deviation), of)),
          three_digits(spread->median), fmt::format("{} in {}", three_digits(spread->worst_value), spread->worst)};
}

}  // namespace

TextTable recorded_errors(const Results& results, const CaseResult& result) {
  TextTable table;
  if (result.definition.truth != "recording") return table;
  table.heading =
      "Mean error over the recording: mean ± standard deviation over the trials, median, and the worst "
      "trial.";
  table.rows = {{"run", "dt [s]", "position [%]", "median", "worst", "rotation [deg]", "median", "worst"}};
  for (const Cell& cell : result.cells) {
    if (cell.metrics.empty()) continue;
    const std::vector<TrialResult> trials = trials_of(cell);
    std::vector<std::string> row = {results.runs[cell.run].text, cell.dt.text};
    for (const char* metric : {"mean_position_error", "mean_rotation_error"})
      for (std::string& text : columns_of(cell, trials, metric)) row.push_back(std::move(text));
    table.rows.push_back(std::move(row));
  }
  if (table.rows.size() == 1) table.rows.clear();
  return table;
}

}  // namespace rigor::inline report
