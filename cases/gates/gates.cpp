#include "cases/gates/gates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "adapters/engines.h"
#include "cases/case/selection.h"
#include "cases/gates/single_precision.h"
#include "cases/metrics/held_to_itself.h"
#include "cases/results/baseline.h"
#include "cases/results/observed_order.h"
#include "cases/truth/provenance.h"

namespace rigor::inline gates {
namespace {

// One gate over one case.
class GateCheck {
 public:
  GateCheck(CaseResult& result, const Results& grid, const RecordedValues& recorded, Asked asked, std::size_t index)
      : result_(result),
        grid_(grid),
        recorded_(recorded),
        asked_(asked),
        index_(index),
        gate_(result.definition.gates[index]),
        selection_(gate_, grid.engines),
        unit_(unit_after(gate_.metric)) {}

  void check() {
    const std::size_t before = result_.gates.size();
    if (gate_.metric == "observed_order") {
      fail_what_has_no_result();
      for (std::size_t run = 0; run < grid_.runs.size(); ++run) check_observed_order(run);
    } else if (is_spread()) {
      fail_what_has_no_result();
      for (const Spread& spread : result_.spreads) check_spread(spread);
    } else if (gate_.order()) {
      for (std::size_t run = 0; run < grid_.runs.size(); ++run) check_order(run);
    } else {
      for (Cell& cell : result_.cells) {
        if (!selects(cell)) continue;
        gate_.regression() ? check_regression(cell) : gate_.ranking() ? check_ranking(cell) : check_cell(cell);
      }
    }
    if (result_.gates.size() == before && !gate_.is_of_family && (asked_ == Asked::all || is_asked())) {
      add("", "", GateAnswer::not_checked,
          fmt::format("{}: no cell that ran has {} for this gate to judge{}", gate_.where, gate_.metric,
                      engine_to_ask_for()));
    }
  }

 private:
  // The engine that the gate names and that runs on request alone, where nobody asked.
  std::string engine_to_ask_for() const {
    for (const EngineOnRequest& engine : engines_on_request()) {
      const auto is_it = [&](const std::string& run) { return run.starts_with(engine.name); };
      const bool is_there =
          std::any_of(grid_.runs.begin(), grid_.runs.end(), [&](const RunName& r) { return is_it(r.engine); });
      if (!is_there && std::any_of(gate_.engines.begin(), gate_.engines.end(), is_it))
        return fmt::format("; {0} runs where it is asked for: --engine {0}", engine.name);
    }
    return "";
  }
  // Whether the selected cells could answer the gate. Runs and steps that were not selected do not count, nor features
  // that an engine lacks.
  bool is_asked() const {
    std::map<std::size_t, std::size_t> steps;  // by run
    for (const Cell& cell : result_.cells) {
      if (selects(cell)) ++steps[cell.run];
    }
    if (is_spread()) return steps.size() > 1;
    if (const RankingLimit* ranking = gate_.ranking()) {
      const RunName other = parse_run_name(ranking->better_than, grid_.engines);
      const auto is_there = [&](const Cell& cell) {
        return cell.status != Status::unsupported && is_same_run(grid_.runs[cell.run], other);
      };
      if (std::none_of(result_.cells.begin(), result_.cells.end(), is_there)) return false;
    }
    const std::size_t fewest = gate_.order() || gate_.metric == "observed_order" ? 2 : 1;
    return std::any_of(steps.begin(), steps.end(), [&](const auto& of_run) { return of_run.second >= fewest; });
  }
  bool is_spread() const { return gate_.metric == "spread" || gate_.metric == "spread_orientation"; }
  bool selects(std::size_t run) const { return selection_.takes(grid_.runs[run]) && !is_made_like_truth(run); }
  bool selects(const StepSize& dt) const { return selection_.takes(dt); }
  bool selects(const Cell& cell) const {
    return cell.status != Status::unsupported && selects(cell.run) && selects(cell.dt);
  }
  // A gate that names no runs passes over those that come from the same code as the truth.
  bool is_made_like_truth(std::size_t run) const {
    return is_case_held_to_itself(result_.definition, gate_.metric, grid_.runs[run]);
  }
  const std::string& name_of(const Cell& cell) const { return grid_.runs[cell.run].text; }

