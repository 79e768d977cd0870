#include "adapters/engines.h"

#include <algorithm>
#include <cassert>

#include "adapters/bullet/bullet_engine.h"
#include "adapters/core/core_engine.h"
#include "adapters/ode/ode_engine.h"

namespace rigor {

// One row an engine, alphabetical.
const EngineTable& engines() {
  static const EngineTable table = [] {
    EngineTable rows;
    rows.push_back(std::make_unique<BulletEngine>());
    rows.push_back(std::make_unique<CoreEngine>());
    rows.push_back(std::make_unique<OdeEngine>());
    return rows;
  }();
  return table;
}

std::vector<EngineInfo> infos_of(const EngineTable& table) {
  std::vector<EngineInfo> infos;
  for (const auto& engine : table) infos.push_back(engine->info());
  return infos;
}

const Engine& find_engine(const EngineTable& table, const std::string& name) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& e) { return e->info().name == name; });
  assert(found != table.end() && "run names are checked against the table before an engine is asked for");
  return **found;
}

}  // namespace rigor
