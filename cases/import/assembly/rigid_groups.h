// Finds links that move as one: links that the world holds, and links without inertia on a fixed joint. The masses of
// points add up with that of the link that carries them.
#pragma once

#include "core/scene/link_model.h"

namespace rigor::inline imports {

struct RigidGroups {
  static constexpr int kNone = -2;     // of a link that is left out
  static constexpr int kBetween = -3;  // of a link without mass between two joints, which become one joint
  std::vector<int> body;               // by link: the first link with mass that it moves with, kWorld, or one of these
  std::vector<int> set;                // by link: equal for links without inertia that fixed joints connect
  std::vector<LinkInertial> inertial;  // by link: of the whole group, at the link that `body` names
};

// Leaves out links without mass that carry none, and names them. Throws InputError if a link without mass would move
// by itself.
RigidGroups rigid_groups(LinkModel& model);

// The mass, the centre of mass and the inertia of several parts together.
LinkInertial sum_of(const std::vector<LinkInertial>& parts);

}  // namespace rigor::inline imports
