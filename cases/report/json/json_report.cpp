// results.json: everything that the other reports show, for programs. `schema` rises when a reader would have to
// change.
#include "cases/report/json/json_report.h"

#include <fmt/format.h>

#include "cases/analysis/step_needed.h"
#include "cases/report/json/claims_json.h"
#include "cases/report/json/comparison_json.h"
#include "cases/report/json/frontier_json.h"
#include "cases/report/json/leave_out_details.h"
#include "cases/report/json/machine.h"
#include "cases/report/json/scene_json.h"
#include "cases/report/json/steps_json.h"
#include "cases/report/reports.h"
#include "cases/report/wording/explanations/explanation.h"
#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/verdict_matrix.h"
#include "cases/results/main_error.h"
#include "cases/results/result_json.h"
#include "cases/truth/provenance.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

constexpr int kSchemaVersion = 2;

Json machine_json() {
  const Machine machine = this_machine();
  return {{"cpu", machine.cpu},
          {"cores", machine.cores},
          {"compiler", machine.compiler},
          {"build_type", machine.build_type}};
}

Json run_json(const RunName& run, const std::vector<EngineInfo>& engines) {
  for (const EngineInfo& engine : engines) {
    if (engine.name != run.engine) continue;
    const MethodInfo& method = method_of(engine, run.settings);
    return {{"name", run.text},
            {"engine", engine.name},
            {"version", engine.version},
            {"precision", engine.precision},
            {"in_house", engine.is_in_house},
            {"method", method.name},
            {"order", method.order},
            {"symplectic", method.symplectic},
            {"leapfrog_stagger", method.leapfrog_stagger}};
  }
  return {{"name", run.text}};
}

Json bound(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json gates_json(const CaseResult& result) {
  Json gates = Json::array();
  for (std::size_t i = 0; i < result.definition.gates.size(); ++i) {
    const Gate& gate = result.definition.gates[i];
    Json answers = Json::array();
    for (const GateResult& answer : result.gates) {
      if (answer.gate != i) continue;
      answers.push_back({{"engine", answer.engine},
                         {"dt", answer.dt},
                         {"answer", word_of(answer.answer)},
                         {"text", answer.text},
                         {"caveat", answer.caveat},
                         {"value", bound(answer.value)}});
    }
    const auto [max, min, equals] = gate.bound();
    const OrderLimit* order = gate.order();
    gates.push_back({{"kind", kind_of(gate)},
                     {"metric", gate.metric},
                     {"max", bound(max)},
                     {"min", bound(min)},
                     {"equals", bound(equals)},
                     {"at_least_order", !order               ? Json(nullptr)
                                        : order->is_declared ? Json("declared")
                                                             : Json(order->at_least)},
                     {"regression", gate.regression() ? Json(gate.regression()->factor) : Json(nullptr)},
                     {"better_than", gate.ranking() ? Json(gate.ranking()->better_than) : Json(nullptr)},
                     {"because", gate.because},
                     {"where", gate.where},
                     {"answers", answers}});
  }
  return gates;
}

// By kind: what the import of a robot's file left out or assumed.
Json losses_json(const Case& definition) {
  Json rows = Json::array();
  for (const Loss& loss : definition.losses)
    rows.push_back({{"kind", word_of(loss.kind)},
                    {"what", loss.what},
                    {"why", loss.why},
                    {"count", loss.count},
                    {"where", loss.places}});
  return rows;
}

Json other_robots_json(const Results& results) {
  Json rows = Json::array();
  for (const CaseResult& result : results.cases) {
    if (const std::string other = not_the_same_robot(result.definition.losses); !other.empty())
      rows.push_back(fmt::format("{}: {}", result.definition.id, other));
  }
  return rows;
}

Json case_json(const Results& results, const CaseResult& result) {
  const Case& definition = result.definition;
  Json json = {{"id", definition.id},
               {"title", definition.title},
               {"source", definition.source},
               {"file", definition.text},
               {"scene", json_of(definition.scene)},
               {"duration", definition.duration},
               {"dt", Json::array()},
               {"truth", {{"kind", definition.truth}, {"provenance", provenance_of(definition.truth)}}},
               {"error", result.error.empty() ? Json(nullptr) : Json(result.error)}};
  for (const StepSize& step : definition.dt) json["dt"].push_back({{"text", step.text}, {"seconds", step.seconds}});
  if (result.truth && definition.truth != "none") {
    json["truth"]["error_at_end"] = result.truth->error_at_end;
    json["truth"]["horizon"] = result.truth->horizon;
    json["truth"]["horizon_tolerance"] = kHorizonTolerance;
    if (!result.truth->caveat.empty()) json["truth"]["caveat"] = result.truth->caveat;
    if (result.truth->is_still) json["truth"]["still"] = true;
  }
  if (result.truth) json["largest_kinetic_energy"] = result.truth->largest_kinetic_energy;
  if (!definition.losses.empty()) json["losses"] = losses_json(definition);
  json["size"] = size_of(definition.scene);
  json["main_error"] = main_error(result);
  json["observed_order"] = observed_orders_json(results, result);
  json["work_precision"] = work_precision_json(results, result);
  json["spread"] = spreads_json(results, result);
  json["own_steps"] = own_steps_json(results, result);
  json["gates"] = gates_json(result);
  json["explanations"] = json["explanation_claims"] = json["step_needed"] = Json::array();
  if (result.stable_steps.empty()) return json;
  for (const Message& message : explanations(results, result)) {
    json["explanations"].push_back(message.text);
    json["explanation_claims"].push_back({{"topic", message.topic}, {"claims", claims_json(message.claims)}});
  }
  json["step_needed"] = steps_needed_json(results, result);
  return json;
}

Json findings_json(const Results& results) {
  Json rows = Json::array();
  for (const Finding& found : findings(results)) {
    rows.push_back(
        {{"topic", found.topic}, {"text", found.text}, {"more", found.more}, {"claims", claims_json(found.claims)}});
  }
  return rows;
}

Json metrics_json() {
  Json rows = Json::array();
  for (const MetricRow& row : metrics())
    rows.push_back({{"name", row.name}, {"unit", row.unit}, {"summary", row.summary}});
  return rows;
}

Json cell_json(const Cell& cell, const CaseResult& result, const std::string& run) {
  Json json = {{"case", result.definition.id}, {"engine", run}};
  json.update(json_of(cell, result.definition.scene));
  json["gates"] = Json::array();
  for (const GateResult& answer : result.gates) {
    if (answer.engine != run || answer.dt != cell.dt.text) continue;
    json["gates"].push_back({{"gate", answer.gate}, {"answer", word_of(answer.answer)}, {"text", answer.text}});
  }
  return json;
}

}  // namespace

