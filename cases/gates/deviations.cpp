#include "cases/gates/deviations.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/case/selection.h"
#include "core/base/error.h"

namespace rigor::inline gates {
namespace {

bool names_run(const KnownDeviation& row, const RunName& run) {
  return std::any_of(row.runs.begin(), row.runs.end(), [&](const RunName& own) { return is_same_run(own, run); });
}

bool names_step(const KnownDeviation& row, const StepSize& dt) {
  return row.dt.empty() || std::find(row.dt.begin(), row.dt.end(), dt) != row.dt.end();
}

bool can_meet(const KnownDeviation& row, const Gate& gate, const Case& definition,
              const std::vector<EngineInfo>& engines) {
  const GateSelection selection(gate, engines);
  const bool has_run =
      std::any_of(row.runs.begin(), row.runs.end(), [&](const RunName& run) { return selection.takes(run); });
  const bool has_step = std::any_of(definition.dt.begin(), definition.dt.end(),
                                    [&](const StepSize& dt) { return selection.takes(dt) && names_step(row, dt); });
  return !gate.regression() && gate.metric == row.metric && has_run && has_step;
}

const RunName* run_called(const Results& grid, const std::string& name) {
  const auto found = std::find_if(grid.runs.begin(), grid.runs.end(), [&](const RunName& r) { return r.text == name; });
  return found == grid.runs.end() ? nullptr : &*found;
}

bool speaks_of(const KnownDeviation& row, const GateResult& answer, const CaseResult& result, const Results& grid) {
  const RunName* run = run_called(grid, answer.engine);
  if (result.definition.gates[answer.gate].regression()) return false;  // also guards the known value
  if (row.case_id != result.definition.id || row.metric != result.definition.gates[answer.gate].metric) return false;
  if (!run || !names_run(row, *run)) return false;
  if (answer.dt.empty()) return row.dt.empty();
  const auto& steps = result.definition.dt;
  const auto step = std::find_if(steps.begin(), steps.end(), [&](const StepSize& s) { return s.text == answer.dt; });
  return step != steps.end() && names_step(row, *step);
}

void apply(const KnownDeviation& row, GateResult& answer) {
  if (answer.answer == GateAnswer::failed) {
    answer.answer = GateAnswer::known_deviation;
    answer.text += fmt::format(" (known: {})", row.reason);
  } else if (answer.answer == GateAnswer::held) {
    answer.answer = GateAnswer::unexpected_pass;
    answer.text += fmt::format("; {} says that this gate fails here, for {}: take the row out", row.where, row.reason);
  }
}

// A cell's status follows from its answers: one that fails unexpectedly counts most.
void conclude(Cell& cell, const CaseResult& result, const Results& grid) {
  if (cell.status != Status::pass && cell.status != Status::fail) return;
  const auto first = [&](GateAnswer wanted) {
    return std::find_if(result.gates.begin(), result.gates.end(), [&](const GateResult& answer) {
      return answer.answer == wanted && answer.engine == grid.runs[cell.run].text && answer.dt == cell.dt.text;
    });
  };
  for (const auto& [answer, status] : {std::pair{GateAnswer::failed, Status::fail},
                                       {GateAnswer::unexpected_pass, Status::unexpected_pass},
                                       {GateAnswer::known_deviation, Status::known_deviation}}) {
    const auto found = first(answer);
    if (found == result.gates.end()) continue;
    cell.status = status, cell.reason = found->text;
    return;
  }
}

}  // namespace

void check_known_deviations(const std::vector<KnownDeviation>& rows, const std::vector<Case>& cases,
                            const std::vector<EngineInfo>& engines) {
  for (const KnownDeviation& row : rows) {
    const auto of = std::find_if(cases.begin(), cases.end(), [&](const Case& c) { return c.id == row.case_id; });
    if (of == cases.end()) continue;
    const bool is_met = std::any_of(of->gates.begin(), of->gates.end(),
                                    [&](const Gate& gate) { return can_meet(row, gate, *of, engines); });
    if (!is_met) {
      throw InputError(fmt::format("{}: no gate of {} holds {} of {} to anything at such a step; take the row out",
                                   row.where, row.case_id, row.metric, row.runs.front().text));
    }
  }
}

void apply_known_deviations(CaseResult& result, const Results& grid, const std::vector<KnownDeviation>& rows) {
  for (GateResult& answer : result.gates) {
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const KnownDeviation& r) { return speaks_of(r, answer, result, grid); });
    if (row != rows.end()) apply(*row, answer);
  }
  for (Cell& cell : result.cells) conclude(cell, result, grid);
}

}  // namespace rigor::inline gates
