#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline truth {

// The timed forces that act at t [s].
inline std::vector<const TimedForce*> acting_at(const Scene& scene, double t) {
  std::vector<const TimedForce*> acting;
  for (const TimedForce& force : scene.forces) {
    if (t >= force.from && t < force.until) acting.push_back(&force);
  }
  return acting;
}

}  // namespace rigor::inline truth
