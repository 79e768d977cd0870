// The core for JavaScript: scenes and answers as texts, states as columns of numbers by their address.
#include <emscripten.h>

#include <exception>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/dynamics/kernels/kernels.h"
#include "core/scene/features/feature.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"
#include "core/world.h"

namespace {

using namespace rigor;

struct Loaded {
  std::unique_ptr<World> world;
  Snapshot snapshot;
  std::vector<double> rows;  // the time, then 13 numbers a body
};

std::map<int, Loaded>& worlds() {
  static std::map<int, Loaded> all;
  return all;
}

const char* kept(std::string text) {
  static std::string last;
  last = std::move(text);
  return last.c_str();
}

nlohmann::json option_json(const OptionInfo& option) {
  if (!option.choices.empty()) return {{"name", option.name}, {"meaning", option.meaning}, {"choices", option.choices}};
  return {{"name", option.name},
          {"meaning", option.meaning},
          {"min", option.min},
          {"max", option.max},
          {"whole", option.whole}};
}

}  // namespace

// Texts are valid until the next call. A text that is empty says that all went well.
extern "C" {

// The features, and the methods that take dt as it is given.
EMSCRIPTEN_KEEPALIVE const char* rigor_info() {
  const EngineInfo& info = core_info();
  nlohmann::json json = {{"version", info.version}, {"precision", info.precision}, {"lanes", kernels().name}};
  for (const Feature feature : info.features) json["features"].push_back(word_of(feature));
  for (const MethodInfo& method : info.methods) {
    if (method.adaptive || !method.twin_of.empty()) continue;
    nlohmann::json row = {{"name", method.name},
                          {"summary", method.summary},
                          {"order", method.order},
                          {"symplectic", method.symplectic},
                          {"leapfrog_stagger", method.leapfrog_stagger}};
    for (const OptionInfo& option : method.options) row["options"].push_back(option_json(option));
    json["methods"].push_back(row);
  }
  return kept(json.dump());
}

EMSCRIPTEN_KEEPALIVE const char* rigor_load(int id, const char* toml, const char* run) try {
  const TomlFile file = TomlFile::parse(toml, "the scene");
  const Scene scene = read_scene(file.root(case_keys()).at("scene"));
  worlds()[id].world = load_world(scene, run);
  return kept("");
} catch (const std::exception& error) {
  return kept(error.what());
}

EMSCRIPTEN_KEEPALIVE const char* rigor_step(int id, double dt) try {
  worlds()[id].world->step(dt);
  return kept("");
} catch (const std::exception& error) {
  return kept(error.what());
}

EMSCRIPTEN_KEEPALIVE const double* rigor_read(int id) {
  Loaded& one = worlds()[id];
  one.world->read(one.snapshot);
  const BodyColumns bodies = one.snapshot.bodies();
  one.rows.resize(1 + 13 * bodies.size());
  one.rows[0] = one.snapshot.time;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (int c = 0; c < 13; ++c) one.rows[1 + 13 * i + c] = bodies.column(c)[i];
  return one.rows.data();
}

EMSCRIPTEN_KEEPALIVE const char* rigor_settings(int id) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, value] : worlds()[id].world->settings_in_force()) json[name] = value;
  return kept(json.dump());
}

EMSCRIPTEN_KEEPALIVE void rigor_unload(int id) { worlds().erase(id); }
}
