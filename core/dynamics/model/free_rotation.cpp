#include "core/dynamics/model/free_rotation.h"

namespace rigor::inline dynamics {

FreeRotation::FreeRotation(const Inertia& body) {
  if (body.fixed) return;
  const PrincipalInertia principal = principal_inertia(body.inertia_B);
  const Vec3 inverse = principal.moments.cwiseInverse();
  q_BP = principal.q_BP;
  inverse_median = inverse.y();
  excess_low = inverse.x() - inverse.y();
  excess_high = inverse.z() - inverse.y();
}

}  // namespace rigor::inline dynamics
