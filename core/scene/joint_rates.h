// How fast two bodies come apart at a joint at t = 0: what a joint's initial velocities may not do. Its initial pose
// cannot break it: anchors, axes, offsets and distances are those at t = 0, whatever they are.
#pragma once

#include "core/scene/scene.h"

namespace rigor {

struct JointRates {
  double speed = 0;      // m/s: of the shared point, across the slider's axis, along the distance
  double turn_rate = 0;  // rad/s: about what the joint does not let turn
};

JointRates initial_rates(const Scene& scene, const Joint& joint);

// What rounding and a file's twelve digits leave of rates that are meant to be zero; what is beyond this is a broken
// joint. No result shows so little.
inline constexpr double kNoRate = 1e-9;  // m/s, rad/s for each 1 + the fastest of the two bodies

// "" if the joint's initial velocities keep it, else how they do not: "they part at 0.1 m/s and 0 rad/s".
std::string why_rates_break(const Scene& scene, const Joint& joint);

}  // namespace rigor
