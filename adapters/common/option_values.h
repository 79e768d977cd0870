// What an adapter asks of its settings and its scene before it converts them: the options' values, and a last guard.
#pragma once

#include "core/base/error.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {

// The runner asks why_unsupported() beforehand; a scene that comes here all the same must not run without its joints.
inline void refuse_unsupported(const EngineInfo& engine, const Scene& scene) {
  const std::string reason = why_unsupported(engine, scene, 0);
  if (!reason.empty()) throw InputError(reason);
}
inline void refuse_unsupported(const EngineInfo& engine, const Settings& settings, const Scene& scene) {
  const std::string reason = why_unsupported(engine, settings, scene, 0);
  if (!reason.empty()) throw InputError(reason);
}

}  // namespace rigor::inline adapters
