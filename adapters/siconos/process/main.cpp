// rigor-siconos: Siconos as a process that speaks Rigor's protocol for engines from outside
// (adapters/plugin/README.md). It is a separate process, because its libraries load Bullet in single precision, which
// conflicts with our double-precision one.
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "adapters/siconos/process/siconos_world.h"
#include "adapters/siconos/siconos_info.h"
#include "adapters/siconos/siconos_matched.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline adapters::siconos {
namespace {

using Json = nlohmann::json;

// The same keys and values as an inline table of TOML, which the scene's own reader takes.
std::string toml_of(const Json& json) {
  if (!json.is_structured()) return json.dump();
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (!text.empty()) text += ", ";
    if (json.is_object()) text += key + " = ";
    text += toml_of(value);
  }
  return json.is_object() ? "{ " + text + " }" : "[" + text + "]";
}

// The protocol knows bodies by their order, the reader by their names: of two of one name the first keeps it.
Json with_names_apart(Json scene) {
  std::set<std::string> seen;
  for (Json& body : scene.at("body")) {
    std::string name = body.at("name");
    while (!seen.insert(name).second) name += "'";
    body["name"] = name;
  }
  return scene;
}

Scene scene_of(const Json& json) {
  const TomlFile file = TomlFile::parse("scene = " + toml_of(with_names_apart(json)) + "\n", "the scene");
  return read_scene(file.root({"scene"}).at("scene"), InitialVelocities::as_given);
}

StepSettings settings_of(const Json& json) {
  StepSettings settings;
  const Json options = json.value("options", Json::object());
  settings.is_matched = json.value("track", "matched") == "matched";
  settings.theta = options.value("theta", kSiconosTheta);
  if (settings.is_matched) settings.tolerance = kSiconosTolerance, settings.iterations = kSiconosIterations;
  if (options.contains("tolerance")) settings.tolerance = options["tolerance"];
  if (options.contains("iterations")) settings.iterations = static_cast<int>(options["iterations"].get<double>());
  return settings;
}

class Worlds {
 public:
  Json answer(const Json& ask) {
    const std::string call = ask.at("call");
    if (call == "info") return Json::parse(siconos_info());
    const int number = ask.at("world");
    if (call == "load") return load(number, ask);
    if (call == "unload") return worlds_.erase(number), Json{{"ok", true}};
    SiconosWorld& world = worlds_.at(number);
    if (call == "step") {
      world.step(ask.at("dt"));
      return with_warning({{"ok", true}}, world.warning());
    }
    if (call == "read") return sample(world, true);
    if (call == "contacts") return contacts(world);
    if (call == "run") return run(world, ask.at("dt"), ask.at("count"), ask.at("every"));
    return {{"ok", false}, {"status", "failed"}, {"why", "no such call: " + call}};
  }
  // The numbers that follow the last answer.
  std::vector<double> take_columns() { return std::exchange(columns_, {}); }

 private:
  static Json with_warning(Json answer, const std::string& warning) {
    if (!warning.empty()) answer["warning"] = warning;
    return answer;
  }
  Json load(int number, const Json& ask) {
    const auto& [at, is_new] = worlds_.try_emplace(number, scene_of(ask.at("scene")), settings_of(ask.at("settings")));
    Json settings = Json::object();
    for (const auto& [name, value] : at->second.settings_in_force()) settings[name] = value;
    return {{"ok", true}, {"settings", settings}};
  }
  Json sample(const SiconosWorld& world, bool is_whole) {
    if (const int body = world.lost_body(); body >= 0) {
      columns_.clear();
      return {{"ok", false},
              {"status", "diverged"},
              {"why", "a number is not finite"},
              {"time", world.time()},
              {"body", body}};
    }
    const BodyColumns state = world.state();
    for (int c = 0; c < 13; ++c) columns_.insert(columns_.end(), state.column(c), state.column(c) + state.size());
    Json out = {{"time", world.time()}};
    if (is_whole) out["ok"] = true;
    return out;
  }
  static Json contacts(const SiconosWorld& world) {
    const auto list = [](const Vec3& v) { return Json{v.x(), v.y(), v.z()}; };
    Json contacts = Json::array();
    for (const ReportedContact& at : world.contacts()) {
      contacts.push_back({{"a", at.a},
                          {"b", at.b},
                          {"point", list(at.point)},
                          {"normal", list(at.normal)},
                          {"gap", at.gap},
                          {"force", list(at.force)}});
    }
    return {{"ok", true}, {"contacts", contacts}};
  }
  Json run(SiconosWorld& world, double dt, long count, long every) {
    Json samples = Json::array();
    std::string warning;
    for (long n = 1; n <= count; ++n) {
      world.step(dt);
      if (warning.empty()) warning = world.warning();
      if (n % every != 0 && n != count) continue;
      Json one = sample(world, false);
      if (one.contains("ok")) return one;
      samples.push_back(std::move(one));
    }
    return with_warning({{"ok", true}, {"samples", samples}}, warning);
  }

  std::map<int, SiconosWorld> worlds_;
  std::vector<double> columns_;
};

// Siconos's own output goes to stderr, so that it never mixes with the answers.
std::FILE* answers_alone() {
  std::FILE* answers = fdopen(dup(STDOUT_FILENO), "w");
  dup2(STDERR_FILENO, STDOUT_FILENO);
  return answers;
}

int serve() {
  std::FILE* answers = answers_alone();
  Worlds worlds;
  for (std::string line; std::getline(std::cin, line);) {
    Json answer;
    try {
      answer = worlds.answer(Json::parse(line));
    } catch (const std::exception& error) {
      answer = {{"ok", false}, {"status", "failed"}, {"why", error.what()}};
      worlds.take_columns();
    }
    const std::string text = answer.dump() + "\n";
    const std::vector<double> columns = worlds.take_columns();
    std::fwrite(text.data(), 1, text.size(), answers);
    if (!columns.empty()) std::fwrite(columns.data(), sizeof(double), columns.size(), answers);
    std::fflush(answers);
  }
  return 0;
}

}  // namespace
}  // namespace rigor::inline adapters::siconos

int main() { return rigor::siconos::serve(); }
