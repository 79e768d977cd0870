#include "cases/analysis/metric_over_steps.h"

#include <fmt/format.h>

#include <algorithm>

namespace rigor::inline analysis {

MetricOverSteps metric_over_steps(const CaseResult& result, std::size_t run, const std::string& metric) {
  MetricOverSteps series;
  for (const Cell& cell : result.cells) {
    const auto found = cell.metrics.find(metric);
    const bool is_there = cell.run == run && found != cell.metrics.end() && found->second.not_applicable.empty();
    if (is_there && cell.stability.verdict != Verdict::blown_up) series.cells.push_back(&cell);
  }
  std::stable_sort(series.cells.begin(), series.cells.end(),
                   [](const Cell* a, const Cell* b) { return a->dt.seconds > b->dt.seconds; });
  for (const Cell* cell : series.cells) series.values.push_back(&cell->metrics.at(metric));
  return series;
}

std::vector<std::size_t> runs_of(const CaseResult& result) {
  std::vector<std::size_t> runs;
  for (const Cell& cell : result.cells) runs.push_back(cell.run);
  std::sort(runs.begin(), runs.end());
  runs.erase(std::unique(runs.begin(), runs.end()), runs.end());
  return runs;
}

std::string setting_of(const Cell& cell, const std::string& setting) {
  for (const auto& [name, words] : cell.settings) {
    if (name == setting) return words;
  }
  return "";
}

std::string in_its_words(const Cell& cell, const std::string& setting) {
  const std::string words = setting_of(cell, setting);
  return words.empty() ? "" : fmt::format("Its setting \"{}\": {}.", setting, words);
}

Diagnosis diagnosis_of(const char* topic, const CaseResult& result, const MetricOverSteps& series, std::size_t n,
                       double value, const std::string& cause) {
  Diagnosis diagnosis{topic, {series.cells[n]->run}, result.definition.id, value, cause, {}, series.values[n]->worst};
  for (std::size_t i = 0; i < series.cells.size(); ++i)
    diagnosis.over.emplace_back(series.cells[i]->dt, series.values[i]->value);
  return diagnosis;
}

}  // namespace rigor::inline analysis
