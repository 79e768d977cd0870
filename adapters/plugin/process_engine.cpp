#include "adapters/plugin/process_engine.h"

#include <fmt/format.h>

#include <utility>

#include "adapters/common/option_values.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline adapters {

ProcessEngine::ProcessEngine(PluginStart start) : start_(std::move(start)) {
  try {
    info_ = ProcessSession(start_).info();
  } catch (const EngineFailure& failure) {
    throw InputError(failure.what());
  }
}

ProcessEngine::ProcessEngine(PluginStart start, PluginInfo info)
    : start_(std::move(start)), info_(std::move(info)), is_known_(true) {}

ProcessEngine::~ProcessEngine() = default;

std::unique_ptr<World> ProcessEngine::load(const Scene& scene, const Settings& settings) const {
  refuse_unsupported(info_.engine, settings, scene);
  if (!session_ || !session_->is_usable()) {
    try {
      session_ = std::make_shared<ProcessSession>(start_);
    } catch (const InputError& error) {
      throw EngineFailure(FailureKind::invalid, error.what());
    }
    const EngineInfo &due = info_.engine, &now = session_->info().engine;
    if (now.name != due.name || now.version != due.version)
      throw EngineFailure(FailureKind::invalid,
                          fmt::format("{} called itself '{} {}' before and '{} {}' now", session_->child().name(),
                                      due.name, due.version, now.name, now.version));
    if (is_known_) session_->describe(info_);
  }
  return std::make_unique<ProcessWorld>(session_, scene, settings, terms_of(scene, settings));
}

WorldTerms ProcessEngine::terms_of(const Scene&, const Settings&) const {
  return {"", info_.has_contacts, info_.has_reactions};
}

void ProcessEngine::rest() const { session_.reset(); }

}  // namespace rigor::inline adapters