  bool is_single(std::size_t run) const {
    return std::any_of(grid_.engines.begin(), grid_.engines.end(), [&](const EngineInfo& engine) {
      return engine.name == grid_.runs[run].engine && engine.precision == "single";
    });
  }
  // The amount by which a run's limits are wider than the gate's, in the metric's unit.
  double allowance(std::size_t run, const StepSize& dt) const {
    return is_single(run) ? single_precision_allowance(result_, dt.seconds, unit_.empty() ? "1" : unit_.substr(1)) : 0;
  }
  std::string allowed(double allowance) const {
    return allowance > 0 ? fmt::format(" (limit wider by {:.3g}{}, for single precision)", allowance, unit_) : "";
  }

  void add(const std::string& engine, const std::string& dt, GateAnswer answer, const std::string& text,
           std::optional<double> value = {}, const std::optional<Instant>& worst = {}, const std::string& caveat = "") {
    result_.gates.push_back({index_, engine, dt, answer, text, value, worst, caveat});
  }

  // For a gate that held: the time from which the cell, or one of the run's cells with the metric, was not stepped by
  // its own method. `cost` is exempt.
  std::string caveat_of(const Cell& cell) const {
    if (!cell.reduced_order || gate_.metric == "cost") return "";
    const auto metric = cell.metrics.find(gate_.metric);
    if (metric != cell.metrics.end() && metric->second.compared_until <= cell.reduced_order->from) return "";
    return fmt::format("at dt = {} from {:.4g} s on stepped {}", cell.dt.text, cell.reduced_order->from,
                       cell.reduced_order->how);
  }
  std::string caveat_of_run(std::size_t run) const {
    std::string caveat;
    for (const Cell& cell : result_.cells) {
      const std::string of_cell = cell.run == run && selects(cell) ? caveat_of(cell) : "";
      if (!of_cell.empty()) caveat += (caveat.empty() ? "" : "; ") + of_cell;
    }
    return caveat;
  }
  std::string because() const { return gate_.because.empty() ? "" : fmt::format(" (the gate: {})", gate_.because); }

  // Whether the cell has a value of the metric to judge; if not for a reason that is its own fault, the gate fails.
  const MetricValue* value_to_judge(const Cell& cell, const std::string& head) {
    if (cell.status != Status::pass && cell.status != Status::fail && cell.status != Status::diverged) {
      add(name_of(cell), cell.dt.text, GateAnswer::failed,
          fmt::format("{} cannot be judged, for the cell is {}: {}{}", head, word_of(cell.status), cell.reason,
                      because()));
      return nullptr;
    }
    const auto found = cell.metrics.find(gate_.metric);
    return found == cell.metrics.end() || !found->second.not_applicable.empty() ? nullptr : &found->second;
  }

  void fail(Cell& cell, const std::string& text, const MetricValue& metric) {
    add(name_of(cell), cell.dt.text, GateAnswer::failed, text, metric.value, metric.worst);
    if (cell.status == Status::pass) cell.status = Status::fail, cell.reason = text;
  }

  void check_cell(Cell& cell) {
    const std::string head = fmt::format("{} of {} at dt = {}", gate_.metric, name_of(cell), cell.dt.text);
    const MetricValue* metric = value_to_judge(cell, head);
    if (!metric) return;
    const std::string fault = fault_of(cell, *metric);
    if (!fault.empty())
      return fail(cell, fmt::format("{} {}; {}{}", head, fault, worst_of(*metric), because()), *metric);
    add(name_of(cell), cell.dt.text, GateAnswer::held,
        fmt::format("{} is {:.6g}{}{}", head, metric->value, unit_, allowed(allowance(cell.run, cell.dt))),
        metric->value, metric->worst, caveat_of(cell));
  }

