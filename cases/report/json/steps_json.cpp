#include "cases/report/json/steps_json.h"

#include "cases/analysis/cell_error.h"
#include "cases/analysis/relative_error.h"
#include "cases/analysis/step_needed.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

// Of one tolerance: null where no step keeps it.
void add_step(const StepNeeded& step, Json& row) {
  row["dt"].push_back(step.found == StepNeeded::Found::none ? Json(nullptr) : Json(step.seconds));
  row["found"].push_back(step.is_coarsest ? "coarsest" : word_of(step.found));
}

}  // namespace

Json steps_needed_json(const Results& results, const CaseResult& result) {
  Json rows = Json::array();
  if (!has_main_error_of_truth(result)) return rows;
  const std::string metric = main_error(result);
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    Json row = {{"engine", results.runs[run].text}, {"dt", Json::array()}, {"found", Json::array()}};
    for (const double tolerance : kTolerances) {
      if (const auto step = step_needed(result, run, metric, tolerance)) add_step(*step, row);
    }
    if (!row["dt"].empty()) rows.push_back(row);
  }
  return rows;
}

Json steps_over_cases_json(const Results& results) {
  std::map<std::size_t, Json> rows;  // by run
  for (const double tolerance : kTolerances) {
    for (const StepOverCases& step : steps_over_cases(results, tolerance)) {
      Json& row = rows[step.run];
      if (row.is_null())
        row = {{"engine", results.runs[step.run].text},
               {"is_reference", step.is_reference},
               {"cases", step.cases},
               {"failed", Json::array()},
               {"dt", Json::array()},
               {"found", Json::array()}};
      row["failed"].push_back(step.failed);
      add_step(step.median, row);
    }
  }
  Json all = Json::array();
  for (const auto& [run, row] : rows) all.push_back(row);
  return all;
}

Json relative_errors_json(const Results& results) {
  Json rows = Json::array();
  for (const StepSize& dt : distinct_steps(results)) {
    for (const RelativeError& one : relative_errors(results, dt)) {
      rows.push_back({{"engine", results.runs[one.run].text},
                      {"dt", dt.text},
                      {"cases", one.cases},
                      {"failed", one.failed},
                      {"ratio", one.ratio}});
    }
  }
  return rows;
}

}  // namespace rigor::inline report
