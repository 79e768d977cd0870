#include "cases/laboratory/calls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "adapters/plugin/process_engine.h"
#include "cases/analysis/repeats/recorded_states.h"
#include "cases/case/case_reader.h"
#include "cases/laboratory/experiment.h"
#include "cases/laboratory/knobs.h"
#include "cases/laboratory/robot_file.h"
#include "cases/laboratory/sentences.h"
#include "cases/laboratory/true_motion.h"
#include "cases/report/json/scene_json.h"
#include "cases/results/result_json.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/json_words.h"
#include "core/base/names_of.h"
#include "core/base/near_match.h"
#include "core/engine/run_name.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline laboratory {
namespace {

// Infinite values are words in JSON.
Json json_number(double value) { return std::isinf(value) ? Json("infinite") : Json(value); }
double number_from(const Json& value) { return value == "infinite" ? HUGE_VAL : number_of(value); }

Json json_of(const Knob& knob) {
  return {{"name", knob.name},
          {"label", knob.label},
          {"unit", knob.unit},
          {"value", json_number(knob.value)},
          {"least", knob.least},
          {"most", knob.most},
          {"logarithmic", knob.is_logarithmic},
          {"infinite", knob.may_be_infinite}};
}

Json json_of(const MethodInfo& method) {
  Json options = Json::array();
  for (const OptionInfo& option : method.options) {
    if (option.choices.empty()) continue;
    options.push_back({{"name", option.name},
                       {"meaning", option.meaning},
                       {"choices", option.choices},
                       {"default", default_text(option)}});
  }
  return {{"name", method.name},         {"summary", method.summary},
          {"order", method.order},       {"symplectic", method.symplectic},
          {"adaptive", method.adaptive}, {"twin_of", method.twin_of},
          {"options", options}};
}

const EngineInfo& core() { return engines().info_of("core"); }

// An engine from outside stands for its first method.
Json methods_json(const EngineTable& engines) {
  Json methods = Json::array();
  for (const MethodInfo& method : core().methods) methods.push_back(json_of(method));
  for (const EngineInfo& engine : engines.infos()) {
    if (engine.is_in_house) continue;
    Json row = json_of(engine.methods.front());
    row["name"] = engine.name, row["engine"] = engine.name + " " + engine.version;
    methods.push_back(row);
  }
  return methods;
}

// Why methods do not take the scene, by name; those that do are missing.
Json refusals(const EngineTable& engines, const Scene& scene) {
  Json why = Json::object();
  for (const MethodInfo& method : core().methods) {
    Settings settings;
    settings.method = method.name;
    const std::string reason = why_unsupported(core(), settings, scene, 0);
    if (!reason.empty()) why[method.name] = reason;
  }
  for (const EngineInfo& engine : engines.infos()) {
    Settings settings;
    settings.method = engine.methods.front().name;
    const std::string reason = engine.is_in_house ? "" : why_unsupported(engine, settings, scene, 0);
    if (!reason.empty()) why[engine.name] = reason;
  }
  return why;
}

// Likewise its contact methods, with velocity-verlet.
Json contact_refusals(const Scene& scene) {
  Settings settings;
  settings.method = "velocity-verlet";
  Json why = Json::object();
  for (const OptionInfo& option : method_of(core(), settings).options) {
    if (option.name != "contact") continue;
    for (const std::string& choice : option.choices) {
      settings.options = {{"contact", choice}};
      const std::string reason = why_unsupported(core(), settings, scene, 0);
      if (!reason.empty()) why[choice] = reason;
    }
  }
  return why;
}

Json json_of(const TruthTable& table) {
  return {{"dt", table.dt},         {"bodies", table.bodies}, {"kinetic", table.kinetic},
          {"change", table.change}, {"kind", table.kind},     {"provisional", table.is_provisional}};
}

void append(const LiveReading& reading, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), {reading.time, reading.energy, reading.orthonormality, reading.position_error,
                                 reading.orientation_error, reading.joint_gap});
}

void append_poses(BodyColumns bodies, std::vector<double>& numbers) {
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (int c = 0; c < 7; ++c) numbers.push_back(bodies.column(c)[i]);
}

}  // namespace

struct LaboratoryCalls::Request {
  Json json;

  std::string text(const char* key) const { return json.at(key).get<std::string>(); }
  long whole(const char* key) const { return json.at(key).get<long>(); }
  StepSize dt() const { return parse_step_size(text("dt"), "dt"); }