  // A run that blew up, or did not do what its method promises, has no value to hold or to record.
  void check_regression(Cell& cell) {
    const std::string head = fmt::format("{} of {} at dt = {}", gate_.metric, name_of(cell), cell.dt.text);
    const auto was = recorded_.find(result_.definition.id, grid_.runs[cell.run], cell.dt.seconds, gate_.metric);
    if (!was && cell.status == Status::invalid)
      return add(name_of(cell), cell.dt.text, GateAnswer::not_recorded, head + " is none, and none is recorded");
    const MetricValue* metric = value_to_judge(cell, head);
    if (!metric) return;
    const bool blew_up = cell.status == Status::diverged;
    if (!was) {
      return add(name_of(cell), cell.dt.text, GateAnswer::not_recorded,
                 fmt::format("{} is {:.6g}{}, and none is recorded", head, metric->value, unit_),
                 blew_up ? std::nullopt : std::optional(metric->value), metric->worst);
    }
    const std::string change = blew_up ? "of no meaning, for the run is " + cell.reason
                                       : change_from(*was, metric->value, gate_.regression()->factor);
    const std::string both = fmt::format("{} is {:.6g}{}, was {:.6g}{}", head, metric->value, unit_, *was, unit_);
    if (!change.empty())
      return fail(cell, fmt::format("{}: {}; {}{}", both, change, worst_of(*metric), because()), *metric);
    add(name_of(cell), cell.dt.text, GateAnswer::held, both, metric->value, metric->worst);
  }

  // A run that blew up is worse than any that did not; of two that did neither is better.
  void check_ranking(Cell& cell) {
    const RunName other_run = parse_run_name(gate_.ranking()->better_than, grid_.engines);
    const auto other = std::find_if(result_.cells.begin(), result_.cells.end(), [&](const Cell& c) {
      return is_same_run(grid_.runs[c.run], other_run) && c.dt == cell.dt;
    });
    if (other == result_.cells.end() || other->status == Status::unsupported) return;
    const std::string head = fmt::format("{} of {} at dt = {}", gate_.metric, name_of(cell), cell.dt.text);
    const MetricValue *mine = value_to_judge(cell, head), *its = mine ? value_to_judge(*other, head) : nullptr;
    if (!mine || !its) return;
    const bool blew_up = cell.status == Status::diverged, other_blew_up = other->status == Status::diverged;
    const bool is_ahead = is_higher_better(gate_.metric) ? mine->value > its->value : mine->value < its->value;
    const std::string ends = fmt::format("{:.6g}{}{}", mine->value, unit_, blew_up ? ", having blown up" : ""),
                      theirs = fmt::format("{:.6g}{} of {}{}", its->value, unit_, other_run.text,
                                           other_blew_up ? ", which blew up" : "");
    if (!blew_up && (other_blew_up || is_ahead)) {
      return add(name_of(cell), cell.dt.text, GateAnswer::held,
                 fmt::format("{} is {}, better than the {}", head, ends, theirs), mine->value, mine->worst,
                 caveat_of(cell));
    }
    fail(cell, fmt::format("{} is {}, not better than the {}; {}{}", head, ends, theirs, worst_of(*mine), because()),
         *mine);
  }

  // What is wrong with a cell's value, or "". No value of a run that blew up is good, though a bad one may be asked
  // for.
  std::string fault_of(const Cell& cell, const MetricValue& metric) const {
    const std::string fault = fault_of(metric.value, allowance(cell.run, cell.dt));
    const BoundLimit bound = gate_.bound();
    const bool asks_for_good = is_higher_better(gate_.metric) ? bound.min.has_value() : bound.max.has_value();
    if (!fault.empty() || !asks_for_good || cell.status != Status::diverged) return fault;
    return "is of no meaning, for the run is " + cell.reason;
  }

