// The reference in Markdown, made from the program's tables. The documentation site builds its pages from it.
#pragma once

#include <string>

#include "adapters/engines.h"

namespace rigor::inline cli {

// Pages one after another. Each begins with a first-level heading: commands, metrics, truths, engines, trajectories.
std::string reference_text(const EngineTable& engines);

}  // namespace rigor::inline cli
