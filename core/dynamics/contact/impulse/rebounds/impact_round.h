// Simultaneous impacts, solved together by Gauss-Seidel: u_n' >= the wanted velocity, p_n >= 0 (one of them an
// equation), and Coulomb's friction. No impact adds energy. Restitution can add it at several points of a body or with
// friction (Kane's paradox). The impulses then move only part of the way from those without restitution to those with
// it.
#pragma once

#include <vector>

#include "core/base/math.h"
#include "core/dynamics/contact/impulse/coulomb_disc.h"

namespace rigor::inline dynamics {

struct BodyTwist {
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();  // in W
};

// One end of a contact point: the motion of its body by unit impulses along the normal and the two tangents.
struct ImpactEnd {
  int body;
  double inverse_mass;  // 1/kg
  Vec3 arm;             // m, from the centre of mass
  Vec3 angular[3];      // I⁻¹ (arm x direction)
};

struct Impact {
  ImpactEnd a, b;
  Vec3 directions[3];  // unit, in W: the normal, from b to a, and two tangents
  double instant;      // s
  double friction;
  double wanted;          // m/s, of the normal velocity, with restitution, and
  double wanted_without;  // without
  Vec3 shift;             // m/s, the velocity at the instant minus that of the motions
  double mass = 0;        // kg, along the normal
  TangentMass tangent_mass = {};
  Vec3 before = Vec3::Zero(), impulse = Vec3::Zero();  // m/s, N s, along the directions
};

// The difference of the points of `a` and `b`.
Vec3 relative_velocity(const ImpactEnd& a, const ImpactEnd& b, const std::vector<BodyTwist>& motions);

// Sets the effective masses.
void prepare(Impact& impact);
// Changes the motions, by body, and sets the impulses.
void solve_round(std::vector<Impact>& impacts, std::vector<BodyTwist>& motions);

}  // namespace rigor::inline dynamics
