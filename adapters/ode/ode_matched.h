// ODE's ERP and CFM on the matched track, if a run does not set them; for the engine and its twin.
#pragma once

#include <algorithm>

#include "core/scene/scene.h"

namespace rigor::inline adapters {

// The share of a joint's gap that a step closes. The scheme opens a gap of half the path's curvature times (v dt)² in
// each step; 1/ERP of it remains and costs energy. At 1/30 s a rod released from the horizontal loses a quarter of its
// energy in two seconds with the stock 0.2, and a tenth with 0.5. From 0.65 on a chain that whips faster than the step
// resolves gains energy, sixteen times its own at 0.8; at 0.5 it still loses some.
inline constexpr double kMatchedJointErp = 0.5;

// CFM/dt, as a share of the heaviest body's 1/mass: an impulse is changed by no more than that share.
//   Joints: rows that repeat others are one equation too many, and where they repeat them only to first order
//   (Bricard's linkage) a gap makes them contradict each other, which ODE's 1e-10 turns into a brake: at 1/30 s the
//   linkage is 0.5 m off after two seconds, with this 0.03 m, and no other case of the suite changes by 1 %. At 0 the
//   equations of every closed loop in a plane are singular, and ODE aborts.
//   Contacts: several that carry one body are too many equations as well, at which the direct solver may give up ("LCP
//   internal error"): with this a card house never does, a stack of ten boxes still in 4 of 600 steps.
inline constexpr double kMatchedJointSoftness = 1e-4;
inline constexpr double kMatchedContactSoftness = 1e-5;

inline double matched_softness_share(const Scene& scene) {
  return scene.joints.empty() ? kMatchedContactSoftness : kMatchedJointSoftness;
}

// CFM/dt [1/kg].
inline double matched_softness(const Scene& scene) {
  double heaviest = 0;  // kg
  for (const Body& body : scene.bodies) {
    if (!body.fixed) heaviest = std::max(heaviest, body.mass);
  }
  return heaviest > 0 ? matched_softness_share(scene) / heaviest : 0;
}

}  // namespace rigor::inline adapters
