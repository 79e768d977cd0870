// The pendulum's equation x'' = -w0² sin x, in Jacobi's elliptic functions of half the angle (Whittaker, Analytical
// Dynamics, 4th ed., section 44; Lawden, Elliptic Functions and Applications, section 5.1). With
// k² = sin²(x0/2) + (x0' / 2 w0)²,
//   it swings, k < 1:      sin(x/2) = k sn(u, k),    cos(x/2) = dn(u, k),    x' = 2 k w0 cn(u, k),    u' = w0
//   it goes round, k > 1:  sin(x/2) = sn(u, 1/k),    cos(x/2) = cn(u, 1/k),  x' = 2 k w0 dn(u, 1/k),  u' = k w0
#pragma once

#include "cases/truth/closed_form/closed_form.h"

namespace rigor::inline truth {

class PendulumPhase {
 public:
  // Starts from the angle at t = 0 [rad, -pi..pi] from the rest position, and its rate [rad/s]. `square` is w0² [1/s²];
  // with 0 the rotation is uniform.
  PendulumPhase(Extended angle, Extended rate, Extended square);

  // Half of the angle turned since t = 0; both may have the other sign, which is the same rotation.
  struct HalfTurn {
    Extended sine, cosine;
    Extended rate;  // rad/s, of the whole angle
  };
  HalfTurn at(Extended t) const;

  // rad, of the angle at t
  double error(double t) const;

 private:
  HalfTurn half_angle_at(Extended t) const;

  Extended w0_, rate_;              // rad/s
  Extended start_ = 0;              // u at t = 0
  Extended speed_ = 0;              // 1/s, u'
  Extended complement_ = 1;         // of the modulus
  Extended k_ = 0;                  // as above
  Extended sense_ = 1;              // the sign of the rate at t = 0
  Extended sine_ = 0, cosine_ = 1;  // of half the angle at t = 0
  Extended unsure_ = 0;             // rounding of the complement, relative
};

}  // namespace rigor::inline truth