Json results_json(const Results& results) {
  Json json = {{"schema", kSchemaVersion},
               {"program", {{"name", "rigor"}, {"version", this_machine().program_version}}},
               {"machine", machine_json()},
               {"wall_seconds", results.wall_seconds},
               {"headline_dt", headline_dt(results).text},
               {"findings", findings_json(results)},
               {"tolerances", kTolerances},
               {"step_over_cases", steps_over_cases_json(results)},
               {"relative_errors", relative_errors_json(results)},
               {"recommendation", recommendation_json(results)},
               {"frontier", frontier_json(results)},
               {"metrics", metrics_json()},
               {"engines", Json::array()},
               {"cases", Json::array()},
               {"cells", Json::array()},
               {"stable_dt", Json::array()}};
  if (const Json others = other_robots_json(results); !others.empty()) json["not_the_same_robot"] = others;
  for (const RunName& run : results.runs) json["engines"].push_back(run_json(run, results.engines));
  for (const CaseResult& result : results.cases) {
    json["cases"].push_back(case_json(results, result));
    for (const Cell& cell : result.cells) json["cells"].push_back(cell_json(cell, result, results.runs[cell.run].text));
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
      Json stable = {{"case", result.definition.id}, {"engine", results.runs[run].text}};
      stable.update(json_of(result.stable_steps[run]));
      json["stable_dt"].push_back(stable);
    }
  }
  return json;
}

// A cell, a case, a finding takes a line.
std::string json_report(const Results& results) {
  Json json = results_json(results);
  if (results.cases.size() > kMostCasesInDetail) leave_out_details(json);
  std::string text;
  for (const auto& [key, value] : json.items()) {
    text += (text.empty() ? "{\n" : ",\n") + text_of(key, -1) + ": ";
    if (!value.is_array()) {
      text += text_of(value, -1);
      continue;
    }
    for (std::size_t row = 0; row < value.size(); ++row) text += (row == 0 ? "[\n" : ",\n") + text_of(value[row], -1);
    text += value.empty() ? "[]" : "\n]";
  }
  return text + "\n}\n";
}

}  // namespace rigor::inline report
