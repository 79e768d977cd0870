// Bullet's ERP and CFM of joints on the matched track, if a run does not set them; for the engine and its twin.
#pragma once

#include <algorithm>

#include "core/scene/scene.h"

namespace rigor::inline adapters::bullet {

// The share of a joint's gap that a step closes, by a speed that stays. Each step opens a gap of half the path's
// curvature times (v dt)²; 1/ERP of it remains and costs energy. At 1/30 s a rod released from the horizontal loses 62
// % of its energy in 10 s with the stock 0.2, 32 % with 0.5, 10 % with 1. But with 1 a chain that whips faster than the
// step resolves gains energy with the direct solver, a quarter of its own in 3 s.
inline constexpr double kErp = 0.5;

// CFM/dt of the direct solver, times the heaviest body's mass: no impulse is changed by more than that share.
//   Joints: at 0 the equations of a loop in a plane are singular, and the solver ends in numbers that are not finite.
//   And where rows repeat others only to first order (Bricard's linkage) a gap makes them contradict each other: at a
//   CFM of 1e-12 the linkage is 1.7 m off after 2 s at 1/30 s, with this 0.02 m. Contacts: four corners that carry one
//   box are one too many; at 0, as shipped, it is thrown away.
inline constexpr double kJointSoftness = 1e-4, kContactSoftness = 1e-5;

// CFM/dt [1/kg] of the direct solver.
inline double softness(const Scene& scene) {
  double heaviest = 0;  // kg
  for (const Body& body : scene.bodies) {
    if (!body.fixed) heaviest = std::max(heaviest, body.mass);
  }
  return heaviest > 0 ? (scene.joints.empty() ? kContactSoftness : kJointSoftness) / heaviest : 0;
}

}  // namespace rigor::inline adapters::bullet