  // Comparisons are written so that a value that is no number never holds.
  std::string fault_of(double value, double allowance) const {
    const auto [max, min, equals] = gate_.bound();
    if (max && !(value <= *max + allowance)) {
      return fmt::format("is {:.6g}{}, above the limit of {:g}{}{}", value, unit_, *max, unit_, allowed(allowance));
    }
    if (min && !(value >= *min - allowance)) {
      return fmt::format("is {:.6g}{}, below the limit of {:g}{}{}", value, unit_, *min, unit_, allowed(allowance));
    }
    if (equals && !(std::abs(value - *equals) <= allowance + kRounding * std::max(1.0, std::abs(*equals)))) {
      return fmt::format("is {:.17g}{}, not {:.17g}{} to within {:g}{}", value, unit_, *equals, unit_, kRounding,
                         allowed(allowance));
    }
    return "";
  }

  std::string worst_of(const MetricValue& metric) const {
    const Instant& worst = metric.worst;
    return fmt::format("worst at {:.6g} s: {}, {}: found {:.9g}, expected {:.9g}", worst.time,
                       result_.definition.scene.body_name(worst.body), worst.component, worst.found, worst.expected);
  }

  void answer(const std::string& engine, const std::string& dt, const std::string& head, double value,
              const std::string& detail, const std::string& caveat, double allowance = 0) {
    const std::string fault = fault_of(value, allowance);
    if (fault.empty())
      return add(engine, dt, GateAnswer::held, fmt::format("{} is {:.6g}{}", head, value, unit_), value, {}, caveat);
    add(engine, dt, GateAnswer::failed, fmt::format("{} {}; {}{}", head, fault, detail, because()), value);
  }

  static bool has_result(const Cell& cell) { return cell.status == Status::pass || cell.status == Status::fail; }

  // For metrics measured across cells.
  void fail_what_has_no_result() {
    for (const Cell& cell : result_.cells) {
      if (!selects(cell) || has_result(cell)) continue;
      add(name_of(cell), cell.dt.text, GateAnswer::failed,
          fmt::format("{} of {} at dt = {} cannot be judged, for the cell is {}: {}", gate_.metric, name_of(cell),
                      cell.dt.text, word_of(cell.status), cell.reason));
    }
  }

  // A run without an order (its errors are roundings, say) the gate does not meet.
  void check_observed_order(std::size_t run) {
    const auto worth = errors_worth_comparing(result_);
    if (!selects(run) || worth.empty()) return;
    const auto is_selected = [this](const StepSize& dt) { return selects(dt); };
    const ObservedOrder order = observed_order(result_, run, worth.front(), is_selected);
    if (!order.value) return;
    const std::string& name = grid_.runs[run].text;
    answer(name, "", fmt::format("observed_order of {}", name), *order.value, worth.front() + " " + order.text,
           caveat_of_run(run));
  }

  // The answer stands with the first run of the pair.
  void check_spread(const Spread& spread) {
    if (spread.is_own_step() || !selects(spread.first) || !selects(spread.second) || !selects(spread.dt)) return;
    const bool both_have_results = std::all_of(result_.cells.begin(), result_.cells.end(), [&](const Cell& cell) {
      const bool is_of_pair = cell.run == spread.first || cell.run == spread.second;
      return !is_of_pair || cell.dt != spread.dt || has_result(cell);
    });
    if (!both_have_results) return;
    const Furthest& worst = gate_.metric == "spread" ? spread.distance : spread.angle;
    const std::string &one = grid_.runs[spread.first].text, &other = grid_.runs[spread.second].text;
    answer(one, spread.dt.text, fmt::format("{} of {} and {} at dt = {}", gate_.metric, one, other, spread.dt.text),
           worst.value,
           fmt::format("worst at {:.6g} s: {}", worst.time, result_.definition.scene.body_name(worst.body)), "",
           std::max(allowance(spread.first, spread.dt), allowance(spread.second, spread.dt)));
  }

  // The required order: the gate's own, or the one that the method declares. An adaptive method declares none.
  std::optional<double> wanted_order(std::size_t run) const {
    const OrderLimit& order = *gate_.order();
    if (!order.is_declared) return order.at_least;
    const RunName& name = grid_.runs[run];
    for (const EngineInfo& engine : grid_.engines) {
      if (engine.name != name.engine) continue;
      const MethodInfo& method = method_of(engine, name.settings);
      if (!method.adaptive) return method.order - order.at_least;
    }
    return std::nullopt;
  }

