#include "cases/report/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "cases/metrics/work_precision.h"

namespace rigor {
namespace {

// A metric with its sign, or not a number.
double value_of(const std::map<std::string, MetricValue>& metrics, const std::string& name) {
  const auto found = metrics.find(name);
  if (found == metrics.end() || !found->second.not_applicable.empty()) return std::nan("");
  const MetricValue& metric = found->second;
  return std::copysign(metric.value, metric.worst.found - metric.worst.expected);
}

// Names in a sentence, the first few of them.
std::string listed_names(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i ? ", " : "") + names[i];
  return names.size() > most ? text + fmt::format(" and {} more", names.size() - most) : text;
}

class Finder {
 public:
  explicit Finder(const Results& results) : results_(results), dt_(headline_dt(results)) {}

  std::vector<std::string> sentences() {
    for (std::size_t run = 0; run < results_.runs.size(); ++run) {
      if (results_.runs[run].engine != "core") say_where_energy_goes(run);
    }
    say_who_blows_up();
    say_what_a_millimetre_takes();
    say_what_is_unexplained();
    return sentences_;
  }

 private:
  // Cells at the headline step that ran, each with its case.
  template <typename F>
  void for_cells(std::size_t run, const F& f) const {
    for (const CaseResult& result : results_.cases) {
      for (const Cell& cell : result.cells) {
        if (cell.run == run && cell.dt.seconds == dt_.seconds && !cell.metrics.empty()) f(result, cell);
      }
    }
  }

