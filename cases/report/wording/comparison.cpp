#include "cases/report/wording/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/analysis/work_precision.h"

namespace rigor::inline report {
namespace {

const std::string kNone = "-";

// "position" of "position_error".
std::string kind_of(const std::string& metric) { return metric.substr(0, metric.find('_')); }
std::string unit_of(const std::string& metric) { return metric == "position_error" ? "m" : "rad"; }

// ~: extrapolated to a longer step; >=: it could spend the rest of the time on smaller ones.
const char* mark_of(Reach reach) { return reach == Reach::extrapolated ? "~" : reach == Reach::at_most ? ">=" : ""; }

std::string times_text(const EqualCost& point) {
  return point.of_run ? fmt::format("{}{:.2g}", mark_of(point.of_run->reach), point.times_less()) : kNone;
}

TextTable errors_and_costs(const Results& results, const CaseResult& result, const std::string& metric) {
  TextTable table{
      fmt::format("{} error [{}] at a cost in CPU time per simulated time [µs/s]", kind_of(metric), unit_of(metric)),
      {{"engine", "order"}}};
  for (const StepSize& dt : result.definition.dt) table.rows[0].push_back(fmt::format("dt = {} s", dt.text));
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    const auto points = error_points(result, run, metric);
    if (points.empty()) continue;
    const ObservedOrder order = observed_order(result, run, metric);
    std::vector<std::string> row = {results.runs[run].text, order.value ? fmt::format("{:.2f}", *order.value) : kNone};
    for (const StepSize& dt : result.definition.dt) {
      const auto at = std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.dt == dt; });
      row.push_back(at == points.end() ? kNone : fmt::format("{:.2g} at {:.3g}", at->error, 1e6 * at->cost));
    }
    table.rows.push_back(row);
  }
  return table;
}

TextTable times_less(const Results& results, const CaseResult& result, const std::string& metric) {
  TextTable table{fmt::format("times less {} error at equal cost (~ extrapolated, >= at least)", kind_of(metric)),
                  {{"engine"}}};
  for (const std::size_t baseline : baselines(results)) {
    for (const ErrorPoint& point : error_points(result, baseline, metric))
      table.rows[0].push_back(fmt::format("than {} at {}", results.runs[baseline].text, point.dt.text));
  }
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    if (error_points(result, run, metric).empty()) continue;
    std::vector<std::string> row = {results.runs[run].text};
    for (const std::size_t baseline : baselines(results)) {
      for (const EqualCost& point : at_equal_cost(result, run, baseline, metric))
        row.push_back(run == baseline ? "1" : times_text(point));
    }
    table.rows.push_back(row);
  }
  return table;
}

bool blew_up(const CaseResult& result, std::size_t run, const StepSize& dt) {
  return std::any_of(result.cells.begin(), result.cells.end(), [&](const Cell& cell) {
    return cell.run == run && cell.dt == dt && cell.status == Status::diverged;
  });
}

TextTable spread_table(const Results& results, const CaseResult& result) {
  const StepSize dt = coarsest_dt(result);
  std::vector<std::size_t> runs;  // those that are in a pair
  std::vector<const Spread*> pairs;
  for (const Spread& spread : result.spreads) {
    if (spread.is_own_step()) continue;
    if (spread.dt != dt || blew_up(result, spread.first, dt) || blew_up(result, spread.second, dt)) continue;
    pairs.push_back(&spread);
    for (const std::size_t run : {spread.first, spread.second}) {
      if (std::find(runs.begin(), runs.end(), run) == runs.end()) runs.push_back(run);
    }
  }
  std::sort(runs.begin(), runs.end());
  TextTable table{
      fmt::format("largest distance [m] between runs at dt = {} s; below the diagonal the time [s] at which "
                  "they part by {:g} m or {:g} rad",
                  dt.text, kPartedBy, kPartedByTurn),
      {{"engine"}}};
  for (const std::size_t run : runs) table.rows[0].push_back(results.runs[run].text);
  for (const std::size_t run : runs) {
    table.rows.emplace_back(runs.size() + 1, "").front() = results.runs[run].text;
  }
  const auto row_of = [&](std::size_t run) { return 1 + std::find(runs.begin(), runs.end(), run) - runs.begin(); };
  for (const Spread* pair : pairs) {
    const auto a = row_of(pair->first), b = row_of(pair->second);
    table.rows[a][b] = fmt::format("{:.2g}", pair->distance.value);
    table.rows[b][a] = pair->parted_at ? fmt::format("{:.3g}", *pair->parted_at) : "never";
  }
  return table;
}

