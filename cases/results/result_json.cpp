#include "cases/results/result_json.h"
#include "cases/results/trial_results.h"
#include "core/base/json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace rigor::inline results {
namespace {

constexpr const char *kInfinite = "inf", *kMinusInfinite = "-inf", *kNoNumber = "nan";

const char* word_of_not_finite(double value) {
  return std::isnan(value) ? kNoNumber : value > 0 ? kInfinite : kMinusInfinite;
}

void spell_not_finite(Json& json) {
  if (json.is_number_float() && !std::isfinite(json.get<double>())) {
    json = word_of_not_finite(json.get<double>());
  } else if (json.is_structured()) {
    for (Json& part : json) spell_not_finite(part);
  }
}

int body_index(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
  }
  if (name != scene.body_name(kWorld)) throw std::runtime_error("no such body: " + name);
  return kWorld;
}

Json json_of(const MetricValue& metric, const std::string& name, const Scene& scene) {
  if (!metric.not_applicable.empty()) return {{"not_applicable", metric.not_applicable}};
  const Instant& worst = metric.worst;
  Json json = {{"value", metric.value},
               {"unit", unit_of_metric(name)},
               {"first_second", metric.first_second},
               {"worst",
                {{"time", worst.time},
                 {"body", scene.body_name(worst.body)},
                 {"component", worst.component},
                 {"found", worst.found},
                 {"expected", worst.expected}}},
               {"compared_until", metric.compared_until}};
  if (metric.is_held_to_itself) json["held_to_itself"] = true;
  return json;
}

MetricValue metric_from(const Json& json, const Scene& scene) {
  MetricValue metric;
  if (json.contains("not_applicable")) {
    metric.not_applicable = json.at("not_applicable").get<std::string>();
    return metric;
  }
  const Json& worst = json.at("worst");
  metric.value = number_of(json.at("value"));
  metric.first_second = number_of(json.at("first_second"));
  metric.worst = {number_of(worst.at("time")), body_index(scene, worst.at("body").get<std::string>()),
                  worst.at("component").get<std::string>(), number_of(worst.at("found")),
                  number_of(worst.at("expected"))};
  metric.compared_until = number_of(json.at("compared_until"));
  metric.is_held_to_itself = json.value("held_to_itself", false);
  return metric;
}

using Metrics = std::map<std::string, MetricValue>;

Json json_of(const Metrics& metrics, const Scene& scene) {
  Json json = Json::object();
  for (const auto& [name, metric] : metrics) json[name] = json_of(metric, name, scene);
  return json;
}

Metrics metrics_from(const Json& json, const Scene& scene) {
  Metrics metrics;
  for (const auto& [name, metric] : json.items()) metrics[name] = metric_from(metric, scene);
  return metrics;
}

Json json_of(const SchemeFindings& scheme, const Scene& scene) {
  if (scheme.twin.empty()) return nullptr;
  return {{"twin", scheme.twin},
          {"metrics", json_of(scheme.metrics, scene)},
          {"without_gyroscopic_term", json_of(scheme.without_gyroscopic_term, scene)}};
}

SchemeFindings scheme_from(const Json& json, const Scene& scene) {
  if (json.is_null()) return {};
  return {json.at("twin").get<std::string>(), metrics_from(json.at("metrics"), scene),
          metrics_from(json.at("without_gyroscopic_term"), scene)};
}

Json json_of(const std::optional<ReducedOrder>& reduced) {
  if (!reduced) return nullptr;
  return {{"from", reduced->from}, {"how", reduced->how}};
}

std::optional<ReducedOrder> reduced_order_from(const Json& json) {
  if (json.is_null()) return {};
  return ReducedOrder{number_of(json.at("from")), json.at("how").get<std::string>()};
}

