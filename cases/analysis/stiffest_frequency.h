// The stiffness of a scene's springs, for any engine.
#pragma once

#include "core/scene/scene.h"

namespace rigor {

// The angular frequency [rad/s] of the stiffest small oscillation of a scene's springs at t = 0. It is the square root
// of the largest eigenvalue of K^½ J M⁻¹ Jᵀ K^½. A row of J maps the bodies' velocities to a spring's rate of length.
// The stiffness that a stretched spring has across its line is left out.
double stiffest_frequency(const Scene& scene);

}  // namespace rigor
