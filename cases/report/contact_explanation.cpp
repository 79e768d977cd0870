#include "cases/report/contact_explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigor {
namespace {

// One run's values of a metric at the case's steps, from the coarsest to the finest.
struct Course {
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

Course course_of(const CaseResult& result, std::size_t run, const std::string& metric) {
  Course course;
  for (const Cell& cell : result.cells) {
    const auto found = cell.metrics.find(metric);
    const bool is_there = cell.run == run && found != cell.metrics.end() && found->second.not_applicable.empty();
    if (is_there && cell.stability.verdict != Verdict::blown_up) course.cells.push_back(&cell);
  }
  std::stable_sort(course.cells.begin(), course.cells.end(),
                   [](const Cell* a, const Cell* b) { return a->dt.seconds > b->dt.seconds; });
  for (const Cell* cell : course.cells) course.values.push_back(&cell->metrics.at(metric));
  return course;
}

// ": erp 0.2: that share ..." of the setting in force, if the engine tells it.
std::string in_its_words(const Cell& cell, const std::string& setting) {
  for (const auto& [name, words] : cell.settings) {
    if (name == setting) return fmt::format(" Its setting \"{}\": {}.", name, words);
  }
  return "";
}

// Of a first-order engine the error falls with dt; this one's is, at some finer step, larger than at the coarsest.
std::string restitution_that_does_not_converge(const std::string& name, const Course& course) {
  constexpr double kWorthSaying = 0.05;
  if (course.values.size() < 2) return "";
  double later = 0;
  for (std::size_t i = 1; i < course.values.size(); ++i) later = std::max(later, course.values[i]->value);
  if (later < kWorthSaying || later < course.values.front()->value) return "";
  return fmt::format("Why: the restitution of {} is off by {} s: it does not converge as dt falls.{}", name,
                     course.text(), in_its_words(*course.cells.front(), "restitution"));
}

// Bodies that should stay together part: an overlap is given back as speed.
std::string pop(const std::string& name, const Course& course) {
  constexpr double kWorthSaying = 0.02;
  for (std::size_t i = course.values.size(); i-- > 0;) {
    const Instant& worst = course.values[i]->worst;
    if (worst.expected != 0 || worst.found < kWorthSaying) continue;
    return fmt::format(
        "Why: after an impact without bounce {} parts the bodies at {:.2g} of the speed they met with, at "
        "dt = {} s: an overlap is pushed out as speed.{}",
        name, worst.found, course.cells[i]->dt.text, in_its_words(*course.cells[i], "erp"));
  }
  return "";
}

std::string friction_with_directions(const std::string& name, const Course& course) {
  constexpr double kWorthSaying = 0.1;
  if (course.empty() || course.values.back()->value < kWorthSaying) return "";
  const MetricValue& finest = *course.values.back();
  return fmt::format(
      "Why: with {} bodies that should all stop after the same way differ by {:.2g} of it, whatever dt is "
      "({} s); the worst stops after {:.3g} m instead of {:.3g}. Its friction knows directions.{}",
      name, finest.value, course.text(), finest.worst.found, finest.worst.expected,
      in_its_words(*course.cells.back(), "friction"));
}

}  // namespace

std::vector<std::string> contact_explanations(const Results& results, const CaseResult& result) {
  std::vector<std::string> sentences;
  const auto add = [&](const std::string& sentence) {
    if (!sentence.empty()) sentences.push_back(sentence);
  };
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    const std::string& name = results.runs[run].text;
    const Course restitution = course_of(result, run, "restitution_error");
    const std::string popped = pop(name, restitution);
    add(popped.empty() ? restitution_that_does_not_converge(name, restitution) : popped);
    add(friction_with_directions(name, course_of(result, run, "friction_anisotropy")));
  }
  return sentences;
}

}  // namespace rigor