void fill_in(Cell& cell, const Json& json, const Scene& scene) {
  cell.status = status_of(json.at("status").get<std::string>());
  cell.reason = json.at("reason").get<std::string>();
  cell.cpu_seconds = number_of(json.at("cpu_seconds"));
  cell.wall_seconds = number_of(json.at("wall_seconds"));
  cell.trajectory = json.at("trajectory").is_null() ? "" : json.at("trajectory").get<std::string>();
  if (!json.at("verdict").is_null()) {
    const Json& verdict = json.at("verdict");
    cell.stability = {verdict_of(verdict.at("word").get<std::string>()), number_of(verdict.at("time")),
                      body_index(scene, verdict.at("body").get<std::string>()), verdict.at("why").get<std::string>(),
                      number_of(verdict.at("amount"))};
  }
  cell.reduced_order = reduced_order_from(json.at("reduced_order"));
  cell.sub_step.reset();
  if (json.contains("sub_step") && !json.at("sub_step").is_null()) cell.sub_step = number_of(json.at("sub_step"));
  cell.metrics = metrics_from(json.at("metrics"), scene);
  cell.scheme = scheme_from(json.at("by_scheme"), scene);
  cell.settings.clear();
  for (const auto& [name, value] : json.at("settings").items())
    cell.settings.emplace_back(name, value.get<std::string>());
}

// The values of each trial, and the spread of each mean.
void add_trials(const Cell& cell, Json& json) {
  const std::vector<TrialResult> trials = trials_of(cell);
  for (const TrialResult& trial : trials) {
    Json row = {{"trial", trial.name}, {"status", word_of(trial.status)}, {"metrics", trial.metrics}};
    if (!trial.reason.empty()) row["reason"] = trial.reason;
    json["trials"].push_back(std::move(row));
  }
  for (const auto& [name, metric] : json["metrics"].items()) {
    const auto spread = spread_over(trials, name);
    if (!spread) continue;
    metric["trials"] = {{"count", spread->count},
                        {"standard_deviation", spread->standard_deviation},
                        {"median", spread->median},
                        {"worst", {{"trial", spread->worst}, {"value", spread->worst_value}}}};
  }
}

Json json_of(const Furthest& furthest) { return {furthest.value, furthest.time, furthest.body}; }

Furthest furthest_from(const Json& json, const Scene& scene) {
  const std::size_t body = json.at(2).get<std::size_t>();
  if (body >= std::max<std::size_t>(1, scene.bodies.size()))
    throw std::runtime_error("no such body: " + std::to_string(body));
  return {number_of(json.at(0)), number_of(json.at(1)), static_cast<int>(body)};
}

Spread spread_from(const Json& json, const CaseResult& of) {
  const Scene& scene = of.definition.scene;
  const std::size_t runs = of.stable_steps.size();
  Spread spread;
  spread.first = json.at("first").get<std::size_t>(), spread.second = json.at("second").get<std::size_t>();
  if (spread.first >= runs || spread.second >= runs) throw std::runtime_error("a spread of runs that there are not");
  spread.dt = {number_of(json.at("dt_seconds")), json.at("dt").get<std::string>()};
  spread.distance = furthest_from(json.at("distance"), scene);
  spread.angle = furthest_from(json.at("angle"), scene);
  if (!json.at("parted_at").is_null()) spread.parted_at = number_of(json.at("parted_at"));
  spread.compared_until = number_of(json.at("compared_until"));
  return spread;
}

void fill_in(StableStepResult& result, const Json& json) {
  result.status = status_of(json.at("status").get<std::string>());
  result.reason = json.at("reason").get<std::string>();
  if (result.status != Status::pass) return;
  result.step = {number_of(json.at("dt")), json.at("is_cap").get<bool>(), json.at("is_floor").get<bool>(),
                 result.reason};
}

}  // namespace

Json json_of(const Cell& cell, const Scene& scene) {
  Json json = {
      {"dt", cell.dt.text}, {"dt_seconds", cell.dt.seconds}, {"status", word_of(cell.status)}, {"reason", cell.reason}};
  const Stability& stability = cell.stability;
  json["verdict"] = nullptr;
  if (!cell.metrics.empty()) {
    json["verdict"] = {{"word", word_of(stability.verdict)},
                       {"time", stability.time},
                       {"body", scene.body_name(stability.body)},
                       {"why", stability.why},
                       {"amount", stability.amount},
                       {"phrase", phrase_of(stability)}};
  }
  json["reduced_order"] = json_of(cell.reduced_order);
  json["sub_step"] = cell.sub_step ? Json(*cell.sub_step) : Json(nullptr);
  json["metrics"] = json_of(cell.metrics, scene);
  add_trials(cell, json);
  json["by_scheme"] = json_of(cell.scheme, scene);
  json["settings"] = Json::object();
  for (const auto& [name, value] : cell.settings) json["settings"][name] = value;
  json["cpu_seconds"] = cell.cpu_seconds;
  json["wall_seconds"] = cell.wall_seconds;
  json["trajectory"] = cell.trajectory.empty() ? Json(nullptr) : Json(cell.trajectory);
  return json;
}

