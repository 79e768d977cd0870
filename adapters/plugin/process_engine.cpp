#include "adapters/plugin/process_engine.h"

#include <fmt/format.h>

#include <utility>

#include "adapters/common/option_values.h"
#include "adapters/plugin/process_world.h"
#include "core/engine/engine_failure.h"

namespace rigor {

ProcessEngine::ProcessEngine(PluginStart start) : start_(std::move(start)) {
  try {
    info_ = ProcessSession(start_).info();
  } catch (const EngineFailure& failure) {
    throw InputError(failure.what());
  }
}

ProcessEngine::ProcessEngine(PluginStart start, PluginInfo info) : start_(std::move(start)), info_(std::move(info)) {}

ProcessEngine::~ProcessEngine() = default;

std::unique_ptr<World> ProcessEngine::load(const Scene& scene, const Settings& settings) const {
  refuse_unsupported(info_.engine, settings, scene);
  if (!session_ || !session_->is_usable()) {
    try {
      session_ = std::make_shared<ProcessSession>(start_);
    } catch (const InputError& error) {
      throw EngineFailure(FailureKind::invalid, error.what());
    }
    const std::string& now = session_->info().engine.name;
    if (now != info_.engine.name)
      throw EngineFailure(FailureKind::invalid, fmt::format("{} called itself '{}' before and '{}' now",
                                                            session_->child().name(), info_.engine.name, now));
  }
  return std::make_unique<ProcessWorld>(session_, scene, settings);
}

void ProcessEngine::rest() const { session_.reset(); }

}  // namespace rigor
