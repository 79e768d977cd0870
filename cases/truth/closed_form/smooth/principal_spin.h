// Rotation about an axis that is fixed in W and in B, because it is a principal axis of the inertia (Goldstein,
// Classical Mechanics, 3rd ed., section 5.6). If rounding of the scene's numbers misses the axis, the body wobbles by
// the same amount. About the axis of the middle moment it tumbles after a while; error() includes this.
#pragma once

#include "cases/truth/closed_form/closed_form.h"

namespace rigor::inline truth {

class PrincipalSpin {
 public:
  // Turns about `axis` (in W, of any length; zero if it does not turn at all).
  PrincipalSpin(const Body& body, const Vec3& axis);

  bool holds() const { return misses_axis_ <= kRoundings * static_cast<Extended>(kEpsilon); }
  const ExtendedVec3& axis() const { return axis_; }  // unit, in W, or zero
  Extended moment() const { return moment_; }         // kg m², about the axis

  ExtendedQuat orientation(Extended angle) const { return turn(angle * axis_) * start_; }
  // rad, after `angle` rad were turned one way or the other
  double error(double angle) const;

 private:
  static constexpr Extended kRoundings = 16;  // of the orientation, the axis and the inertia, a few each

  ExtendedQuat start_;
  ExtendedVec3 axis_ = ExtendedVec3::Zero();
  Extended moment_ = 0;
  Extended misses_axis_ = 0;  // |n x I n| / |I|
  Extended wobble_ = 0;       // |I^-1 (n x I n)|: change of the spin, as a share of it, for each radian turned
  Extended growth_ = 0;       // of the wobble, in powers of e for each radian turned
};

}  // namespace rigor::inline truth