// The comparable cell of the baseline with the coarsest step.
const EqualCost& coarsest_of(const BestOfCore& best) {
  const EqualCost* coarsest = nullptr;
  for (const EqualCost& point : best.points) {
    if (point.of_run && (!coarsest || point.of_baseline.dt.seconds > coarsest->of_baseline.dt.seconds))
      coarsest = &point;
  }
  return *coarsest;
}

std::string gains_text(const Results& results, const CaseResult& result, const BestOfCore& best, Claims& claims) {
  std::string text;
  for (const EqualCost& point : best.points) {
    std::string number = kNone;
    if (point.of_run) {
      const std::string& core = results.runs[point.run].text;
      const std::string part = best.metric + " " + results.runs[point.baseline].text;
      const Claim claim{"times less at equal cost", result.definition.id, core, point.of_baseline.dt.text, part,
                        point.times_less()};
      number = mark_of(point.of_run->reach) + claims.quantity(claim, "");
    }
    text += fmt::format("{}{} at {}{} s", text.empty() ? "" : ", ", number, text.empty() ? "dt = " : "",
                        point.of_baseline.dt.text);
  }
  return text;
}

Message message_of(const Results& results, const CaseResult& result, const BestOfCore& best) {
  const EqualCost& coarsest = coarsest_of(best);
  const std::string unit = unit_of(best.metric);
  const ErrorPoint& point = coarsest.of_baseline;
  const std::string &baseline = results.runs[coarsest.baseline].text, &core = results.runs[coarsest.run].text;
  const auto claim = [&](const std::string& quantity, const std::string& run, double value, const std::string& part) {
    return Claim{quantity, result.definition.id, run, point.dt.text, part, value};
  };
  Claims claims;
  const std::string kind = kind_of(best.metric);
  std::string text =
      fmt::format("{} at dt = {} s takes {} a step; its {} error is {}.", baseline, point.dt.text,
                  claims.quantity(claim("cost of a step", baseline, point.cost * point.dt.seconds, ""), "s"), kind,
                  claims.quantity(claim("error of " + best.metric, baseline, point.error, ""), unit));
  text += fmt::format(
      " At the same cost {} has {}{}.", core, coarsest.of_run->reach == Reach::extrapolated ? "~" : "",
      claims.quantity(claim("error at equal cost", core, coarsest.of_run->error, best.metric + " " + baseline), unit));
  text += fmt::format(" Times less error at equal cost: {}.", gains_text(results, result, best, claims));
  return {"equal cost", text, "", claims.take()};
}

}  // namespace

std::vector<TextTable> comparison_tables(const Results& results, const CaseResult& result) {
  std::vector<TextTable> tables;
  for (const std::string& metric : errors_worth_comparing(result)) {
    tables.push_back(errors_and_costs(results, result, metric));
    tables.push_back(times_less(results, result, metric));
  }
  tables.push_back(spread_table(results, result));
  std::erase_if(tables, [](const TextTable& table) { return table.rows.size() < 2 || table.rows[0].size() < 2; });
  return tables;
}

std::vector<Message> work_precision_messages(const Results& results, const CaseResult& result) {
  std::vector<Message> messages;
  for (const std::size_t baseline : baselines(results)) {
    std::optional<BestOfCore> tightest;
    for (const std::string& metric : errors_worth_comparing(result)) {
      const auto best = best_of_core(results, result, baseline, metric);
      if (best && (!tightest || best->mean() < tightest->mean())) tightest = best;
    }
    if (tightest) messages.push_back(message_of(results, result, *tightest));
  }
  return messages;
}

}  // namespace rigor::inline report
