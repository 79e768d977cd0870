// What impulses on two bodies make of velocities: of these two alone or, where joints hold them, of all bodies that are
// connected with them. With J the rows of the joints and M the bodies' masses and inertias,
//   dV = W p,   W = (1 - M⁻¹ Jᵀ S⁻¹ J) M⁻¹,
// W the inverse masses that the joints leave: the velocities obey the joints after each single impulse.
#pragma once

#include <vector>

#include "core/dynamics/joints/joints.h"

namespace rigor {

class ImpulseResponses {
 public:
  // Both must outlive it.
  ImpulseResponses(const System& system, Joints& joints)
      : system_(system), joints_(joints), change_(system.size(), Vec6::Zero()) {}

  // The pose of the joints' last factorisation, for all that follows until the next call. The view must stay valid.
  void set_pose(BodyColumns state) { pose_ = state; }

  // The bodies that impulses on a and b change the velocities of; either may be the world.
  std::vector<int> moved_by(int a, int b) const;
  // By body, of those `moved_by` a and b: the changes (v, w) by the impulses (N s, N m s) on the two. Valid until the
  // next call.
  const std::vector<Vec6>& of(const std::vector<int>& moved, int a, const Vec6& on_a, int b, const Vec6& on_b);
  // The change of a body's velocity that no joint holds; none of one that cannot move.
  Vec6 alone(int body, const Vec6& impulse) const;

 private:
  bool moves(int body) const { return body != kWorld && !system_.bodies[body].fixed; }

  const System& system_;
  Joints& joints_;
  BodyColumns pose_;
  std::vector<Vec6> change_;  // by body
};

}  // namespace rigor
