// The stiffness of a scene's springs, independent of any engine.
#pragma once

#include "core/scene/scene.h"

namespace rigor::inline analysis {

// The angular frequency [rad/s] of the stiffest small oscillation of a scene's springs at t = 0: the square root of the
// largest eigenvalue of K^½ J M⁻¹ Jᵀ K^½, where a row of J takes the bodies' velocities to a spring's lengthening.
// The stiffness of a stretched spring across its line is left out.
double stiffest_frequency(const Scene& scene);

}  // namespace rigor::inline analysis