  // Gates name engines that are not here; the laboratory has none.
  Case as_written() const {
    const Vocabulary words{{}, {}, names_of(truths()), {core()}, {}};
    return read_case_text(text("text"), text("path"), text("path"), words, Gates::left_out);
  }

  // With the values of the sliders.
  Case changed() const {
    Case read = as_written();
    KnobValues values;
    if (json.contains("knobs"))
      for (const auto& [name, value] : json.at("knobs").items()) values[name] = number_from(value);
    read.scene = with_knobs(read.scene, values);
    return read;
  }
};

namespace {

// rad/s at the start.
double largest_spin(const Scene& scene) {
  double largest = 0;
  for (const Body& body : scene.bodies) largest = std::max(largest, body.angular_velocity.norm());
  return largest;
}

Json facts_of(const EngineTable& engines, const Case& read) {
  Json steps = Json::array(), knobs = Json::array();
  for (const StepSize& dt : read.dt) steps.push_back(dt.text);
  for (const Knob& knob : knobs_of(read.scene)) knobs.push_back(json_of(knob));
  return {{"ok", true},
          {"title", read.title},
          {"source", read.source},
          {"duration", read.duration},
          {"dt", steps},
          {"truth", read.truth},
          {"spin", largest_spin(read.scene)},
          {"touches", anything_can_touch(read.scene)},
          {"knobs", knobs},
          {"lacks", refusals(engines, read.scene)},
          {"contact_lacks", contact_refusals(read.scene)},
          {"scene", rigor::json_of(read.scene)}};
}

Json explained(const EngineTable& engines, const Case& changed, const StepSize& dt, const Json& rows) {
  std::vector<LiveRun> runs;
  std::vector<std::string> names;
  CaseResult result;
  result.definition = changed;
  result.cells.resize(1);
  for (const Json& row : rows) {
    names.push_back(row.at("run").get<std::string>());
    apply_message(result, row.at("cell").get<std::string>());
    runs.push_back({names.back(), result.cells[0]});
  }
  Json sentences = Json::array();
  for (const Message& message : live_explanations(engines, changed, dt, runs))
    sentences.push_back({{"topic", message.topic}, {"text", message.text}});
  Json answer = {{"ok", true}, {"sentences", sentences}};
  if (const auto mode = stiffest_mode(changed, dt, names)) {
    Json growth = Json::object();
    for (const auto& [run, factor] : mode->growth) growth[run] = factor;
    answer["mode"] = {{"frequency", mode->frequency},
                      {"largest_step", mode->largest_step},
                      {"growth", growth},
                      {"text", sentence_on(*mode, dt)}};
  }
  return answer;
}

Json hashes_of_run(const Case& changed, const std::string& run, const StepSize& dt, long steps) {
  const RunName name = parse_run_name(run, engines().infos());
  const auto world = engines().find(name.engine).load(changed.scene, name.settings);
  RecordedStates states;
  states.add(*world);
  for (long n = 0; n < steps; ++n) world->step(dt.seconds), states.add(*world);
  std::string digits;
  for (const std::uint64_t hash : hashes_of(states)) digits += fmt::format("{:016x}", hash);
  return {{"ok", true}, {"hashes", digits}};
}

}  // namespace

LaboratoryCalls::LaboratoryCalls() = default;
LaboratoryCalls::~LaboratoryCalls() = default;

Json LaboratoryCalls::methods(const Request&) { return {{"ok", true}, {"methods", methods_json(engines_)}}; }

Json LaboratoryCalls::engine(const Request& request) {
  constexpr double kLimit = 60;  // s of a request
  const PluginStart start{request.text("command"), kLimit, -1};
  std::unique_ptr<ProcessEngine> engine;
  if (request.json.contains("info")) {
    PluginInfo info = read_plugin_info(request.json.at("info").dump(), start.command);
    engine = std::make_unique<ProcessEngine>(start, std::move(info));
  } else {
    engine = std::make_unique<ProcessEngine>(start);
  }
  const std::string name = engine->info().name;
  engines_.add(std::move(engine));
  return {{"ok", true}, {"engine", name}};
}

Json LaboratoryCalls::read(const Request& request) { return facts_of(engines_, request.as_written()); }

Json LaboratoryCalls::import(const Request& request) {
  const RobotCase robot = robot_case(request.text("path"), request.json.value("ground", false));
  return {{"ok", true}, {"text", robot.text}, {"notes", robot.notes}, {"falls", robot.falls}};
}