  // A gate over all methods must ignore steps at which a method is not yet in its asymptotic range, and steps at which
  // only rounding remains.
  bool shows_order(double error, double of_precision) const {
    constexpr double kLarge = 0.03, kRoundings = 1e-10;  // m, rad: the second after thousands of steps
    return !gate_.order()->is_declared ||
           (error < kLarge && error > std::max({kRoundings, 100 * error_floor(result_), of_precision}));
  }

  void check_order(std::size_t run) {
    const std::optional<double> wanted = wanted_order(run);
    if (!wanted) return;
    std::vector<double> dt, values;
    std::string table;
    const Cell* worst = nullptr;
    for (const Cell& cell : result_.cells) {
      if (cell.run != run || !selects(cell)) continue;
      const auto found = cell.metrics.find(gate_.metric);
      if (found != cell.metrics.end() && !found->second.not_applicable.empty()) continue;
      // A step that is too long for a method says nothing of the order that it declares.
      if (gate_.order()->is_declared && cell.status == Status::diverged) continue;
      if (found == cell.metrics.end() || (cell.status != Status::pass && cell.status != Status::fail)) {
        add(grid_.runs[run].text, "", GateAnswer::failed,
            fmt::format("the order of {} of {} cannot be judged, for the cell at dt = {} is {}: {}", gate_.metric,
                        grid_.runs[run].text, cell.dt.text, word_of(cell.status), cell.reason));
        return;
      }
      if (!shows_order(found->second.value, allowance(run, cell.dt))) continue;
      dt.push_back(cell.dt.seconds), values.push_back(found->second.value);
      table += fmt::format("{}{:.4g} at {}", table.empty() ? "" : ", ", found->second.value, cell.dt.text);
      if (!worst || found->second.value > worst->metrics.at(gate_.metric).value) worst = &cell;
    }
    if (dt.size() < 2) return;
    const double order = fitted_order(dt, values);
    const std::string head =
        fmt::format("the observed order of {} of {} is {:.3g} ({})", gate_.metric, grid_.runs[run].text, order, table);
    if (order >= *wanted) {
      add(grid_.runs[run].text, "", GateAnswer::held, head, order, {}, caveat_of_run(run));
    } else {
      add(grid_.runs[run].text, "", GateAnswer::failed,
          fmt::format("{}, below {:g}; {}{}", head, *wanted, worst_of(worst->metrics.at(gate_.metric)), because()),
          order, worst->metrics.at(gate_.metric).worst);
    }
  }

  CaseResult& result_;
  const Results& grid_;
  const RecordedValues& recorded_;
  Asked asked_;
  std::size_t index_;
  const Gate& gate_;
  GateSelection selection_;
  std::string unit_;
};

}  // namespace

void check_gates(CaseResult& result, const Results& grid, const RecordedValues& recorded, Asked asked) {
  result.gates.clear();
  for (std::size_t i = 0; i < result.definition.gates.size(); ++i) GateCheck(result, grid, recorded, asked, i).check();
}

bool is_any_judged(const Results& grid) {
  return std::any_of(grid.cases.begin(), grid.cases.end(), [](const CaseResult& result) {
    return std::any_of(result.gates.begin(), result.gates.end(), [](const GateResult& gate) {
      return gate.answer != GateAnswer::not_checked && gate.answer != GateAnswer::not_recorded;
    });
  });
}

bool all_gates_hold(const Results& grid) {
  return std::all_of(grid.cases.begin(), grid.cases.end(), [](const CaseResult& result) {
    return result.error.empty() && std::none_of(result.gates.begin(), result.gates.end(),
                                                [](const GateResult& gate) { return is_failure(gate.answer); });
  });
}

std::string unit_after(const std::string& metric) {
  const std::string unit = unit_of_metric(metric);
  return unit.empty() || unit == "1" ? "" : " " + unit;
}

}  // namespace rigor::inline gates
