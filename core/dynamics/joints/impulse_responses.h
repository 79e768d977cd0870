// The velocity changes by impulses on two bodies: of these two alone, or of all bodies that joints connect with them.
// With J the rows of the joints and M the bodies' masses and inertias,
//   dV = W p,   W = (1 - M⁻¹ Jᵀ S⁻¹ J) M⁻¹,
// W the inverse masses that the joints leave: the velocities obey the joints after each single impulse.
#pragma once

#include <vector>

#include "core/dynamics/joints/joints.h"

namespace rigor::inline dynamics {

class ImpulseResponses {
 public:
  // Both must outlive it.
  ImpulseResponses(const System& system, Joints& joints)
      : system_(system), joints_(joints), change_(system.size(), Vec6::Zero()) {}

  // The pose of the joints' last factorisation, for all that follows until the next call. The view must stay valid.
  void set_pose(BodyColumns state) { pose_ = state; }

  // The bodies that impulses on a and b change the velocities of; either may be the world.
  std::vector<int> moved_by(int a, int b) const;
  // The changes (v, w) by the impulses (N s, N m s) on a and b, by body, for the bodies in `moved_by`. Valid until the
  // next call.
  const std::vector<Vec6>& of(const std::vector<int>& moved, int a, const Vec6& on_a, int b, const Vec6& on_b);
  // The velocity change of a body without joints; zero for one that cannot move.
  Vec6 alone(int body, const Vec6& impulse) const;

 private:
  bool moves(int body) const { return body != kWorld && !system_.bodies[body].fixed; }

  const System& system_;
  Joints& joints_;
  BodyColumns pose_;
  std::vector<Vec6> change_;  // by body
};

}  // namespace rigor::inline dynamics
