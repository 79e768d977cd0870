// Jacobi's elliptic functions of a modulus given by its complement k' = sqrt(1 - k²). The usual libraries take k. Near
// a separatrix k is so close to 1 that it has lost the digits of k', which decide everything there. All three functions
// have a small relative error, because they are computed without subtraction.
#pragma once

#include <vector>

namespace rigor::inline truth {

struct JacobiElliptic {
  long double sn, cn, dn;
};

// 0 <= complement <= 1; at 0 they are tanh and 1 / cosh, twice.
JacobiElliptic jacobi_elliptic(long double u, long double complement);

// K(k), for a complement above 0: sn and cn have the period 4 K, dn 2 K.
long double quarter_period(long double complement);

// The u in [-K, K] at which sn : cn is s : c, where c >= 0; infinite where the complement and c are 0.
long double jacobi_argument(long double s, long double c, long double complement);

// The integral of 1 / (1 + a dn u), 0 <= a <= 1, as mean u + waves(u), to rounding.
class DnQuadrature {
 public:
  DnQuadrature(long double a, long double complement);

  long double mean() const { return mean_; }
  long double waves(long double u) const;  // 0 at u = 0

 private:
  void find_waves(int modes, long double complement);

  long double a_;
  long double quarter_period_ = 0;  // 0 for an infinite one
  long double mean_ = 1;
  std::vector<long double> waves_;  // coefficients of sin(n pi u / K), n = 1, 2, ..
};

}  // namespace rigor::inline truth
