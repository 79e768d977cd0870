#include "adapters/engines.h"
#include "adapters/mjcf/mjcf_import.h"
#include "adapters/mjcf/mujoco3_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <initializer_list>
#include <utility>

#include "adapters/common/engine_row.h"
#include "adapters/core/core_engine.h"
#include "adapters/models.h"
#include "core/base/error.h"
#include "core/engine/engine.h"

// CMake lists the engines whose library it found, as ROW(bullet) ROW(core) ..., in alphabetical order, and the packages
// of the others (adapters/CMakeLists.txt).
#ifndef RIGOR_ENGINE_ROWS
#define RIGOR_ENGINE_ROWS ROW(core)
#define RIGOR_MISSING_ENGINES
#endif

namespace rigor::inline adapters {

#define ROW(engine) EngineRow engine##_row();
RIGOR_ENGINE_ROWS
#undef ROW

namespace {

struct NamedRow {
  std::string engine;
  EngineRow row;
};

const std::vector<NamedRow>& rows() {
#define ROW(engine) {#engine, engine##_row()},
  static const std::vector<NamedRow> all = {RIGOR_ENGINE_ROWS};
#undef ROW
  return all;
}

std::unique_ptr<Engine> make_core() {
  std::vector<Integrator> twins;
  for (const NamedRow& named : rows()) {
    if (!named.row.twins) continue;
    const std::vector<Integrator> own = named.row.twins();
    twins.insert(twins.end(), own.begin(), own.end());
  }
  return std::make_unique<CoreEngine>(std::move(twins));
}

}  // namespace

EngineRow core_row() { return {make_core}; }

EngineTable built_in_engines() {
  EngineTable table;
  for (const NamedRow& named : rows()) {
    if (std::unique_ptr<Engine> engine = named.row.make()) table.add(std::move(engine));
  }
  return table;
}

std::vector<std::string> engine_calls(const RunName& run, const std::string& dt) {
  for (const NamedRow& named : rows())
    if (named.engine == run.engine && named.row.calls) return named.row.calls(run.settings, dt);
  return {};
}

namespace {

// MJCF needs MuJoCo; `does` names the action.
const EngineRow& row_for_mjcf(const std::string& does) {
  for (const NamedRow& named : rows())
    if (named.row.read_model && named.row.write_model) return named.row;
  throw InputError(
      fmt::format("{} MuJoCo, without which this program was built; install libmujoco-dev and build again", does));
}

}  // namespace

LinkModel mujoco_link_model(const MjcfSource& source) {
  if (!mujoco3_folder().empty()) return links_of_mjcf(source, read_with_mujoco3(source));
  const EngineRow& row = row_for_mjcf(source.path + ":1: MJCF is read by");
  try {
    return links_of_mjcf(source, row.read_model(source));
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.find("MuJoCo refuses") == std::string::npos) throw;
    throw InputError(what + ". A newer MuJoCo may read it: npm install @mujoco/mujoco, and RIGOR_MUJOCO3=that folder");
  }
}

std::string mjcf_of(const Scene& scene, LeftOut& left_out) {
  return row_for_mjcf("MJCF is written by").write_model(scene, left_out);
}

namespace {

struct NotBuilt {
  const char *name, *package;  // Debian's, for its library
};

std::vector<MissingEngine> find_missing_engines() {
  std::vector<MissingEngine> missing;
  for (const NotBuilt& row : std::initializer_list<NotBuilt>{RIGOR_MISSING_ENGINES})
    missing.push_back({row.name, fmt::format("not built: install {} and build again", row.package)});
  for (const NamedRow& named : rows()) {
    if (named.row.how_to_get && !named.row.make())
      missing.push_back({named.engine, fmt::format("not installed: {}", named.row.how_to_get)});
  }
  std::sort(missing.begin(), missing.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return missing;
}

}  // namespace

const std::vector<MissingEngine>& missing_engines() {
  static const std::vector<MissingEngine> missing = find_missing_engines();
  return missing;
}

const std::vector<EngineOnRequest>& engines_on_request() {
  static const std::vector<EngineOnRequest> named = {
      {"mujoco3", "its formulas are those of mujoco, and each cell starts Node, which takes a second", "mujoco"},
      {"siconos", "a case with joints takes it some 20 s, and in many with contacts its solver does not converge"},
  };
  return named;
}

std::string formulas_of(const std::string& engine) {
  for (const EngineOnRequest& row : engines_on_request())
    if (row.name == engine && !row.formulas_of.empty()) return row.formulas_of;
  return engine;
}

bool is_on_request(const std::string& engine) {
  const auto& named = engines_on_request();
  return std::any_of(named.begin(), named.end(), [&](const EngineOnRequest& row) { return row.name == engine; });
}

const EngineTable& engines() {
  static const EngineTable table = built_in_engines();
  return table;
}

void EngineTable::add(std::unique_ptr<Engine> engine, std::string identity) {
  EngineInfo info = engine->info();
  const bool is_taken = std::any_of(infos_.begin(), infos_.end(), [&](const auto& i) { return i.name == info.name; });
  if (is_taken) throw InputError(fmt::format("there are two engines called '{}'", info.name));
  engines_.push_back(std::move(engine)), infos_.push_back(std::move(info));
  identities_.push_back(std::move(identity));
}

std::size_t EngineTable::index_of(const std::string& name) const {
  const auto found = std::find_if(infos_.begin(), infos_.end(), [&](const auto& info) { return info.name == name; });
  assert(found != infos_.end() && "run names are checked against the table before an engine is asked for");
  return static_cast<std::size_t>(found - infos_.begin());
}

const EngineInfo& EngineTable::info_of(const std::string& name) const { return infos_[index_of(name)]; }

const std::string& EngineTable::identity_of(const std::string& name) const { return identities_[index_of(name)]; }

void EngineTable::rest() const {
  for (const auto& engine : engines_) engine->rest();
}

const Engine& EngineTable::find(const std::string& name) const { return *engines_[index_of(name)]; }

}  // namespace rigor::inline adapters
