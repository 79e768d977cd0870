// Takes a model from the zeros of its joints to its state at t = 0.
#pragma once

#include "core/scene/link_model.h"

namespace rigor::inline imports {

// Takes every joint to its `start`, with all that it carries. Limits and rests then count from there. A start beyond a
// limit becomes the limit, and model.left_out names it.
void take_to_start(LinkModel& model);

}  // namespace rigor::inline imports
