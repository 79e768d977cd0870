#include "cases/results/trial_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor::inline results {
namespace {

constexpr const char* kTrials = "trials";

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

void keep_trials(Cell& cell, const std::vector<TrialResult>& trials) {
  Recording& kept = cell.recordings[kTrials];
  kept.clear();
  for (const TrialResult& trial : trials)
    kept.push_back(text_of(Json::array({trial.name, word_of(trial.status), trial.reason, trial.metrics}), -1));
}

std::vector<TrialResult> trials_of(const Cell& cell) {
  std::vector<TrialResult> trials;
  const auto kept = cell.recordings.find(kTrials);
  if (kept == cell.recordings.end()) return trials;
  for (const std::string& text : kept->second) {
    const Json json = parse_json(text);
    TrialResult trial{
        json.at(0).get<std::string>(), status_of(json.at(1).get<std::string>()), json.at(2).get<std::string>(), {}};
    for (const auto& [name, value] : json.at(3).items()) trial.metrics[name] = number_of(value);
    trials.push_back(std::move(trial));
  }
  return trials;
}

std::string recording_of_trial(const std::string& recorder, std::size_t trial) {
  return trial == 0 ? recorder : fmt::format("{} of trial {}", recorder, trial);
}

std::optional<TrialSpread> spread_over(const std::vector<TrialResult>& trials, const std::string& metric) {
  const MetricRow* row = find_metric(metric);
  const bool higher_is_better = row && row->higher_is_better;
  TrialSpread spread;
  std::vector<double> values;
  for (const TrialResult& trial : trials) {
    const auto found = trial.metrics.find(metric);
    if (found == trial.metrics.end()) continue;
    const double value = found->second;
    const bool is_worse = higher_is_better ? value < spread.worst_value : value > spread.worst_value;
    if (values.empty() || is_worse) spread.worst = trial.name, spread.worst_value = value;
    values.push_back(value), spread.mean += value;
  }
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  spread.count = values.size(), spread.mean /= count, spread.median = median_of(values);
  double squares = 0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  if (values.size() > 1) spread.standard_deviation = std::sqrt(squares / (count - 1));
  return spread;
}

std::optional<PairedDifference> paired_difference(const std::vector<TrialResult>& of,
                                                  const std::vector<TrialResult>& than, const std::string& metric) {
  std::vector<double> differences;
  for (const TrialResult& one : of) {
    const auto other =
        std::find_if(than.begin(), than.end(), [&](const TrialResult& trial) { return trial.name == one.name; });
    if (other == than.end() || !one.metrics.contains(metric) || !other->metrics.contains(metric)) continue;
    differences.push_back(one.metrics.at(metric) - other->metrics.at(metric));
  }
  const auto count = static_cast<double>(differences.size());
  if (count < 2) return {};
  double mean = 0, squares = 0;
  for (const double difference : differences) mean += difference / count;
  for (const double difference : differences) squares += (difference - mean) * (difference - mean);
  const double error = std::sqrt(squares / (count - 1) / count);
  const double half = error * quantile(boost::math::students_t(count - 1), 0.975);
  return PairedDifference{mean, mean - half, mean + half};
}

}  // namespace rigor::inline results
