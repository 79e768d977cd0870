// Which links move as one: what the world holds, and links without mass, which are but frames of the link that a fixed
// joint holds them to.
#pragma once

#include "core/scene/link_model.h"

namespace rigor {

struct RigidGroups {
  static constexpr int kNone = -2;  // of a link that is left out
  std::vector<int> body;            // by link: the link with the mass that it moves with, kWorld, or kNone
};

// What has no mass and hangs on nothing that has is left out, and named; what would move without mass is refused.
RigidGroups rigid_groups(LinkModel& model);

// Takes every joint to its `start`, with all that it carries; limits, rests and starts are from there on. A start
// beyond a limit becomes the limit, which is said.
void take_to_start(LinkModel& model);

}  // namespace rigor
