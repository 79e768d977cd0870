// A row of the table of engines (adapters/engines.cpp). Each engine's folder defines its own: EngineRow NAME_row().
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adapters/common/compiled_mjcf.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/engine/engine.h"
#include "core/scene/left_out.h"

namespace rigor::inline adapters {

struct EngineRow {
  std::unique_ptr<Engine> (*make)();  // null where something that the engine needs at run time is not there
  // The core's methods that repeat the engine's scheme (twins); null for none.
  std::vector<Integrator> (*twins)() = nullptr;
  // See engine_calls() in adapters/engines.h; null for none.
  std::vector<std::string> (*calls)(const Settings& settings, const std::string& dt) = nullptr;
  // The engine's own format of models, see adapters/models.h; null for none.
  CompiledMjcf (*read_model)(const MjcfSource& source) = nullptr;
  std::string (*write_model)(const Scene& scene, LeftOut& left_out) = nullptr;
  // How to get an engine that make() has not made, to be read after "not installed: ".
  const char* how_to_get = nullptr;
};

template <typename Kind>
std::unique_ptr<Engine> make_engine() {
  return std::make_unique<Kind>();
}

}  // namespace rigor::inline adapters
