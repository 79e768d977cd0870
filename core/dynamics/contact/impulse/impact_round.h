// Impacts of one instant, solved together: u_n' >= the wanted velocity, p_n >= 0 (one of them an equation), and
// Coulomb's friction, by Gauss-Seidel. No impact adds energy: where restitution would, at several points of a body or
// with friction (Kane's paradox), the impulses go only so far from those without it to those with it that none is
// added.
#pragma once

#include <vector>

#include "core/base/math.h"
#include "core/dynamics/contact/impulse/coulomb_disc.h"

namespace rigor {

struct BodyTwist {
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();  // in W
};

// One end of a contact point: what unit impulses along the normal and the two tangents make of its body's motion.
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
  Vec3 shift;             // m/s, what the velocity at the instant is more than that of the motions
  double mass = 0;        // kg, along the normal
  TangentMass tangent_mass = {};
  Vec3 before = Vec3::Zero(), impulse = Vec3::Zero();  // m/s, N s, along the directions
};

// Of the points of `a` against those of `b`.
Vec3 relative_velocity(const ImpactEnd& a, const ImpactEnd& b, const std::vector<BodyTwist>& motions);

// Sets the effective masses.
void prepare(Impact& impact);
// Changes the motions, by body, and sets the impulses.
void solve_round(std::vector<Impact>& impacts, std::vector<BodyTwist>& motions);

}  // namespace rigor