Json LaboratoryCalls::load(const Request& request) {
  const Case changed = request.changed();
  experiment_ = std::make_unique<Experiment>(engines_, changed.scene, request.text("run"), request.dt().seconds,
                                             changed.duration);
  Json settings = Json::array();
  for (const auto& [name, value] : experiment_->settings()) settings.push_back({name, value});
  append(experiment_->reading(0), numbers_);
  append_poses(experiment_->bodies(), numbers_);
  return {{"ok", true}, {"run", experiment_->run()}, {"settings", settings}};
}

Json LaboratoryCalls::step(const Request& request) {
  Experiment& run = loaded();
  const std::size_t before = run.readings();
  for (long n = 0, count = request.whole("count"); n < count && run.step(); ++n) {
  }
  for (std::size_t k = before; k < run.readings(); ++k) append(run.reading(k), numbers_);
  append_poses(run.bodies(), numbers_);
  return {{"ok", true}, {"steps", run.readings() - before}, {"ended", run.why_ended()}};
}

Json LaboratoryCalls::readings(const Request& request) {
  const Experiment& run = loaded();
  for (auto k = static_cast<std::size_t>(request.whole("from")); k < run.readings(); ++k)
    append(run.reading(k), numbers_);
  return {{"ok", true}};
}

Json LaboratoryCalls::truth(const Request& request) {
  const Case changed = request.changed();
  const double dt = request.dt().seconds;
  TruthTable table;
  if (request.json.value("provisional", false)) {
    table = provisional_table(changed, dt);
  } else {
    const TrueMotion motion = true_motion(changed);
    if (!motion.truth) return {{"ok", false}, {"why", motion.why_none}};
    table = truth_table(changed, motion, dt);
  }
  Json answer = json_of(table);
  answer["ok"] = true;
  numbers_ = std::move(table.numbers);
  return answer;
}

Json LaboratoryCalls::compare(const Request& request) {
  const Json& json = request.json;
  loaded().compare_with({json.at("dt"), json.at("bodies"), number_from(json.at("kinetic")),
                         number_from(json.at("change")), std::move(given_), json.at("kind"), json.at("provisional")});
  return {{"ok", true}};
}

Json LaboratoryCalls::judge(const Request& request) {
  const Experiment& run = loaded();
  return {{"ok", true}, {"cell", message_of_cell(0, run.judge(request.json.value("brief", false)), run.scene())}};
}

Json LaboratoryCalls::explain(const Request& request) {
  return explained(engines_, request.changed(), request.dt(), request.json.at("runs"));
}

Json LaboratoryCalls::hashes(const Request& request) {
  return hashes_of_run(request.changed(), request.text("run"), request.dt(), request.whole("steps"));
}

Experiment& LaboratoryCalls::loaded() const {
  if (!experiment_) throw InputError("there is no run yet; the call 'load' makes one");
  return *experiment_;
}

Json LaboratoryCalls::answer_to(const Request& request) {
  static const std::map<std::string, Json (LaboratoryCalls::*)(const Request&)> table = {
      {"compare", &LaboratoryCalls::compare}, {"engine", &LaboratoryCalls::engine},
      {"explain", &LaboratoryCalls::explain}, {"hashes", &LaboratoryCalls::hashes},
      {"import", &LaboratoryCalls::import},   {"judge", &LaboratoryCalls::judge},
      {"load", &LaboratoryCalls::load},       {"methods", &LaboratoryCalls::methods},
      {"read", &LaboratoryCalls::read},       {"readings", &LaboratoryCalls::readings},
      {"step", &LaboratoryCalls::step},       {"truth", &LaboratoryCalls::truth},
  };
  const std::string name = request.text("call");
  const auto found = table.find(name);
  if (found != table.end()) return (this->*found->second)(request);
  std::vector<std::string> names;
  for (const auto& [known, call] : table) names.push_back(known);
  throw InputError(
      fmt::format("there is no call '{}'{}; there is: {}", name, did_you_mean(name, names), listed(names)));
}

std::string LaboratoryCalls::answer(std::string_view text) {
  given_ = std::exchange(numbers_, {});
  try {
    return text_of(answer_to({parse_json(text)}), -1);
  } catch (const std::exception& error) {
    numbers_.clear();
    return text_of({{"ok", false}, {"why", in_words(error)}}, -1);
  }
}

}  // namespace rigor::inline laboratory
