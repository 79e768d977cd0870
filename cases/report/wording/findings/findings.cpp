#include "cases/report/wording/findings/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "cases/analysis/energy_diagnosis.h"
#include "cases/report/wording/findings/energy_finding.h"
#include "cases/report/wording/findings/friction_finding.h"
#include "cases/report/wording/findings/headline_cells.h"
#include "cases/report/wording/findings/impacts_finding.h"
#include "cases/report/wording/findings/joints_finding.h"
#include "cases/report/wording/findings/recorded_finding.h"
#include "cases/report/wording/findings/stability_findings.h"
#include "cases/report/wording/findings/step_finding.h"
#include "cases/report/wording/run_names.h"

namespace rigor::inline report {
namespace {

// The largest error that an engine has beside its own scheme, as the core repeats it. States the number of such cells
// as `cells with a twin`, and the error as `largest unexplained_error`.
std::optional<Finding> unexplained_finding(const Results& results, const StepSize& dt) {
  const CaseResult* of_case = nullptr;
  const Cell* largest = nullptr;
  const auto rest_of = [](const Cell& cell) { return std::abs(signed_value(cell.metrics, "unexplained_error")); };
  int compared = 0;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    for_headline_cells(results, run, dt, [&](const CaseResult& result, const Cell& cell) {
      if (cell.scheme.twin.empty() || std::isnan(rest_of(cell)) || cell.stability.verdict == Verdict::blown_up) return;
      ++compared;
      if (!largest || rest_of(cell) > rest_of(*largest)) largest = &cell, of_case = &result;
    });
  }
  if (!largest) return std::nullopt;
  Claims claims;
  const std::string count = claims.count({"cells with a twin", "", "", dt.text, "", static_cast<double>(compared)});
  Claim rest = claim_of_cell(results, *of_case, *largest, "largest unexplained_error", rest_of(*largest));
  const std::string text = fmt::format(
      "The core repeated the engine's own scheme beside {} run{}. The largest position error left unexplained is {} "
      "({} "
      "on {}).",
      count, compared == 1 ? "" : "s", claims.quantity(rest, "m"), results.runs[largest->run].text,
      of_case->definition.id);
  return Finding{"unexplained", text, "", claims.take()};
}

}  // namespace

std::vector<Finding> findings(const Results& results) {
  const RunNames names(results);
  const StepSize dt = headline_dt(results);
  std::vector<Finding> all;
  const auto add = [&](std::optional<Finding> finding) {
    if (finding) all.push_back(std::move(*finding));
  };
  add(recorded_finding(results));
  add(stiff_springs_finding(results, names, dt));
  add(step_finding(results, names));
  add(energy_finding(results, names, dt));
  add(friction_finding(results, names, dt));
  add(impacts_finding(results, names.order()));
  add(contact_forces_finding(results, names.order()));
  add(joints_finding(results, names.order(), dt));
  add(blow_up_finding(results, names, dt));
  add(sampling_finding(results, names, dt));
  add(unexplained_finding(results, dt));
  return all;
}

StepSize headline_dt(const Results& results) {
  const StepSize headline{1.0 / 30, "1/30"};
  StepSize coarsest{0, ""};
  for (const CaseResult& result : results.cases) {
    for (const StepSize& step : result.definition.dt) {
      if (step == headline) return step;
      if (step.seconds > coarsest.seconds) coarsest = step;
    }
  }
  return coarsest;
}

}  // namespace rigor::inline report