  void say_who_blows_up() {
    std::vector<std::string> steady;
    std::map<std::string, std::vector<std::string>> lost;  // runs by what is said of them
    for (std::size_t run = 0; run < results_.runs.size(); ++run) {
      std::vector<std::string> blown;
      int ran = 0;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        ++ran;
        if (cell.stability.verdict == Verdict::blown_up) blown.push_back(result.definition.id);
      });
      const std::string& name = results_.runs[run].text;
      if (ran > 0 && blown.empty()) steady.push_back(name);
      if (!blown.empty()) lost[fmt::format("{} of {} ({})", blown.size(), ran, listed_names(blown, 2))].push_back(name);
    }
    if (lost.empty() && !steady.empty()) sentences_.push_back(fmt::format("At dt = {} s nothing blows up.", dt_.text));
    if (lost.empty()) return;
    std::vector<std::string> parts;
    for (const auto& [cases, names] : lost) parts.push_back(fmt::format("{} in {}", listed_names(names, 3), cases));
    std::string text = fmt::format("At dt = {} s these blow up: ", dt_.text);
    for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? "; " : "") + parts[i];
    if (!steady.empty()) text += fmt::format(". Never: {}", listed_names(steady, 6));
    sentences_.push_back(text + ".");
  }

  // The case in which a run's mean energy moves most without its blowing up; of runs of one engine that say the same
  // only the first.
  void say_where_energy_goes(std::size_t run) {
    const CaseResult* worst_case = nullptr;
    const Cell* worst = nullptr;
    for_cells(run, [&](const CaseResult& result, const Cell& cell) {
      if (cell.stability.verdict != Verdict::drifting) return;
      const double drift = std::abs(value_of(cell.metrics, kDrift));
      if (!(drift > 0.01) || (worst && drift <= std::abs(value_of(worst->metrics, kDrift)))) return;
      worst = &cell, worst_case = &result;
    });
    if (!worst) return;
    const double drift = value_of(worst->metrics, kDrift);
    const std::string text =
        fmt::format("{} {:.2g} % of the energy of {} within {:g} s at dt = {} s{}", drift < 0 ? "loses" : "gains",
                    100 * std::abs(drift), worst_case->definition.id, worst_case->definition.duration, dt_.text,
                    cause_of(*worst, drift));
    if (said_of_energy_.insert(results_.runs[run].engine + text).second)
      sentences_.push_back(results_.runs[run].text + " " + text);
  }

  static std::string cause_of(const Cell& cell, double drift) {
    constexpr double kAlike = 0.01, kGone = 0.1;
    const double scheme = value_of(cell.scheme.metrics, kDrift),
                 without = value_of(cell.scheme.without_gyroscopic_term, kDrift);
    if (std::isnan(scheme)) return ", the most of all its cases.";
    if (std::abs(drift - scheme) > kAlike * std::abs(drift))
      return fmt::format("; of that its scheme explains {:.2g} %.", 100 * scheme / drift);
    if (std::abs(without) < kGone * std::abs(drift)) return "; all of it is its gyroscopic scheme.";
    return "; all of it is its scheme: the core, repeating it, comes to the same.";
  }

  void say_what_is_unexplained() {
    double largest = 0;
    std::string where;
    int compared = 0;
    for (std::size_t run = 0; run < results_.runs.size(); ++run) {
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        const double rest = std::abs(value_of(cell.metrics, "unexplained_error"));
        if (cell.scheme.twin.empty() || std::isnan(rest) || cell.stability.verdict == Verdict::blown_up) return;
        ++compared;
        if (rest > largest) largest = rest, where = results_.runs[run].text + " on " + result.definition.id;
      });
    }
    if (compared == 0) return;
    sentences_.push_back(
        fmt::format("Beside {} runs the core repeated the engine's own scheme: the largest position error that this "
                    "leaves unexplained is {:.2g} m{}.",
                    compared, largest, where.empty() ? "" : ", by " + where));
  }

  // The largest dt at which a run's position error is at most `error`, read off the line through its cells; 0 if none.
  double step_for(const CaseResult& result, std::size_t run, double error) const {
    auto points = error_points(result, run, "position_error");
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.dt.seconds > b.dt.seconds; });
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!(points[i].error <= error)) continue;
      if (i == 0 || !(points[i].error > 0)) return points[i].dt.seconds;
      const double slope =
          std::log(points[i - 1].error / points[i].error) / std::log(points[i - 1].dt.seconds / points[i].dt.seconds);
      return points[i].dt.seconds * std::pow(error / points[i].error, 1 / slope);
    }
    return 0;
  }

  void say_what_a_millimetre_takes() {
    constexpr double kMillimetre = 1e-3;
    std::vector<std::pair<double, std::string>> runs;
    for (std::size_t run = 0; run < results_.runs.size(); ++run) {
      std::vector<double> steps;
      for (const CaseResult& result : results_.cases) {
        if (!error_points(result, run, "position_error").empty()) steps.push_back(step_for(result, run, kMillimetre));
      }
      if (steps.empty() || steps.size() * 2 < results_.cases.size()) continue;  // too few to speak of a middle one
      std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
      runs.emplace_back(steps[steps.size() / 2], results_.runs[run].text);
    }
    if (runs.empty()) return;
    std::stable_sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::string> enough, too_few;
    for (const auto& [step, name] : runs)
      step > 0 ? enough.push_back(fmt::format("{} {:.2g} s", name, step)) : too_few.push_back(name);
    std::string text = "To stay within 1 mm of the truth in the middle one of the cases takes a dt of: ";
    text += enough.empty() ? "less than was tried with any of them" : listed_names(enough, 6);
    if (!enough.empty() && !too_few.empty()) text += "; less than was tried with " + listed_names(too_few, 4);
    sentences_.push_back(text + ".");
  }

  static constexpr const char* kDrift = "energy_drift";
  const Results& results_;
  StepSize dt_;
  std::set<std::string> said_of_energy_;
  std::vector<std::string> sentences_;
};

}  // namespace

std::vector<std::string> findings(const Results& results) { return Finder(results).sentences(); }

StepSize headline_dt(const Results& results) {
  constexpr double kHeadline = 1.0 / 30;
  StepSize coarsest{0, ""};
  for (const CaseResult& result : results.cases) {
    for (const StepSize& step : result.definition.dt) {
      if (std::abs(step.seconds - kHeadline) < 1e-12) return step;
      if (step.seconds > coarsest.seconds) coarsest = step;
    }
  }
  return coarsest;
}

}  // namespace rigor
