// How stiff a scene's springs are, whatever runs it.
#pragma once

#include "core/scene/scene.h"

namespace rigor {

// The angular frequency [rad/s] of the stiffest small oscillation of a scene's springs at t = 0: the square root of the
// largest eigenvalue of K^½ J M⁻¹ Jᵀ K^½, where a row of J takes the bodies' velocities to a spring's lengthening.
// Springs as they stand: the stiffness that a stretched spring has across its line is left out.
double stiffest_frequency(const Scene& scene);

}  // namespace rigor
