// ENGINE[:METHOD][,key=value…][@TRACK], as in "core:rk4", "ode:quickstep,iterations=50", "bullet@stock".
#pragma once

#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor::inline engine {

struct RunName {
  std::string engine;
  Settings settings;
  std::string text;  // as reports show it: the method written out where the engine has several
};

// Throws InputError, with a near match, for an engine, method, option, value or track that is not there.
RunName parse_run_name(const std::string& text, const std::vector<EngineInfo>& engines);

// The method a run's settings name.
const MethodInfo& method_of(const EngineInfo& engine, const Settings& settings);

}  // namespace rigor::inline engine
