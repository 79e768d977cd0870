#include "cases/report/console/console_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cases/report/console/console_matrix.h"
#include "cases/report/console/recorded_table.h"
#include "cases/report/layout.h"
#include "cases/report/wording/comparison.h"
#include "cases/report/wording/explained_error.h"
#include "cases/report/wording/explanations/explanation.h"
#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/recommendation.h"
#include "cases/report/wording/wording.h"
#include "cases/truth/provenance.h"

namespace rigor::inline report {
namespace {

const std::string kNoValue = "-";

std::string metric_text(const Cell& cell, const std::string& name, double MetricValue::*part) {
  const auto found = cell.metrics.find(name);
  if (found == cell.metrics.end() || !found->second.not_applicable.empty()) return kNoValue;
  return found->second.is_held_to_itself ? fmt::format("({})", rounded(found->second.*part))
                                         : rounded(found->second.*part);
}

// A drift in per cent of its scale, with its sign: lost energy is negative.
std::string percent_text(const Cell& cell, const std::string& name) {
  const auto found = cell.metrics.find(name);
  if (found == cell.metrics.end() || !found->second.not_applicable.empty()) return kNoValue;
  const MetricValue& drift = found->second;
  const double percent = 100 * std::copysign(drift.value, drift.worst.found - drift.worst.expected);
  if (!std::isfinite(percent)) return "not finite";
  if (std::abs(percent) < 1e-9) return "0";  // rounding
  return fmt::format("{}{}", percent > 0 ? "+" : "", rounded(percent));
}

// "1/960" where that is what it is.
std::string step_text(double seconds) {
  const double whole = std::round(1 / seconds);
  const bool is_fraction = std::abs(whole * seconds - 1) < 1e-9;
  return is_fraction ? fmt::format("1/{:.0f}", whole) : fmt::format("{:.3g}", seconds);
}

std::string stable_text(const StableStepResult& stable) {
  if (stable.status != Status::pass) return stable.status == Status::unsupported ? kNoValue : word_of(stable.status);
  return fmt::format("{}{}", stable.step.is_cap ? ">=" : stable.step.is_floor ? "<" : "", rounded(stable.step.dt));
}

std::string verdict_text(const Cell& cell, const Scene& scene) {
  if (cell.stability.verdict == Verdict::blown_up) {
    return fmt::format("blown up at {:.2f} s: {}", cell.stability.time, scene.body_name(cell.stability.body));
  }
  const std::string word = cell.status == Status::pass ? phrase_of(cell.stability) : word_of(cell.status);
  // Warnings below the table explain both signs.
  return word + (cell.reduced_order ? " ◐" : "") + (cell.sub_step ? " ÷" : "");
}

// Rows of six numbers behind a name need this width. Below it a name gets a line of its own.
constexpr std::size_t kWideTable = 100;
bool is_narrow() { return console_width() < kWideTable; }

// The first column of a table. A long name gets a line of its own.
std::string engine_column(const std::string& name) {
  constexpr std::size_t kColumn = 24;
  if (is_narrow()) return "  " + wrapped(name, 2) + "\n ";
  if (name.size() <= kColumn) return fmt::format("  {:<24}", name);
  return fmt::format("  {}\n  {:<24}", wrapped(name, 2), "");
}

std::string without_blanks_at_end(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string explained_text(const std::vector<ExplainedRow>& rows) {
  if (rows.empty()) return "";
  std::vector<ExplainedRow> lines = {
      {"error explained", "all [m]", "scheme", "rest", "[rad]", "scheme", "rest", "until [s]"}};
  lines.insert(lines.end(), rows.begin(), rows.end());
  std::string text;
  for (const ExplainedRow& row : lines) {
    const std::string numbers =
        fmt::format(" {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}", row.total, row.by_scheme, row.unexplained, row.rotation,
                    row.rotation_by_scheme, row.rotation_unexplained);
    text += is_narrow() ? fmt::format("  {}\n {}\n", wrapped(row.engine + ": " + row.until, 2), numbers)
                        : fmt::format("{}{}  {:>9}\n", engine_column(row.engine), numbers, row.until);
  }
  return text;
}

std::string table_line(const RowText& row) {
  const std::string numbers = fmt::format(" {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}", row.first_second, row.whole,
                                          row.orientation, row.energy, row.energy_synchronised, row.stable_dt);
  if (!is_narrow())
    return without_blanks_at_end(fmt::format("{}{}  {}", engine_column(row.engine), numbers, row.verdict));
  const std::string name = row.verdict.empty() ? row.engine : row.engine + ": " + row.verdict;
  return without_blanks_at_end(engine_column(name) + numbers);
}

// A run that blew up has no numbers of the whole run. Its verdict takes their place.
std::string blown_up_line(const RowText& row) {
  constexpr std::size_t kFourColumns = 34;
  if (is_narrow())
    return fmt::format("{} {:>8} {:>35} {:>8}\n", engine_column(row.engine + ": " + row.verdict), row.first_second, "",
                       row.stable_dt);
  return fmt::format("{} {:>8}  {:<34} {:>8}\n", engine_column(row.engine), row.first_second,
                     shortened(row.verdict, kFourColumns), row.stable_dt);
}

std::string header(const StepSize& dt) {
  RowText top{fmt::format("dt = {} s", dt.text), "position", "error", "orient.", "energy", "drift", "largest", ""};
  RowText bottom{"engine", "1 s [m]", "all [m]", "[rad]", "raw [%]", "sync [%]", "dt [s]", "verdict"};
  return table_line(top) + table_line(bottom);
}

std::string row_line(const RowText& row) {
  if (row.is_blown_up) return blown_up_line(row);
  if (row.has_numbers) return table_line(row);
  if (is_narrow()) return "  " + wrapped(row.engine + ": " + row.verdict, 4) + "\n";
  return engine_column(row.engine) + " " + wrapped(row.verdict, 27) + "\n";
}

// The gates that did not hold, or that say less than they seem to; those that no cell met only where asked for.
std::string gate_lines(const CaseResult& result, bool with_unchecked) {
  std::string lines;
  for (const GateResult& gate : result.gates) {
    if (!gate.caveat.empty())
      lines += "  " + wrapped(fmt::format("warning: {}, but {}", gate.text, gate.caveat), 4) + "\n";
    if (!is_failure(gate.answer) || (gate.answer == GateAnswer::not_checked && !with_unchecked)) continue;
    const std::string kind = kind_of(result.definition.gates[gate.gate]);
    lines += "  " + wrapped(fmt::format("{} {}: {}", kind, word_of(gate.answer), gate.text), 4) + "\n";
  }
  return lines;
}

// For a case without its own block.
std::string what_is_wrong(const CaseResult& result) {
  const std::string error = result.error.empty() ? "" : "  " + wrapped(result.error, 2) + "\n";
  return error + gate_lines(result, false);
}

// Runs that lack the same feature share one sentence.
std::string unsupported_lines(const Results& results, const CaseResult& result, const StepSize& dt) {
  // Grouped by reason, in their order; each sentence begins with the runs.
  const auto essence_of = [](const std::string& reason) {
    const std::size_t at = reason.find(" has no ");
    return at == std::string::npos ? reason : reason.substr(at + 5);
  };
  std::vector<std::pair<std::string, std::vector<const Cell*>>> groups;
  for (const Cell& cell : result.cells) {
    if (!(cell.dt == dt) || cell.status != Status::unsupported) continue;
    const auto known = std::find_if(groups.begin(), groups.end(),
                                    [&](const auto& group) { return group.first == essence_of(cell.reason); });
    if (known == groups.end()) {
      groups.push_back({essence_of(cell.reason), {&cell}});
    } else {
      known->second.push_back(&cell);
    }
  }
  std::string text;
  for (const auto& [reason, cells] : groups) {
    if (cells.size() == 1) {
      text += row_line(row_text(results, result, *cells.front()));
      continue;
    }
    std::vector<std::string> runs;
    for (const Cell* cell : cells) runs.push_back(results.runs[cell->run].text);
    text += "  " + wrapped(fmt::format("{} runs unsupported: {}: {}", runs.size(), reason, fmt::join(runs, ", ")), 4) +
            "\n";
  }
  return text;
}

// The table of one case at its coarsest step.
std::string table_of(const Results& results, const CaseResult& result, const StepSize& dt) {
  std::string text = header(dt);
  for (const Cell& cell : result.cells) {
    if (cell.dt == dt && cell.status != Status::unsupported) text += row_line(row_text(results, result, cell));
  }
  text += unsupported_lines(results, result, dt);
  for (const std::string& warning : cell_warnings(results, result, dt))
    text += "  " + wrapped("warning: " + warning, 4) + "\n";
  return text;
}

std::string title_of(const CaseResult& result) {
  return wrapped(fmt::format("{}: {}", result.definition.id, result.definition.title), 2) + "\n";
}

std::string full_block(const Results& results, const CaseResult& result) {
  const StepSize dt = coarsest_dt(result);
  std::string text = title_of(result) + "  " + wrapped(truth_sentence(result), 2) + "\n";
  for (const Message& message : explanations(results, result)) text += "  " + wrapped(message.text, 2) + "\n";
  text += table_of(results, result, dt) + explained_text(explained_rows(results, result, dt)) +
          recorded_table(results, result);
  for (const Message& message : work_precision_messages(results, result))
    text += "  " + wrapped(message.text, 2) + "\n";
  return text + gate_lines(result, true);
}

bool has_run_held_to_itself(const CaseResult& result) {
  const char* metric = result.definition.truth == "recording" ? "mean_position_error" : "position_error";
  return std::any_of(result.cells.begin(), result.cells.end(), [&](const Cell& cell) {
    const auto found = cell.metrics.find(metric);
    return found != cell.metrics.end() && found->second.is_held_to_itself;
  });
}

// The first reason, then the table: a screen.
std::string brief_block(const Results& results, const CaseResult& result) {
  const std::vector<Message> reasons = explanations(results, result);
  std::string text = title_of(result);
  if (!result.error.empty() || !result.truth) text += "  " + wrapped(truth_sentence(result), 2) + "\n";
  if (result.truth && !result.truth->caveat.empty())
    text += "  " + wrapped("warning: " + result.truth->caveat, 4) + "\n";
  if (!reasons.empty()) text += "  " + wrapped(reasons.front().text, 2) + "\n";
  if (has_run_held_to_itself(result)) text += "  In brackets: the truth comes from the run's own code.\n";
  text += table_of(results, result, coarsest_dt(result)) + recorded_table(results, result) + gate_lines(result, true);
  if (reasons.size() > 1)
    text += fmt::format("  {} more reason{}: --verbose\n", reasons.size() - 1, reasons.size() == 2 ? "" : "s");
  return text;
}

// The engine and step to take, then the problems found.
std::string answers_text(const Results& results, Detail detail) {
  constexpr std::size_t kMostInBrief = 6;
  std::string text;
  for (const CaseResult& result : results.cases) {
    if (const std::string other = not_the_same_robot(result.definition.losses); !other.empty())
      text += wrapped(fmt::format("{}: {}", result.definition.id, other), 2) + "\n";
  }
  const auto first = recommendation(results);
  if (first) text += wrapped(first->text + (first->more.empty() ? "" : " " + first->more), 2) + "\n";
  if (results.cases.size() < 2) return text.empty() ? "" : text + "\n";
  std::vector<Finding> found = findings(results);
  std::erase_if(found, [&](const Finding& one) { return first && one.topic == first->topic; });
  const std::size_t shown = detail == Detail::full ? found.size() : std::min(found.size(), kMostInBrief);
  for (std::size_t i = 0; i < shown; ++i)
    text += "- " + wrapped(fmt::format("{}: {}", found[i].topic, found[i].text), 2) + "\n";
  if (shown < found.size()) text += fmt::format("- {} more: --verbose\n", found.size() - shown);
  return text.empty() ? "" : text + "\n";
}

std::string count_line(const Results& results) {
  std::map<Status, int> counts;
  for (const CaseResult& result : results.cases) {
    for (const Cell& cell : result.cells) ++counts[cell.status];
  }
  std::string text;
  for (const auto& [status, count] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, word_of(status));
  return fmt::format("cells: {}\n", text);
}

}  // namespace

std::string truth_sentence(const CaseResult& result) {
  const Case& definition = result.definition;
  if (!result.error.empty()) return result.error;
  if (definition.truth == "none") return "truth: none; only stability and what is conserved are judged.";
  if (!result.truth) return fmt::format("truth: {}, not found.", definition.truth);
  const TruthFacts& facts = *result.truth;
  const std::string brackets = (has_run_held_to_itself(result) ? " What it finds of these stands in brackets." : "") +
                               std::string(facts.caveat.empty() ? "" : " ") + facts.caveat;
  if (definition.truth == "recording")
    return fmt::format("truth: recording; it is {}.{}", provenance_of(definition.truth), brackets);
  if (facts.horizon >= definition.duration) {
    return fmt::format("truth: {}, its own error at most {:.1e} m over the whole {:g} s; it is {}.{}", definition.truth,
                       facts.error_at_end, definition.duration, provenance_of(definition.truth), brackets);
  }
  return fmt::format("truth: {}, known to {:g} µm until {:.1f} s of the {:g} s; beyond that {}. It is {}.{}",
                     definition.truth, kHorizonTolerance * 1e6, facts.horizon, definition.duration,
                     facts.caveat.empty() ? "the motion is too sensitive" : "it is not known",
                     provenance_of(definition.truth), brackets);
}

std::vector<std::string> cell_warnings(const Results& results, const CaseResult& result, const StepSize& dt) {
  std::vector<std::string> warnings;
  for (const Cell& cell : result.cells) {
    if (cell.dt != dt) continue;
    if (cell.sub_step) {
      warnings.push_back(
          fmt::format("{} (÷) takes sub-steps of {} s. Its verdict and its largest dt hold for sub-steps",
                      results.runs[cell.run].text, step_text(*cell.sub_step)));
    }
    if (!cell.reduced_order) continue;
    warnings.push_back(fmt::format("{} (◐) is from {:.4g} s on stepped {}", results.runs[cell.run].text,
                                   cell.reduced_order->from, cell.reduced_order->how));
  }
  return warnings;
}

RowText row_text(const Results& results, const CaseResult& result, const Cell& cell) {
  RowText row;
  row.engine = results.runs[cell.run].text;
  row.has_numbers = !cell.metrics.empty() && cell.status != Status::invalid;
  row.stable_dt = stable_text(result.stable_steps[cell.run]);
  if (!row.has_numbers) {
    row.verdict = fmt::format("{}: {}", word_of(cell.status), cell.reason);
    return row;
  }
  row.verdict = verdict_text(cell, result.definition.scene);
  row.first_second = metric_text(cell, "position_error", &MetricValue::first_second);
  row.whole = metric_text(cell, "position_error", &MetricValue::value);
  row.orientation = metric_text(cell, "orientation_error", &MetricValue::value);
  row.energy = percent_text(cell, "energy_drift");
  row.energy_synchronised = percent_text(cell, "energy_drift_synchronised");
  row.is_blown_up = cell.stability.verdict == Verdict::blown_up;
  if (row.is_blown_up) {  // values up to the blow-up would look like the error of a whole run
    row.whole = row.orientation = row.energy = row.energy_synchronised = kNoValue;
    if (cell.stability.time < 1) row.first_second = kNoValue;
  }
  return row;
}

namespace {

// The selection on the command line may leave out gates, and all gates of a case with them.
std::string unjudged_text(const Results& results) {
  std::size_t bounds = 0;
  std::vector<std::string> cases;
  for (const CaseResult& result : results.cases) {
    std::set<std::size_t> answered;
    for (const GateResult& answer : result.gates) {
      if (answer.answer != GateAnswer::not_recorded) answered.insert(answer.gate);
    }
    const std::vector<Gate>& gates = result.definition.gates;
    for (std::size_t i = 0; i < gates.size(); ++i)
      bounds += !gates[i].is_of_family && !gates[i].regression() && !answered.contains(i);
    const bool has_run = std::any_of(result.cells.begin(), result.cells.end(),
                                     [](const Cell& cell) { return cell.status != Status::unsupported; });
    if (answered.empty() && !gates.empty() && has_run) cases.push_back(result.definition.id);
  }
  std::string text;
  if (bounds > 0) text += fmt::format("bounds of other runs or steps than were asked for: {}\n", bounds);
  if (!cases.empty()) text += wrapped(fmt::format("no gate judged {}", fmt::join(cases, ", ")), 2) + "\n";
  return text;
}

}  // namespace

std::string gate_summary(const Results& results) {
  using Counts = std::map<GateAnswer, int>;
  std::map<std::string, Counts> counts;
  int with_caveat = 0;
  for (const CaseResult& result : results.cases) {
    for (const GateResult& answer : result.gates) {
      ++counts[kind_of(result.definition.gates[answer.gate])][answer.answer];
      with_caveat += !answer.caveat.empty();
    }
  }
  const auto line = [](const std::string& what, Counts& of) {
    std::string text = fmt::format("{}: {} held, {} failed, {} not checked", what, of[GateAnswer::held],
                                   of[GateAnswer::failed], of[GateAnswer::not_checked]);
    for (const auto& [answer, words] : {std::pair{GateAnswer::known_deviation, "known deviations"},
                                        {GateAnswer::unexpected_pass, "unexpected passes"},
                                        {GateAnswer::not_recorded, "without a recorded value"}}) {
      if (of[answer] > 0) text += fmt::format(", {} {}", of[answer], words);
    }
    return text + "\n";
  };
  std::string bounds = line("bounds", counts["bound"]);
  if (with_caveat > 0)
    bounds += fmt::format("warning: {} of them held by runs that were stepped in part by less than their method\n",
                          with_caveat);
  return bounds + (counts.contains("regression") ? line("regressions", counts["regression"]) : "") +
         unjudged_text(results);
}

std::string console_table(const Results& results, Detail detail) {
  constexpr std::size_t kMostInFull = 6;  // cases: a few screens
  const bool has_blocks = results.cases.size() <= kMostInFull;
  std::string text = answers_text(results, detail);
  if (!has_blocks) text += console_matrix(results) + "\n";
  for (const CaseResult& result : results.cases) {
    if (has_blocks)
      text += (detail == Detail::full ? full_block(results, result) : brief_block(results, result)) + "\n";
    const std::string short_of = has_blocks ? "" : what_is_wrong(result);
    if (!short_of.empty()) text += result.definition.id + "\n" + short_of;
  }
  if (!has_blocks) text += "each case in full: report.html, report.md, or `rigor run CASE`\n";
  return text + count_line(results);
}

std::string failures_text(const std::vector<Failure>& rows, const std::string& diagnose) {
  if (rows.empty()) return "";
  std::string text = fmt::format("what fell short: {}\n", rows.size());
  for (const Failure& row : rows) {
    std::string line = row.case_id;
    if (!row.engine.empty()) line += fmt::format(", {}", row.engine);
    if (!row.dt.empty()) line += fmt::format(", dt = {} s", row.dt);
    line += fmt::format(": {}", row.what);
    if (!row.found.empty()) line += fmt::format(" {}", row.found);
    if (!row.limit.empty()) line += fmt::format("; wanted: {}", row.limit);
    if (!row.worst.empty()) line += fmt::format("; worst {}", row.worst);
    if (!row.because.empty()) line += fmt::format("; because: {}", row.because);
    if (!row.where.empty()) line += fmt::format(" [{}]", row.where);
    text += "  " + wrapped(line, 4) + "\n";
  }
  return diagnose.empty() ? text : text + "  to find a known mistake that explains it:\n  " + diagnose + "\n";
}

}  // namespace rigor::inline report
