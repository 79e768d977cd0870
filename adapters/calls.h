// What a run's settings are in an engine's own words: the calls that its adapter makes for them, to paste into one's
// own program.
#pragma once

#include <string>
#include <vector>

#include "core/engine/run_name.h"

namespace rigor {

// Lines of code, `world` and `body` as the engine's tutorials call them; the last is the step, of `dt` as written. None
// for an engine that has no calls of its own.
std::vector<std::string> engine_calls(const RunName& run, const std::string& dt);

}  // namespace rigor
