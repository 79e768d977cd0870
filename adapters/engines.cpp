#include "adapters/engines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "adapters/bullet/bullet_engine.h"
#include "adapters/bullet/bullet_multibody_twin.h"
#include "adapters/bullet/bullet_twin.h"
#include "adapters/core/core_engine.h"
#ifdef RIGOR_WITH_DART
#include "adapters/dart/dart_engine.h"
#include "adapters/dart/dart_twin.h"
#endif
#ifdef RIGOR_WITH_MUJOCO
#include "adapters/mujoco/mujoco_engine.h"
#include "adapters/mujoco/mujoco_twin.h"
#endif
#include "adapters/ode/ode_engine.h"
#include "adapters/ode/ode_twin.h"
#ifdef RIGOR_WITH_SICONOS
#include "adapters/siconos/siconos_engine.h"
#include "adapters/siconos/siconos_twin.h"
#endif
#ifdef RIGOR_WITH_SIMBODY
#include "adapters/simbody/simbody_engine.h"
#include "adapters/simbody/simbody_twin.h"
#endif
#include "core/base/error.h"
#include "core/engine/remote.h"

namespace rigor {
namespace {

std::vector<Integrator> twins() {
  std::vector<Integrator> rows = {kBulletMultibodyTwin, kBulletTwin, kOdeTwin};
#ifdef RIGOR_WITH_DART
  rows.push_back(kDartTwin);
#endif
#ifdef RIGOR_WITH_MUJOCO
  rows.insert(rows.end(), {kMujocoEulerTwin, kMujocoImplicitTwin, kMujocoRk4Twin});
#endif
#ifdef RIGOR_WITH_SICONOS
  rows.push_back(kSiconosTwin);
#endif
#ifdef RIGOR_WITH_SIMBODY
  const std::vector<Integrator> of_simbody = simbody_twins();
  rows.insert(rows.end(), of_simbody.begin(), of_simbody.end());
#endif
  return rows;
}

}  // namespace

// One row an engine, alphabetical.
EngineTable built_in_engines() {
  EngineTable table;
  table.add(std::make_unique<BulletEngine>());
  table.add(std::make_unique<CoreEngine>(twins()));
#ifdef RIGOR_WITH_DART
  table.add(std::make_unique<DartEngine>());
#endif
#ifdef RIGOR_WITH_MUJOCO
  table.add(std::make_unique<MujocoEngine>());
#endif
  table.add(std::make_unique<OdeEngine>());
#ifdef RIGOR_WITH_SICONOS
  table.add(std::make_unique<SiconosEngine>());
#endif
#ifdef RIGOR_WITH_SIMBODY
  table.add(std::make_unique<SimbodyEngine>());
#endif
  return table;
}

const std::vector<MissingEngine>& missing_engines() {
  static const std::vector<MissingEngine> missing = {
#ifndef RIGOR_WITH_DART
      {"dart", "libdart-dev and libdart-external-ikfast-dev"},
#endif
#ifndef RIGOR_WITH_MUJOCO
      {"mujoco", "libmujoco-dev"},
#endif
#ifndef RIGOR_WITH_SICONOS
      {"siconos", "libsiconos-mechanics-dev"},
#endif
#ifndef RIGOR_WITH_SIMBODY
      {"simbody", "libsimbody-dev"},
#endif
  };
  return missing;
}

const std::vector<EngineOnRequest>& engines_on_request() {
  static const std::vector<EngineOnRequest> named = {
      {"siconos", "a case with joints takes it some 20 s, and many with contacts its solver does not bring to its law"},
  };
  return named;
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
  for (const auto& engine : engines_) {
    if (const auto* remote = dynamic_cast<const RemoteEngine*>(engine.get())) remote->rest();
  }
}

const Engine& EngineTable::find(const std::string& name) const { return *engines_[index_of(name)]; }

}  // namespace rigor
