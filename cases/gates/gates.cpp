#include "cases/gates/gates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigor {
namespace {

bool is_same_run(const RunName& a, const RunName& b) {
  return a.engine == b.engine && a.settings.method == b.settings.method && a.settings.options == b.settings.options &&
         a.settings.track == b.settings.track;
}

std::string unit_of(const std::string& metric) {
  for (const MetricRow& row : metrics()) {
    if (row.name == metric) return row.unit == "1" ? "" : " " + row.unit;
  }
  return "";
}

// One gate over one case.
class GateCheck {
 public:
  GateCheck(CaseResult& result, const Results& grid, std::size_t index)
      : result_(result),
        grid_(grid),
        index_(index),
        gate_(result.definition.gates[index]),
        unit_(unit_of(gate_.metric)) {}

  void check() {
    const std::size_t before = result_.gates.size();
    if (gate_.at_least_order) {
      for (std::size_t run = 0; run < grid_.runs.size(); ++run) check_order(run);
    } else {
      for (Cell& cell : result_.cells) check_cell(cell);
    }
    if (result_.gates.size() == before) {
      add("", "", GateAnswer::not_checked,
          fmt::format("{}: no cell that ran has {} for this gate to judge", gate_.where, gate_.metric));
    }
  }

 private:
  bool selects(std::size_t run) const {
    return gate_.engines.empty() ||
           std::any_of(gate_.engines.begin(), gate_.engines.end(), [&](const std::string& name) {
             return is_same_run(parse_run_name(name, grid_.engines), grid_.runs[run]);
           });
  }
  bool selects(const Cell& cell) const {
    // "1/30" and "0.0333333333333333" are the same step.
    const auto is_its_dt = [&](const StepSize& dt) {
      return std::abs(dt.seconds - cell.dt.seconds) <= 1e-9 * dt.seconds;
    };
    return cell.status != Status::unsupported && selects(cell.run) &&
           (gate_.dt.empty() || std::any_of(gate_.dt.begin(), gate_.dt.end(), is_its_dt));
  }
  const std::string& name_of(const Cell& cell) const { return grid_.runs[cell.run].text; }

  void add(const std::string& engine, const std::string& dt, GateAnswer answer, const std::string& text) {
    result_.gates.push_back({index_, engine, dt, answer, text});
  }
  std::string because() const { return gate_.because.empty() ? "" : fmt::format(" (the gate: {})", gate_.because); }

  void check_cell(Cell& cell) {
    if (!selects(cell)) return;
    const std::string head = fmt::format("{} of {} at dt = {}", gate_.metric, name_of(cell), cell.dt.text);
    if (cell.status != Status::pass && cell.status != Status::fail && cell.status != Status::diverged) {
      add(name_of(cell), cell.dt.text, GateAnswer::failed,
          fmt::format("{} cannot be judged, for the cell is {}: {}", head, word_of(cell.status), cell.reason));
      return;
    }
    const auto found = cell.metrics.find(gate_.metric);
    if (found == cell.metrics.end() || !found->second.not_applicable.empty()) return;
    const std::string fault = fault_of(cell, found->second);
    if (fault.empty()) {
      add(name_of(cell), cell.dt.text, GateAnswer::held,
          fmt::format("{} is {:.6g}{}", head, found->second.value, unit_));
      return;
    }
    const std::string text = fmt::format("{} {}; {}{}", head, fault, worst_of(found->second), because());
    add(name_of(cell), cell.dt.text, GateAnswer::failed, text);
    if (cell.status == Status::pass) cell.status = Status::fail, cell.reason = text;
  }

