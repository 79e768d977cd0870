// The quick part of a suite: the gates whose cells take only a moment each.
#pragma once

#include <vector>

#include "cases/case/case.h"
#include "core/engine/engine.h"

namespace rigor::inline gates {

// A cell is quick up to so many steps times bodies; ten thousand are some milliseconds of any engine.
inline constexpr double kQuickBodySteps = 1200;

// The cases with the gates of quick cells alone. A gate loses its longer steps, and goes where none is left; one that
// needs several steps for an order goes with the first. A case without gates goes too. Throws InputError if none is
// left.
std::vector<Case> quick_selection(const std::vector<Case>& cases, const std::vector<EngineInfo>& engines);

}  // namespace rigor::inline gates
