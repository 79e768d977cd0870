// A run's settings in an engine's own words: the calls of its adapter, to paste into a user's program.
#pragma once

#include <string>
#include <vector>

#include "core/engine/run_name.h"

namespace rigor {

// Lines of code, with `world` and `body` as in the engine's tutorials; the last line is the step, with `dt` as written.
// Empty for an engine without calls.
std::vector<std::string> engine_calls(const RunName& run, const std::string& dt);

}  // namespace rigor