  // What is wrong with the value, or "". Comparisons are written so that a value that is no number never holds.
  std::string fault_of(const Cell& cell, const MetricValue& metric) const {
    const double value = metric.value;
    if (gate_.max && !(value <= *gate_.max)) {
      return fmt::format("is {:.6g}{}, above the limit of {:g}{}", value, unit_, *gate_.max, unit_);
    }
    if (gate_.max && cell.status == Status::diverged) return "is of no meaning, for the run is " + cell.reason;
    if (gate_.min && !(value >= *gate_.min)) {
      return fmt::format("is {:.6g}{}, below the limit of {:g}{}", value, unit_, *gate_.min, unit_);
    }
    if (gate_.equals && !(std::abs(value - *gate_.equals) <= kRounding * std::max(1.0, std::abs(*gate_.equals)))) {
      return fmt::format("is {:.17g}{}, not {:.17g}{} to within {:g}", value, unit_, *gate_.equals, unit_, kRounding);
    }
    return "";
  }

  std::string worst_of(const MetricValue& metric) const {
    const Instant& worst = metric.worst;
    return fmt::format("worst at {:.6g} s: {}, {}: found {:.9g}, expected {:.9g}", worst.time,
                       result_.definition.scene.body_name(worst.body), worst.component, worst.found, worst.expected);
  }

  void check_order(std::size_t run) {
    std::vector<double> dt, values;
    std::string table;
    const Cell* worst = nullptr;
    for (const Cell& cell : result_.cells) {
      if (cell.run != run || !selects(cell)) continue;
      const auto found = cell.metrics.find(gate_.metric);
      if (found != cell.metrics.end() && !found->second.not_applicable.empty()) continue;
      if (found == cell.metrics.end() || (cell.status != Status::pass && cell.status != Status::fail)) {
        add(grid_.runs[run].text, "", GateAnswer::failed,
            fmt::format("the order of {} of {} cannot be judged, for the cell at dt = {} is {}: {}", gate_.metric,
                        grid_.runs[run].text, cell.dt.text, word_of(cell.status), cell.reason));
        return;
      }
      dt.push_back(cell.dt.seconds), values.push_back(found->second.value);
      table += fmt::format("{}{:.4g} at {}", table.empty() ? "" : ", ", found->second.value, cell.dt.text);
      if (!worst || found->second.value > worst->metrics.at(gate_.metric).value) worst = &cell;
    }
    if (dt.size() < 2) return;
    const double order = fitted_order(dt, values);
    const std::string head =
        fmt::format("the observed order of {} of {} is {:.3g} ({})", gate_.metric, grid_.runs[run].text, order, table);
    if (order >= *gate_.at_least_order) {
      add(grid_.runs[run].text, "", GateAnswer::held, head);
    } else {
      add(grid_.runs[run].text, "", GateAnswer::failed,
          fmt::format("{}, below {:g}; {}{}", head, *gate_.at_least_order, worst_of(worst->metrics.at(gate_.metric)),
                      because()));
    }
  }

  CaseResult& result_;
  const Results& grid_;
  std::size_t index_;
  const Gate& gate_;
  std::string unit_;
};

}  // namespace

double fitted_order(const std::vector<double>& dt, const std::vector<double>& values) {
  double mean_x = 0, mean_y = 0, xy = 0, xx = 0;
  for (std::size_t i = 0; i < dt.size(); ++i) {
    mean_x += std::log(dt[i]) / dt.size();
    mean_y += std::log(values[i]) / dt.size();
  }
  for (std::size_t i = 0; i < dt.size(); ++i) {
    xy += (std::log(dt[i]) - mean_x) * (std::log(values[i]) - mean_y);
    xx += (std::log(dt[i]) - mean_x) * (std::log(dt[i]) - mean_x);
  }
  return xy / xx;
}

void check_gates(CaseResult& result, const Results& grid) {
  result.gates.clear();
  for (std::size_t i = 0; i < result.definition.gates.size(); ++i) GateCheck(result, grid, i).check();
}

bool all_gates_hold(const Results& grid) {
  return std::all_of(grid.cases.begin(), grid.cases.end(), [](const CaseResult& result) {
    return result.error.empty() && std::all_of(result.gates.begin(), result.gates.end(),
                                               [](const GateResult& gate) { return gate.answer == GateAnswer::held; });
  });
}

}  // namespace rigor
