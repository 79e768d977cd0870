#include "core/dynamics/free_rotation.h"

namespace rigor {
namespace {

// Turns P by the exact flow of excess/2 L_k² over dt, with L (in W) unchanged.
void turn_about_axis(Quat& q_WP, const Vec3& L, int k, double excess, double dt) {
  const double L_k = (q_WP.conjugate() * L)[k];
  q_WP = q_WP * rotation_by(dt * excess * L_k * Vec3::Unit(k));
}

}  // namespace

FreeRotation::FreeRotation(const Inertia& body) {
  if (body.fixed) return;
  const PrincipalInertia principal = principal_inertia(body.inertia_B);
  const Vec3 inverse = principal.moments.cwiseInverse();
  q_BP_ = principal.q_BP;
  inverse_median_ = inverse.y();
  excess_low_ = inverse.x() - inverse.y();
  excess_high_ = inverse.z() - inverse.y();
}

Quat FreeRotation::advance(const Quat& q_WB, const Vec3& L, double dt) const {
  Quat q_WP = q_WB * q_BP_;
  turn_about_axis(q_WP, L, 0, excess_low_, 0.5 * dt);
  turn_about_axis(q_WP, L, 2, excess_high_, dt);
  turn_about_axis(q_WP, L, 0, excess_low_, 0.5 * dt);
  q_WP = rotation_by(dt * inverse_median_ * L) * q_WP;
  return (q_WP * q_BP_.conjugate()).normalized();
}

std::vector<FreeRotation> free_rotations(const System& system) { return {system.bodies.begin(), system.bodies.end()}; }

}  // namespace rigor
