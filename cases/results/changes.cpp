#include "cases/results/changes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>

#include "cases/metrics/verdict.h"

namespace rigor::inline results {
namespace {

// 0: as it should be; 1: not run, for it cannot be; 2: something is wrong.
int badness(Status status) {
  if (status == Status::pass || status == Status::known_deviation) return 0;
  return status == Status::unsupported ? 1 : 2;
}

bool holds(GateAnswer answer) { return answer == GateAnswer::held || answer == GateAnswer::known_deviation; }

// None where nobody measured it.
std::optional<double> value_of(const Baseline& baseline, const Baseline::Cell& cell, const std::string& metric) {
  const auto found = cell.metrics.find(metric);
  if (found != cell.metrics.end()) return found->second;
  return baseline.left_out.contains(metric) ? std::optional(0.0) : std::nullopt;
}

void compare_errors(const CellKey& key, const Baseline& before, const Baseline& after, double factor, Changes& out) {
  const Baseline::Cell &old_cell = before.cells.at(key), &new_cell = after.cells.at(key);
  std::set<std::string> names;
  for (const auto* cell : {&old_cell, &new_cell}) {
    for (const auto& [name, value] : cell->metrics) names.insert(name);
  }
  for (const std::string& name : names) {
    const auto was = value_of(before, old_cell, name), is = value_of(after, new_cell, name);
    if (was && !is && !new_cell.not_asked.contains(name) && *was > kNoise)
      out.lost.push_back(fmt::format("{}: {} is missing, was {:.4g}", key.text(), name, *was));
    if (!was || !is) continue;
    const double low = std::max(kNoise, std::min(*was, *is)), high = std::max(*was, *is);
    if (!(high > factor * low)) continue;
    ((*is > *was) == is_higher_better(name) ? out.better : out.worse)
        .push_back(fmt::format("{}: {} is {:.4g}, was {:.4g}", key.text(), name, *is, *was));
  }
}

// An older result may know fewer verdicts, or none.
void compare_verdicts(const CellKey& key, const Baseline& before, const Baseline& after, Changes& out) {
  const auto was = before.cells.at(key).verdict, is = after.cells.at(key).verdict;
  if (!was || !is || was == is) return;
  (*is > *was ? out.newly_failing : out.newly_passing)
      .push_back(fmt::format("{}: its verdict is {}, was {}", key.text(), word_of(*is), word_of(*was)));
}

// Of an older file, which does not say, they count as alike.
bool have_one_duration(const std::string& id, const Baseline& before, const Baseline& after) {
  const auto was = before.durations.find(id), is = after.durations.find(id);
  return was == before.durations.end() || is == after.durations.end() || was->second == is->second;
}

void compare_durations(const Baseline& before, const Baseline& after, Changes& out) {
  for (const auto& [id, is] : after.durations) {
    if (have_one_duration(id, before, after)) continue;
    const double was = before.durations.at(id);
    (is < was ? out.shorter : out.longer)
        .push_back(fmt::format("{}: {:g} s, was {:g} s; its metrics are not compared", id, is, was));
  }
}

void compare_stable_steps(const Baseline& before, const Baseline& after, double factor, Changes& out) {
  for (const auto& [key, is] : after.stable_steps) {
    const auto found = before.stable_steps.find(key);
    if (found == before.stable_steps.end() || !have_one_duration(key.case_id, before, after)) continue;
    const double was = found->second;
    if (!(std::max(is, was) > factor * std::min(is, was))) continue;
    (is < was ? out.worse : out.better)
        .push_back(fmt::format("{}: the largest stable step is {:.4g} s, was {:.4g} s", key.text(), is, was));
  }
}

void compare_cells(const CellKey& key, const Baseline& before, const Baseline& after, double factor, Changes& out) {
  const Status was = before.cells.at(key).status, is = after.cells.at(key).status;
  if (badness(was) != badness(is)) {
    (badness(is) > badness(was) ? out.newly_failing : out.newly_passing)
        .push_back(fmt::format("{}: {}, was {}", key.text(), word_of(is), word_of(was)));
  }
  // Numbers and verdicts of a run that failed mean little.
  if (badness(was) != 0 || badness(is) != 0 || !have_one_duration(key.case_id, before, after)) return;
  compare_verdicts(key, before, after, out);
  compare_errors(key, before, after, factor, out);
}

std::set<std::string> cases_of(const Baseline& baseline) {
  std::set<std::string> ids;
  for (const auto& [key, cell] : baseline.cells) ids.insert(key.case_id);
  return ids;
}

// What is in one and not in the other: whole cases by their name, else cells.
std::vector<std::string> only_in(const Baseline& one, const Baseline& other) {
  const auto of_other = cases_of(other);
  std::vector<std::string> names;
  for (const std::string& id : cases_of(one)) {
    if (!of_other.contains(id)) names.push_back(id);
  }
  for (const auto& [key, cell] : one.cells) {
    if (of_other.contains(key.case_id) && !other.cells.contains(key)) names.push_back(key.text());
  }
  return names;
}

// A gate that is not listed held, or is not there; its cell tells.
void compare_gates(const Baseline& before, const Baseline& after, Changes& out) {
  std::set<GateKey> keys;
  for (const auto* baseline : {&before, &after}) {
    for (const auto& [key, answer] : baseline->gates) keys.insert(key);
  }
  const auto answer_of = [](const Baseline& baseline, const GateKey& key) {
    const auto found = baseline.gates.find(key);
    return found == baseline.gates.end() ? GateAnswer::held : found->second;
  };
  for (const GateKey& key : keys) {
    const GateAnswer was = answer_of(before, key), is = answer_of(after, key);
    if (holds(was) == holds(is)) continue;
    (holds(is) ? out.newly_passing : out.newly_failing)
        .push_back(fmt::format("gate of {}: {}, was {}", key.text(), word_of(is), word_of(was)));
  }
}

// A setting may have one value for each of several scenes, and the two results may contain different scenes. It differs
// if there is a value that the old result lacks.
void compare_settings(const Baseline& before, const Baseline& after, Changes& out) {
  const auto listed_values = [](const std::set<std::string>& values) {
    return fmt::format("{}", fmt::join(values, " | "));
  };
  for (const auto& [key, now] : after.settings) {
    const auto was = before.settings.find(key);
    if (was == before.settings.end()) continue;
    if (!std::includes(was->second.begin(), was->second.end(), now.begin(), now.end()))
      out.settings.push_back(fmt::format("{}: {}, was {}", key.text(), listed_values(now), listed_values(was->second)));
  }
}

std::string section(const std::string& heading, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string text = fmt::format("{}: {}\n", heading, lines.size());
  for (const std::string& line : lines) text += "  " + line + "\n";
  return text;
}

}  // namespace

Changes changes_between(const Baseline& old_baseline, const Baseline& new_baseline, double factor) {
  Changes out;
  for (const auto& [key, cell] : new_baseline.cells) {
    if (old_baseline.cells.contains(key)) compare_cells(key, old_baseline, new_baseline, factor, out);
  }
  compare_gates(old_baseline, new_baseline, out);
  compare_durations(old_baseline, new_baseline, out);
  compare_stable_steps(old_baseline, new_baseline, factor, out);
  for (const auto& [id, error] : new_baseline.case_errors) {
    if (!old_baseline.case_errors.contains(id)) out.newly_failing.push_back(fmt::format("{}: {}", id, error));
  }
  for (const auto& [id, error] : old_baseline.case_errors) {
    if (!new_baseline.case_errors.contains(id)) out.newly_passing.push_back(fmt::format("{}: was {}", id, error));
  }
  compare_settings(old_baseline, new_baseline, out);
  out.added = only_in(new_baseline, old_baseline), out.gone = only_in(old_baseline, new_baseline);
  return out;
}

std::string text_of(const Changes& changes, double factor) {
  std::string text = section("newly failing", changes.newly_failing) + section("newly passing", changes.newly_passing);
  text += section(fmt::format("worse by more than {:g} times", factor), changes.worse);
  text += section(fmt::format("better by more than {:g} times", factor), changes.better);
  text += section("no longer measured", changes.lost);
  text += section("run for less time", changes.shorter) + section("run for more time", changes.longer);
  text += section("settings that differ", changes.settings);
  text += section("gone", changes.gone) + section("added", changes.added);
  if (text.empty()) text = fmt::format("nothing changed by more than {:g} times\n", factor);
  return text + (changes.is_worse() ? "worse\n" : "not worse\n");
}

}  // namespace rigor::inline results
