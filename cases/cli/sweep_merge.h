// Of the parts of a sweep, the whole.
#pragma once

#include <vector>

#include "cases/cli/commands.h"
#include "cases/runner/shards/part.h"

namespace rigor {

// `line` is the one that made the parts, but for where to. Returns an ExitCode.
int merge_sweep(const CommandLine& line, const std::vector<Part>& parts, const EngineTable& engines);

}  // namespace rigor
