#include "cases/report/wording/contact_explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigor {
namespace {

// One run's values of a metric at the case's steps, from the coarsest to the finest.
struct TimeSeries {
  std::vector<const Cell*> cells;
  std::vector<const MetricValue*> values;

  bool empty() const { return cells.empty(); }
  std::string text() const {
    std::string list;
    for (std::size_t i = 0; i < cells.size(); ++i)
      list += fmt::format("{}{:.2g} at {}", i == 0 ? "" : ", ", values[i]->value, cells[i]->dt.text);
    return list;
  }
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

std::string with_reason(const std::string& sentence, const std::string& reason) {
  return reason.empty() ? sentence : sentence + " " + reason;
}

std::string how_it_corrects(const Cell& cell) {
  const std::string split = in_its_words(cell, "split impulse threshold");
  return split.empty() ? in_its_words(cell, "erp") : split;
}

std::string friction_with_directions(const std::string& name, const TimeSeries& series) {
  constexpr double kWorthSaying = 0.1;
  if (series.empty() || series.values.back()->value < kWorthSaying) return "";
  const MetricValue& finest = *series.values.back();
  return with_reason(
      fmt::format("Why: with {} bodies that should all stop after the same way differ by {:.2g} of it, whatever dt is "
                  "({} s); the worst stops after {:.3g} m instead of {:.3g}. Its friction knows directions.",
                  name, finest.value, series.text(), finest.worst.found, finest.worst.expected),
      in_its_words(*series.cells.back(), "friction"));
}

// In a pile some balls graze each other, and what a step's overlap makes of the normal there is no matter of
// restitution.
bool is_pile(const CaseResult& result) {
  constexpr std::size_t kMostTellable = 60;  // bodies
  return result.definition.scene.bodies.size() > kMostTellable;
}

}  // namespace

// Bodies that should stay together part, with a share of the speed they met with. One that keeps more than half has not
// been stopped at all.
std::optional<ContactFault> overlap_given_back(const CaseResult& result, std::size_t run) {
  constexpr double kWorthSaying = 0.02, kMostGivenBack = 0.5;
  const TimeSeries series = series_of(result, run, "restitution_error");
  for (std::size_t i = series.values.size(); i-- > 0;) {
    const Instant& worst = series.values[i]->worst;
    if (worst.expected != 0 || worst.found < kWorthSaying || worst.found > kMostGivenBack) continue;
    return ContactFault{worst.found, "at dt = " + series.cells[i]->dt.text + " s", how_it_corrects(*series.cells[i])};
  }
  return std::nullopt;
}

// Of a first-order engine the error falls with dt; this one's is, at some finer step, larger than at the coarsest.
std::optional<ContactFault> unconverged_restitution(const CaseResult& result, std::size_t run) {
  constexpr double kWorthSaying = 0.05;
  const TimeSeries series = series_of(result, run, "restitution_error");
  if (series.values.size() < 2 || is_pile(result) || overlap_given_back(result, run)) return std::nullopt;
  double later = 0;
  for (std::size_t i = 1; i < series.values.size(); ++i) {
    if (series.values[i]->worst.expected > 0) later = std::max(later, series.values[i]->value);
  }
  if (later < kWorthSaying || later <= series.values.front()->value) return std::nullopt;
  return ContactFault{later, series.text() + " s", in_its_words(*series.cells.front(), "restitution")};
}

std::vector<std::string> contact_explanations(const Results& results, const CaseResult& result) {
  std::vector<std::string> sentences;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    const std::string& name = results.runs[run].text;
    if (const auto popped = overlap_given_back(result, run)) {
      sentences.push_back(with_reason(
          fmt::format("Why: after an impact without bounce {} parts the bodies at {:.2g} of the speed they met with, "
                      "{}: an overlap is pushed out as speed.",
                      name, popped->size, popped->series),
          popped->reason));
    } else if (const auto restitution = unconverged_restitution(result, run)) {
      sentences.push_back(
          with_reason(fmt::format("Why: the restitution of {} is off by {}: it does not converge as dt falls.", name,
                                  restitution->series),
                      restitution->reason));
    }
    const std::string friction = friction_with_directions(name, series_of(result, run, "friction_anisotropy"));
    if (!friction.empty()) sentences.push_back(friction);
  }
  return sentences;
}

}  // namespace rigor
