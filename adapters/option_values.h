// The values of a run's options, which have been checked against the method's table before an engine is loaded, and the
// last guard before a scene is converted.
#pragma once

#include <string>

#include "core/engine/engine.h"
#include "core/error.h"

namespace rigor {

inline std::string word_option(const Settings& settings, const std::string& name, const std::string& otherwise) {
  const auto found = settings.options.find(name);
  return found == settings.options.end() ? otherwise : found->second;
}

inline double number_option(const Settings& settings, const std::string& name, double otherwise) {
  const auto found = settings.options.find(name);
  return found == settings.options.end() ? otherwise : std::stod(found->second);
}

// The runner asks why_unsupported() beforehand; a scene that comes here all the same must not run without its joints.
inline void refuse_unsupported(const EngineInfo& engine, const Scene& scene) {
  const std::string reason = why_unsupported(engine, scene, 0);
  if (!reason.empty()) throw InputError(reason);
}

}  // namespace rigor
