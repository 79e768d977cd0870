// Finds links that move as one: links that the world holds, and links without mass on a fixed joint.
#pragma once

#include "core/scene/link_model.h"

namespace rigor {

struct RigidGroups {
  static constexpr int kNone = -2;  // of a link that is left out
  std::vector<int> body;            // by link: the link with the mass that it moves with, kWorld, or kNone
};

// Leaves out links without mass that carry none, and names them. Throws InputError if a link without mass would move.
RigidGroups rigid_groups(LinkModel& model);

// Takes every joint to its `start`, with all that it carries. Limits and rests then count from there. A start beyond a
// limit becomes the limit, and model.left_out names it.
void take_to_start(LinkModel& model);

}  // namespace rigor
