// The turn in which the angle of a joint's free coordinate is known from the pose alone.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "core/scene/scene.h"

namespace rigor::inline scene {

// The middle [rad] between a hinge's two limits that are less than a turn apart. Within half a turn of it, springs and
// servos count whole turns. Null for any other joint: there a spring's angle lies between -pi and pi, and a servo takes
// the shorter way.
inline std::optional<double> middle_of_turn(const Joint& joint) {
  if (!free_axis(joint) || !turns(joint) || !(joint.upper - joint.lower < 2 * std::numbers::pi)) return {};
  return (joint.lower + joint.upper) / 2;
}

// Whether a servo of the joint turns it towards its target by at most half a turn.
inline bool takes_the_shorter_way(const Joint& joint) { return turns(joint) && !middle_of_turn(joint); }

}  // namespace rigor::inline scene
