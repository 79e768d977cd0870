// The values of a run's options, which have been checked against the method's table before anything is loaded.
#pragma once

#include <string>

#include "core/engine/engine.h"

namespace rigor {

inline std::string word_option(const Settings& settings, const std::string& name, const std::string& otherwise) {
  const auto found = settings.options.find(name);
  return found == settings.options.end() ? otherwise : found->second;
}

inline double number_option(const Settings& settings, const std::string& name, double otherwise) {
  const auto found = settings.options.find(name);
  return found == settings.options.end() ? otherwise : std::strtod(found->second.c_str(), nullptr);
}

}  // namespace rigor
