// The relative velocity of two bodies at a joint at t = 0 that the joint does not allow. An initial pose never violates
// a joint, because anchors, axes, offsets and distances are those at t = 0.
#pragma once

#include "core/scene/scene.h"

namespace rigor::inline scene {

struct JointRates {
  double speed = 0;      // m/s: of the shared point, across the slider's axis, along the distance
  double turn_rate = 0;  // rad/s: about the locked axes
};

JointRates initial_rates(const Scene& scene, const Joint& joint);

// Rates from rounding and from a file's twelve digits that should be zero. Larger rates violate the joint. No result
// reveals such small ones.
inline constexpr double kNoRate = 1e-9;  // m/s, rad/s for each 1 + the fastest of the two bodies

// "" if the joint's initial velocities keep it, else how they do not: "they part at 0.1 m/s and 0 rad/s".
std::string why_rates_break(const Scene& scene, const Joint& joint);
std::string why_rates_break(const Scene& scene, const Coupling& coupling);

}  // namespace rigor::inline scene
