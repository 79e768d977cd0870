// Ball arithmetic: a number is a midpoint and a radius that holds the true value (Johansson, "Arb: efficient
// arbitrary-precision midpoint-radius interval arithmetic", IEEE Transactions on Computers 66, 2017). What follows from
// it is proven, up to faults of the library.
#pragma once

#include <acb.h>
#include <acb_elliptic.h>
#include <acb_modular.h>
#include <arb.h>

#include <array>
#include <utility>

namespace rigor::test {

class Ball {
 public:
  static constexpr slong kBits = 300;  // of the midpoint

  Ball(double exact = 0) { arb_init(value_), arb_set_d(value_, exact); }
  Ball(const Ball& other) { arb_init(value_), arb_set(value_, other.value_); }
  Ball& operator=(const Ball& other) { return arb_set(value_, other.value_), *this; }
  ~Ball() { arb_clear(value_); }

  arb_srcptr get() const { return value_; }
  arb_ptr get() { return value_; }

  // No value in the ball has a larger size.
  double most() const {
    arf_t bound;
    arf_init(bound);
    arb_get_ubound_arf(bound, abs(*this).value_, kBits);
    const double up = arf_get_d(bound, ARF_RND_CEIL);
    arf_clear(bound);
    return up;
  }
  double middle() const { return arf_get_d(arb_midref(value_), ARF_RND_NEAR); }
  // Whether all values are below all of the other; false also where they cannot be told apart.
  bool operator<(const Ball& other) const { return arb_lt(value_, other.value_); }

  template <typename Function, typename... Arguments>
  static Ball of(const Function& function, const Arguments&... arguments) {
    Ball result;
    function(result.value_, arguments..., kBits);
    return result;
  }
  friend Ball operator+(const Ball& a, const Ball& b) { return of(arb_add, a.value_, b.value_); }
  friend Ball operator-(const Ball& a, const Ball& b) { return of(arb_sub, a.value_, b.value_); }
  friend Ball operator*(const Ball& a, const Ball& b) { return of(arb_mul, a.value_, b.value_); }
  friend Ball operator/(const Ball& a, const Ball& b) { return of(arb_div, a.value_, b.value_); }
  Ball operator-() const { return Ball(0.0) - *this; }
  friend Ball abs(const Ball& x) {
    Ball result;
    arb_abs(result.value_, x.value_);
    return result;
  }
  friend Ball sqrt(const Ball& x) { return of(arb_sqrt, x.value_); }
  friend Ball sin(const Ball& x) { return of(arb_sin, x.value_); }
  friend Ball cos(const Ball& x) { return of(arb_cos, x.value_); }
  friend Ball exp(const Ball& x) { return of(arb_exp, x.value_); }
  friend Ball sinh(const Ball& x) { return of(arb_sinh, x.value_); }
  friend Ball cosh(const Ball& x) { return of(arb_cosh, x.value_); }
  friend Ball asin(const Ball& x) { return of(arb_asin, x.value_); }

 private:
  arb_t value_;
};

using BallVector = std::array<Ball, 3>;

inline BallVector operator+(const BallVector& a, const BallVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline BallVector operator*(const Ball& factor, const BallVector& v) {
  return {factor * v[0], factor * v[1], factor * v[2]};
}
inline Ball dot(const BallVector& a, const BallVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Ball norm(const BallVector& v) { return sqrt(dot(v, v)); }

// A quaternion, of any length but 0: w and the vector.
struct BallTurn {
  Ball w;
  BallVector v;

  friend BallTurn operator*(const BallTurn& a, const BallTurn& b) {
    return {a.w * b.w - dot(a.v, b.v),
            {a.w * b.v[0] + b.w * a.v[0] + a.v[1] * b.v[2] - a.v[2] * b.v[1],
             a.w * b.v[1] + b.w * a.v[1] + a.v[2] * b.v[0] - a.v[0] * b.v[2],
             a.w * b.v[2] + b.w * a.v[2] + a.v[0] * b.v[1] - a.v[1] * b.v[0]}};
  }
  BallTurn conjugate() const { return {w, Ball(-1.0) * v}; }
};
// By the length of a vector about its direction; the length is not 0.
inline BallTurn turn_by(const BallVector& angle) {
  const Ball length = norm(angle), half = length / Ball(2.0);
  return {cos(half), sin(half) / length * angle};
}

// Jacobi's sn, cn and dn of u with the modulus m = k², by theta functions (DLMF 22.2).
struct BallElliptic {
  Ball sn, cn, dn;
};
inline BallElliptic jacobi(const Ball& u, const Ball& m) {
  acb_t k, other, tau, z, scale, theta[4], null[4];
  for (acb_ptr x : {k, other, tau, z, scale}) acb_init(x);
  for (int i = 0; i < 4; ++i) acb_init(theta[i]), acb_init(null[i]);
  acb_set_arb(k, m.get()), acb_elliptic_k(scale, k, Ball::kBits);  // K
  acb_sub_ui(other, k, 1, Ball::kBits), acb_neg(other, other);
  acb_elliptic_k(tau, other, Ball::kBits), acb_div(tau, tau, scale, Ball::kBits), acb_mul_onei(tau, tau);  // i K'/K
  acb_zero(z), acb_modular_theta(null[0], null[1], null[2], null[3], z, tau, Ball::kBits);
  acb_mul_2exp_si(scale, scale, 1);
  acb_set_arb(z, u.get()), acb_div(z, z, scale, Ball::kBits);  // u / 2K, in which theta_1 has the period 2
  acb_modular_theta(theta[0], theta[1], theta[2], theta[3], z, tau, Ball::kBits);
  const auto real = [](const acb_t x) {
    Ball ball;
    arb_set(ball.get(), acb_realref(x));
    return ball;
  };
  const Ball t1 = real(theta[0]), t2 = real(theta[1]), t3 = real(theta[2]), t4 = real(theta[3]), n2 = real(null[1]),
             n3 = real(null[2]), n4 = real(null[3]);
  for (acb_ptr x : {k, other, tau, z, scale}) acb_clear(x);
  for (int i = 0; i < 4; ++i) acb_clear(theta[i]), acb_clear(null[i]);
  return {n3 / n2 * t1 / t4, n4 / n2 * t2 / t4, n4 / n3 * t3 / t4};
}

// Legendre's F(angle, m), the inverse of the amplitude.
inline Ball elliptic_integral(const Ball& angle, const Ball& m) {
  acb_t phi, modulus, integral;
  for (acb_ptr x : {phi, modulus, integral}) acb_init(x);
  acb_set_arb(phi, angle.get()), acb_set_arb(modulus, m.get());
  acb_elliptic_f(integral, phi, modulus, 0, Ball::kBits);
  Ball ball;
  arb_set(ball.get(), acb_realref(integral));
  for (acb_ptr x : {phi, modulus, integral}) acb_clear(x);
  return ball;
}

}  // namespace rigor::test
