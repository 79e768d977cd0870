#include "bench/wasm/scene_files.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "adapters/plugin/plugins.h"
#include "bench/reached.h"
#include "bench/scenes.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor::bench {
namespace {

struct WasmScene {
  const char* scene;
  int count;
  double goal;                             // times as fast as the fastest of the others
  std::vector<const char*> substeps = {};  // of the core beside its four, where bodies touch: for other overlaps
};
const std::vector<WasmScene> kScenes = {{"free-bodies", 1000, 5},
                                        {"pile", 216, 1.5, {"2", "6"}},
                                        {"pyramid", 1240, 1.2, {"2", "3"}},
                                        {"chain", 95, 0},
                                        {"bare-ragdolls", 1000, 2}};

// A run of a plug-in in a scene. The core's contact method is the one that is built for many contacts.
struct WasmRun {
  std::string name;  // as the table names it
  Settings settings;
};

// MuJoCo's settings of the track `matched` buy accuracy with most of its time, so it also runs as it ships; it has no
// sleeping. So does Havok, to which the track `matched` adds the gyroscopic torque from JavaScript.
std::vector<WasmRun> runs_of(const EngineInfo& info, const WasmScene& at) {
  Settings settings;
  settings.method = info.methods.front().name;
  const bool is_core = info.name.starts_with("core-wasm");
  if (is_core && !at.substeps.empty()) settings.options["contact"] = "impulse";
  std::vector<WasmRun> runs = {{info.name, settings}};
  if (info.name == "mujoco-js" || info.name == "havok") {
    settings.track = Track::stock;
    runs.push_back({info.name + "@stock", settings});
  }
  for (const char* substeps : at.substeps) {
    if (info.name != "core-wasm") break;
    settings.options["substeps"] = substeps;
    runs.push_back({info.name + ",substeps=" + substeps, settings});
  }
  return runs;
}

Json reached_json(const WasmScene& at, const Engine& engine, const WasmRun& run) {
  Json json = {{"engine", engine.info().name},    {"run", run.name},
               {"method", run.settings.method},   {"track", run.settings.track == Track::stock ? "stock" : "matched"},
               {"options", Json::object()},       {"precision", engine.info().precision},
               {"version", engine.info().version}};
  for (const auto& [key, value] : run.settings.options) {
    const bool is_word = key == "contact";
    json["options"][key] = is_word ? Json(value) : Json(std::stod(value));
  }
  const SceneRow& row = scene_row(at.scene);
  try {
    const std::string why = why_unsupported(engine.info(), run.settings, scene_of(row, at.count), row.dt);
    if (!why.empty()) throw InputError(why);
    for (const auto& [name, value] : reached(row, at.count, engine, run.settings))
      json["reached"][name] = std::isfinite(value) ? Json(value) : Json(nullptr);
  } catch (const std::runtime_error& failure) {
    json["why"] = failure.what();
  }
  std::cerr << at.scene << " " << run.name << ": " << json.value("why", json["reached"].dump()) << "\n";
  return json;
}

}  // namespace

void write_scene_files(const std::string& dir, const std::vector<std::string>& plugins) {
  EngineTable table;
  constexpr double kLimit = 120;  // s, for one request
  for (const std::string& plugin : plugins) add_plugin(table, plugin, kLimit);
  std::filesystem::create_directories(dir);
  Json all = Json::array();
  for (const WasmScene& at : kScenes) {
    const SceneRow& row = scene_row(at.scene);
    Json runs = Json::array();
    for (const EngineInfo& info : table.infos()) {
      for (const WasmRun& run : runs_of(info, at)) runs.push_back(reached_json(at, table.find(info.name), run));
    }
    all.push_back({{"name", at.scene},
                   {"count", at.count},
                   {"goal", at.goal},
                   {"dt", row.dt},
                   {"steps", steps_of_interval(row, at.count)},
                   {"goes_on", row.goes_on},
                   {"scene", Json::parse(scene_json(scene_of(row, at.count)))},
                   {"runs", runs}});
  }
  std::ofstream(std::filesystem::path(dir) / "scenes.json") << all.dump() << "\n";
}

}  // namespace rigor::bench
