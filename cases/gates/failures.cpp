#include "cases/gates/failures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cases/gates/gates.h"

namespace rigor::inline gates {
namespace {

std::string limit_of(const Gate& gate) {
  const std::string unit = unit_after(gate.metric);
  if (const OrderLimit* order = gate.order())
    return order->is_declared ? "the order that its method declares, less a tenth"
                              : fmt::format("order at least {:g}", order->at_least);
  if (const auto* regression = gate.regression())
    return fmt::format("within {:g} times the recorded value", regression->factor);
  if (const RankingLimit* ranking = gate.ranking()) return "better than " + ranking->better_than;
  const auto [max, min, equals] = gate.bound();
  if (equals) return fmt::format("equal to {:.17g}{}", *equals, unit);
  std::string text;
  if (min) text = fmt::format("at least {:g}{}", *min, unit);
  if (max) text += fmt::format("{}at most {:g}{}", text.empty() ? "" : ", ", *max, unit);
  return text;
}

std::string worst_text(const GateResult& answer, const Scene& scene) {
  if (!answer.worst) return "";
  const Instant& worst = *answer.worst;
  return fmt::format("at {:.6g} s: {}, {}: found {:.9g}, expected {:.9g}", worst.time, scene.body_name(worst.body),
                     worst.component, worst.found, worst.expected);
}

Failure of_gate(const CaseResult& result, const GateResult& answer) {
  const Gate& gate = result.definition.gates[answer.gate];
  Failure row{result.definition.id, answer.engine, answer.dt, gate.metric, "", limit_of(gate), "", "", gate.where};
  const std::string unit = gate.order() ? "" : unit_after(gate.metric);
  row.found = answer.value ? fmt::format("{:.6g}{}", *answer.value, unit) : word_of(answer.answer);
  row.worst = worst_text(answer, result.definition.scene);
  row.because = answer.answer == GateAnswer::failed && answer.value ? gate.because : answer.text;
  if (gate.regression()) row.what += " (regression)";
  if (answer.answer == GateAnswer::unexpected_pass) row.what += ", unexpected pass";
  return row;
}

// A cell that is invalid may be one of which nobody expects a result.
bool came_to_nothing(const Cell& cell, const CaseResult& result, const Results& results) {
  if (cell.status != Status::invalid) return cell.status == Status::crashed || cell.status == Status::timed_out;
  return std::any_of(result.gates.begin(), result.gates.end(), [&](const GateResult& answer) {
    return answer.engine == results.runs[cell.run].text && answer.dt == cell.dt.text && is_failure(answer.answer);
  });
}

}  // namespace

std::vector<Failure> failures(const Results& results) {
  std::vector<Failure> rows;
  for (const CaseResult& result : results.cases) {
    const Case& definition = result.definition;
    if (!result.error.empty())
      rows.push_back({definition.id, "", "", "truth", "", "", "", result.error, definition.truth_where});
    for (const Cell& cell : result.cells) {
      if (came_to_nothing(cell, result, results) && result.error.empty())
        rows.push_back({definition.id, results.runs[cell.run].text, cell.dt.text, word_of(cell.status), "", "", "",
                        cell.reason, ""});
    }
    for (const GateResult& answer : result.gates) {
      if (is_failure(answer.answer)) rows.push_back(of_gate(result, answer));
    }
  }
  return rows;
}

std::vector<Gate> unmet_family_gates(const Results& grid) {
  std::map<std::string, const Gate*> unmet;  // by where it stands and its metric
  const auto key = [](const Gate& gate) { return gate.where + " " + gate.metric; };
  for (const CaseResult& result : grid.cases) {
    for (const Gate& gate : result.definition.gates) {
      if (gate.is_of_family) unmet.emplace(key(gate), &gate);
    }
  }
  for (const CaseResult& result : grid.cases) {
    for (const GateResult& answer : result.gates) unmet.erase(key(result.definition.gates[answer.gate]));
  }
  std::vector<Gate> gates;
  for (const auto& [name, gate] : unmet) gates.push_back(*gate);
  return gates;
}

}  // namespace rigor::inline gates
