#include "cases/results/written_results.h"

#include <algorithm>
#include <set>

#include "cases/results/result_json.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor::inline results {
namespace {

std::string text_in(const Json& json, const char* key) { return json.at(key).get<std::string>(); }

// Runs that the results themselves set apart as adaptive references.
std::set<std::string> reference_runs(const Json& results) {
  std::set<std::string> found;
  for (const Json& scope : results.value("frontier", Json::array())) {
    for (const Json& curve : scope.at("curves"))
      if (curve.value("reference", false)) found.insert(text_in(curve, "engine"));
  }
  return found;
}

// An engine with one method for each that ran.
void add_run(const Json& row, bool is_reference, Results& out) {
  const std::string engine = row.contains("engine") ? text_in(row, "engine") : text_in(row, "name");
  MethodInfo method;
  method.name = row.value("method", std::string());
  method.order = row.value("order", 1), method.symplectic = row.value("symplectic", false);
  method.adaptive = is_reference;
  RunName run{engine, {}, text_in(row, "name")};
  run.settings.method = method.name;
  out.runs.push_back(std::move(run));
  const auto known =
      std::find_if(out.engines.begin(), out.engines.end(), [&](const EngineInfo& info) { return info.name == engine; });
  if (known == out.engines.end()) {
    EngineInfo info;
    info.name = engine, info.version = row.value("version", std::string());
    info.precision = row.value("precision", std::string("double")), info.is_in_house = row.value("in_house", false);
    info.methods.push_back(std::move(method));
    out.engines.push_back(std::move(info));
    return;
  }
  const bool is_new = std::none_of(known->methods.begin(), known->methods.end(),
                                   [&](const MethodInfo& info) { return info.name == method.name; });
  if (is_new) known->methods.push_back(std::move(method));
}

CaseResult written_case(const Json& json) {
  CaseResult result;
  Case& definition = result.definition;
  definition.id = text_in(json, "id"), definition.title = text_in(json, "title");
  definition.source = json.value("source", std::string()), definition.text = json.value("file", std::string());
  definition.duration = number_of(json.at("duration"));
  for (const Json& step : json.at("dt"))
    definition.dt.push_back({number_of(step.at("seconds")), text_in(step, "text")});
  if (definition.dt.empty()) throw InputError(definition.id + " has no step");
  const Json& truth = json.at("truth");
  definition.truth = text_in(truth, "kind");
  if (truth.contains("error_at_end")) {
    TruthFacts facts;
    facts.error_at_end = number_of(truth.at("error_at_end"));
    result.truth = facts;
  }
  if (json.contains("error") && !json.at("error").is_null()) result.error = text_in(json, "error");
  return result;
}

MetricValue written_metric(const Json& json) {
  MetricValue metric;
  if (json.contains("value"))
    metric.value = number_of(json.at("value"));
  else
    metric.not_applicable = text_in(json, "not_applicable");
  metric.is_held_to_itself = json.value("held_to_itself", false);
  return metric;
}

Cell written_cell(const Json& json, std::size_t run) {
  Cell cell;
  cell.run = run;
  cell.dt = {number_of(json.at("dt_seconds")), text_in(json, "dt")};
  cell.status = status_of(text_in(json, "status")), cell.reason = text_in(json, "reason");
  if (const Json& verdict = json.at("verdict"); !verdict.is_null())
    cell.stability.verdict = verdict_of(text_in(verdict, "word"));
  for (const auto& [name, metric] : json.at("metrics").items()) cell.metrics[name] = written_metric(metric);
  for (const auto& [name, value] : json.at("settings").items())
    cell.settings.emplace_back(name, value.get<std::string>());
  return cell;
}

StableStepResult written_stable_step(const Json& json) {
  StableStepResult result;
  result.status = status_of(json.value("status", std::string("pass")));
  result.reason = json.value("reason", std::string());
  if (result.status != Status::pass) return result;
  result.step.dt = number_of(json.at("dt"));
  result.step.is_cap = json.value("is_cap", false), result.step.is_floor = json.value("is_floor", false);
  return result;
}

}  // namespace

Results results_from(const Json& results) {
  Results out;
  const std::set<std::string> references = reference_runs(results);
  std::map<std::string, std::size_t> runs, cases;
  for (const Json& row : results.at("engines")) {
    runs[text_in(row, "name")] = out.runs.size();
    add_run(row, references.contains(text_in(row, "name")), out);
  }
  for (const Json& row : results.at("cases")) {
    cases[text_in(row, "id")] = out.cases.size();
    out.cases.push_back(written_case(row));
    StableStepResult not_searched;
    skip(not_searched, SkipReason::not_asked_for);
    out.cases.back().stable_steps.resize(out.runs.size(), not_searched);
  }
  for (const Json& row : results.at("cells"))
    out.cases[cases.at(text_in(row, "case"))].cells.push_back(written_cell(row, runs.at(text_in(row, "engine"))));
  for (const Json& row : results.at("stable_dt"))
    out.cases[cases.at(text_in(row, "case"))].stable_steps[runs.at(text_in(row, "engine"))] = written_stable_step(row);
  return out;
}

}  // namespace rigor::inline results
