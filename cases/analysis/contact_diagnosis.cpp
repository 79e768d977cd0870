#include "cases/analysis/contact_diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace rigor {
namespace {

// One run's values of a metric at the case's steps, from the coarsest to the finest.
struct TimeSeries {
  std::vector<const Cell*> cells;
  std::vector<const MetricValue*> values;
};

TimeSeries series_of(const CaseResult& result, std::size_t run, const std::string& metric) {
  TimeSeries series;
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

// What the engine tells of the setting in force, if it does.
std::string in_its_words(const Cell& cell, const std::string& setting) {
  for (const auto& [name, words] : cell.settings) {
    if (name == setting) return fmt::format("Its setting \"{}\": {}.", name, words);
  }
  return "";
}

std::string how_it_corrects(const Cell& cell) {
  const std::string split = in_its_words(cell, "split impulse threshold");
  return split.empty() ? in_its_words(cell, "erp") : split;
}

// In a pile some balls graze each other, and what a step's overlap makes of the normal there is no matter of
// restitution.
bool is_pile(const CaseResult& result) {
  constexpr std::size_t kMostTellable = 60;  // bodies
  return result.definition.scene.bodies.size() > kMostTellable;
}

// Of the series, at its n-th step.
Diagnosis found(const char* topic, const CaseResult& result, const TimeSeries& series, std::size_t n, double value,
                const std::string& cause) {
  Diagnosis diagnosis{topic, {series.cells[n]->run}, result.definition.id, value, cause, {}, series.values[n]->worst};
  for (std::size_t i = 0; i < series.cells.size(); ++i)
    diagnosis.over.emplace_back(series.cells[i]->dt, series.values[i]->value);
  return diagnosis;
}

// Bodies that should stay together part, with a share of the speed they met with. One that keeps more than half has not
// been stopped at all.
std::optional<Diagnosis> overlap_given_back(const CaseResult& result, const TimeSeries& restitution) {
  constexpr double kWorthSaying = 0.02, kMostGivenBack = 0.5;
  for (std::size_t i = restitution.values.size(); i-- > 0;) {
    const Instant& worst = restitution.values[i]->worst;
    if (worst.expected != 0 || worst.found < kWorthSaying || worst.found > kMostGivenBack) continue;
    Diagnosis one =
        found(kOverlapGivenBack, result, restitution, i, worst.found, how_it_corrects(*restitution.cells[i]));
    one.over = {one.over[i]};
    return one;
  }
  return std::nullopt;
}

// Of a first-order engine the error falls with dt; this one's is, at some finer step, larger than at the coarsest.
std::optional<Diagnosis> unconverged(const CaseResult& result, const TimeSeries& restitution) {
  constexpr double kWorthSaying = 0.05;
  if (restitution.values.size() < 2 || is_pile(result)) return std::nullopt;
  double later = 0;
  std::size_t at = 0;
  for (std::size_t i = 1; i < restitution.values.size(); ++i) {
    if (restitution.values[i]->worst.expected > 0 && restitution.values[i]->value > later)
      later = restitution.values[i]->value, at = i;
  }
  if (later < kWorthSaying || later <= restitution.values.front()->value) return std::nullopt;
  return found(kUnconverged, result, restitution, at, later, in_its_words(*restitution.cells.front(), "restitution"));
}

std::optional<Diagnosis> friction_with_directions(const CaseResult& result, const TimeSeries& anisotropy) {
  constexpr double kWorthSaying = 0.1;
  if (anisotropy.values.empty() || anisotropy.values.back()->value < kWorthSaying) return std::nullopt;
  return found(kFrictionDirections, result, anisotropy, anisotropy.values.size() - 1, anisotropy.values.back()->value,
               in_its_words(*anisotropy.cells.back(), "friction"));
}

}  // namespace

std::vector<Diagnosis> contact_diagnoses(const CaseResult& result) {
  std::vector<std::size_t> runs;
  for (const Cell& cell : result.cells) runs.push_back(cell.run);
  std::sort(runs.begin(), runs.end());
  runs.erase(std::unique(runs.begin(), runs.end()), runs.end());
  std::vector<Diagnosis> all;
  for (const std::size_t run : runs) {
    const TimeSeries restitution = series_of(result, run, "restitution_error");
    auto impacts = overlap_given_back(result, restitution);
    if (!impacts) impacts = unconverged(result, restitution);
    if (impacts) all.push_back(std::move(*impacts));
    auto friction = friction_with_directions(result, series_of(result, run, "friction_anisotropy"));
    if (friction) all.push_back(std::move(*friction));
  }
  return all;
}

}  // namespace rigor