Json json_of(const StableStepResult& result) {
  Json json = {{"status", word_of(result.status)}, {"reason", result.reason}, {"dt", nullptr}};
  if (result.status != Status::pass) return json;
  json["dt"] = result.step.dt, json["is_cap"] = result.step.is_cap, json["is_floor"] = result.step.is_floor;
  return json;
}

double number_of(const Json& value) {
  if (value.is_number()) return value.get<double>();
  const std::string word = value.get<std::string>();
  for (const double number : {HUGE_VAL, -HUGE_VAL, std::numeric_limits<double>::quiet_NaN()}) {
    if (word == word_of_not_finite(number)) return number;
  }
  throw std::runtime_error("no such number: " + word);
}

std::string text_of(Json value, int indent) {
  spell_not_finite(value);
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string message_of_truth(const TruthFacts& facts) {
  return text_of({{"truth",
                   {facts.error_at_end, facts.horizon, facts.largest_kinetic_energy, facts.largest_energy_change,
                    facts.recordings, facts.caveat, facts.is_still}}},
                 -1);
}

std::string message_of_cell(std::size_t index, const Cell& cell, const Scene& scene) {
  return text_of({{"cell", index}, {"result", json_of(cell, scene)}, {"recordings", cell.recordings}}, -1);
}

std::string message_of_stable_step(std::size_t run, const StableStepResult& result) {
  return text_of({{"stable_step", run}, {"result", json_of(result)}}, -1);
}

std::string message_of_spreads(const std::vector<Spread>& spreads) {
  Json all = Json::array();
  for (const Spread& spread : spreads) {
    all.push_back({{"first", spread.first},
                   {"second", spread.second},
                   {"dt", spread.dt.text},
                   {"dt_seconds", spread.dt.seconds},
                   {"distance", json_of(spread.distance)},
                   {"angle", json_of(spread.angle)},
                   {"parted_at", spread.parted_at ? Json(*spread.parted_at) : Json(nullptr)},
                   {"compared_until", spread.compared_until}});
  }
  return text_of({{"spreads", all}}, -1);
}

MessageSubject apply_message(CaseResult& result, const std::string& message) {
  using Part = MessageSubject::Part;
  const Json json = parse_json(message);
  if (json.contains("truth")) {
    const Json& facts = json.at("truth");
    result.truth = {number_of(facts.at(0)), number_of(facts.at(1)),        number_of(facts.at(2)),
                    number_of(facts.at(3)), facts.at(4).get<Recordings>(), facts.at(5).get<std::string>(),
                    facts.at(6).get<bool>()};
    return {Part::truth};
  }
  if (json.contains("spreads")) {
    std::vector<Spread> spreads;
    for (const Json& spread : json.at("spreads")) spreads.push_back(spread_from(spread, result));
    result.spreads = std::move(spreads);
    return {Part::spreads};
  }
  if (json.contains("cell")) {
    const std::size_t index = json.at("cell").get<std::size_t>();
    Cell cell = result.cells.at(index);
    fill_in(cell, json.at("result"), result.definition.scene);
    cell.recordings = json.at("recordings").get<Recordings>();
    result.cells[index] = std::move(cell);
    return {Part::cell, index};
  }
  const std::size_t run = json.at("stable_step").get<std::size_t>();
  StableStepResult stable = result.stable_steps.at(run);
  fill_in(stable, json.at("result"));
  result.stable_steps[run] = std::move(stable);
  return {Part::stable_step, run};
}

}  // namespace rigor::inline results
