// A free body with three different principal moments. The principal axes are numbered so that L circles about the
// third, which has the largest or the smallest moment; the second has the middle one,
//   L = (A1 cn u, A2 sn u, A3 dn u),  u = u0 + p t
// (Landau and Lifshitz, Mechanics, 3rd ed., section 37; van Zon and Schofield, J. Comput. Phys. 225, 2007). On the
// separatrix, |L|² = 2 E I2, k is 1 and the functions are hyperbolic.
//
// The attitude has two parts: the smallest rotation U that takes L in B to the z axis, then a rotation by chi about
// that axis, and the rotation from there to L in W. Since w · L = 2 E and U rotates about z at (l1 l2' - l2 l1') / (1 +
// l3), where l = L / |L|,
//   chi' = |L| / I3 + (2 E - |L|² / I3) / (|L| + L3),
// which is smooth, for L3 >= 0: the one integral that is left.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "cases/truth/closed_form/quadruple.h"
#include "cases/truth/closed_form/smooth/asymmetric_top.h"
#include "cases/truth/closed_form/smooth/jacobi_elliptic.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

// Near the separatrix |L|² - 2 E I2 is a small difference of two large sums, which would lose a long double's digits.
using QuadMat3 = Eigen::Matrix<Quad, 3, 3>;

constexpr Extended kQuadRoundings = 1e-32L;  // fifty roundings, relative

Extended root(const Quad& square) { return std::sqrt(std::max<Extended>(0, rounded(square))); }

// The principal axes, numbered as above.
struct PrincipalFrame {
  QuadMat3 axes;     // columns, in B; a right-handed set in which w1 and w3 are not negative
  QuadVec3 moments;  // kg m²
  QuadVec3 w;        // rad/s, about these axes, at t = 0

  // |L|² - 2 E I_i, exact wherever it is a sum of terms of one sign.
  Quad excess(int i) const {
    Quad sum = 0;
    for (int k = 0; k < 3; ++k) sum += moments[k] * w[k] * w[k] * (moments[k] - moments[i]);
    return sum;
  }
};

[[noreturn]] void refuse_top(const Body& body, const std::string& why) {
  throw InputError(fmt::format(
      "the truth 'asymmetric-top' needs a spin and three different principal moments; body '{}' {}", body.name, why));
}

PrincipalFrame principal_frame(const Body& body) {
  const Eigen::SelfAdjointEigenSolver<QuadMat3> solver(body.inertia.cast<Quad>().eval());
  const QuadVec3 ascending = solver.eigenvalues();
  if (ascending[1] - ascending[0] <= kEqualMoments * ascending[2] ||
      ascending[2] - ascending[1] <= kEqualMoments * ascending[2]) {
    refuse_top(body, "has two that are equal (take 'axisymmetric-top')");
  }
  if (body.angular_velocity.isZero(0)) refuse_top(body, "does not turn (take 'projectile')");

  const Eigen::Quaternion<Quad> q = body.orientation.cast<Quad>().normalized();
  const QuadVec3 w = q.conjugate() * body.angular_velocity.cast<Quad>().eval();
  PrincipalFrame frame{solver.eigenvectors(), ascending, solver.eigenvectors().transpose() * w};
  const bool circles_largest = frame.excess(1) >= 0;
  if (!circles_largest) frame.axes.col(0).swap(frame.axes.col(2)), std::swap(frame.moments[0], frame.moments[2]);
  if (frame.axes.col(2).dot(w) < 0) frame.axes.col(2) *= -1;
  if (frame.axes.col(0).dot(w) < 0) frame.axes.col(0) *= -1;
  frame.axes.col(1) = frame.axes.col(2).cross(frame.axes.col(0)).eval();
  frame.w = frame.axes.transpose() * w;
  return frame;
}

class AsymmetricTop final : public BodyMotion {
 public:
  AsymmetricTop(const Body& body, const Vec3& gravity) : AsymmetricTop(body, gravity, principal_frame(body)) {}

  ExtendedState at(Extended t) const override {
    const Extended u = start_ + rate_ * t;
    const ExtendedVec3 l = direction(u);
    const ExtendedQuat chi = turn({0, 0, turned_at(u, t)});
    const ExtendedQuat q = (from_L_ * chi * least_turn(l) * to_principal_).normalized();
    const ExtendedVec3 w = to_principal_.conjugate() * ExtendedVec3(L_ * l.cwiseQuotient(moments_));
    return {path_.position(t), q, path_.velocity(t), q * w};
  }

  // Rounding of the phases, and of k', by which every quarter period is longer or shorter.
  double error(double t) const override {
    const Extended phases = (std::abs(rate_) + L_ / moments_[2] + std::abs(swing_)) * t;
    const Extended longer = unsure_period_ * (1 + std::abs(rate_) * t) * (1 + std::abs(swing_ / rate_));
    return path_.error(t) + static_cast<double>(8 * std::numeric_limits<Extended>::epsilon() * phases + longer);
  }

 private:
  AsymmetricTop(const Body& body, const Vec3& gravity, const PrincipalFrame& frame)
      : path_(body, gravity),
        moments_(rounded(frame.moments[0]), rounded(frame.moments[1]), rounded(frame.moments[2])),
        complement_(find_complement(frame)),
        L_(root(frame.w.cwiseProduct(frame.moments).squaredNorm())) {
    const Quad &I1 = frame.moments[0], &I2 = frame.moments[1], &I3 = frame.moments[2], wide = I3 - I1, near = I3 - I2;
    const Extended A1 = root(-I1 * frame.excess(2) / wide), A2 = root(-I2 * frame.excess(2) / near),
                   A3 = root(I3 * frame.excess(0) / wide);
    amplitudes_ = ExtendedVec3(A1, A2, A3) / L_;
    quadrature_ = DnQuadrature(amplitudes_[2], complement_);
    rate_ = (wide > 0 ? A3 : -A3) * root(wide * near / (I1 * I2)) / moments_[2];
    swing_ = -rounded(frame.excess(2) / I3) / L_;
    // sn : cn is L2 / A2 : L1 / A1.
    start_ = jacobi_argument(rounded(I2 * frame.w[1]) * root(I1 * near / (I2 * wide)), rounded(I1 * frame.w[0]),
                             complement_);
    to_principal_ = ExtendedMat3(frame.axes.transpose().unaryExpr(&rounded));
    from_L_ = extended(body.orientation) * (least_turn(direction(start_)) * to_principal_).conjugate();
  }

  // k' of the motion, with its uncertainty.
  Extended find_complement(const PrincipalFrame& frame) {
    const Quad &I1 = frame.moments[0], &I2 = frame.moments[1], &I3 = frame.moments[2];
    const Quad from_separatrix = frame.excess(1);
    if (from_separatrix == 0) return 0;
    const Quad scale = 2 * I2 * (frame.w.cwiseProduct(frame.moments).dot(frame.w));
    unsure_period_ = kQuadRoundings * std::abs(rounded(scale / from_separatrix));
    return std::min<Extended>(1, root(from_separatrix * (I3 - I1) / (frame.excess(0) * (I3 - I2))));
  }

  // L / |L| about the principal axes.
  ExtendedVec3 direction(Extended u) const {
    const Extended reduced = complement_ == 0 ? u : std::remainder(u, 4 * quarter_period(complement_));
    const JacobiElliptic at = jacobi_elliptic(reduced, complement_);
    return {amplitudes_[0] * at.cn, amplitudes_[1] * at.sn, amplitudes_[2] * at.dn};
  }

  // chi at t, when the phase is u.
  Extended turned_at(Extended u, Extended t) const {
    const Extended waves = quadrature_.waves(u) - quadrature_.waves(start_);
    return (L_ / moments_[2] + swing_ * quadrature_.mean()) * t + swing_ / rate_ * waves;
  }

  // Takes the unit vector l, l3 >= 0, to the z axis.
  static ExtendedQuat least_turn(const ExtendedVec3& l) { return ExtendedQuat(1 + l[2], l[1], -l[0], 0).normalized(); }

  Parabola path_;
  ExtendedVec3 moments_;                // kg m², as numbered above
  Extended unsure_period_ = 0;          // rounding of k'², relative
  Extended complement_;                 // k'
  Extended L_;                          // kg m²/s, |L|
  ExtendedVec3 amplitudes_;             // A / |L|
  DnQuadrature quadrature_{0, 0};       // with a = A3 / |L|
  Extended start_ = 0, rate_ = 0;       // u0; p [1/s]
  Extended swing_ = 0;                  // rad/s, (2 E - |L|² / I3) / |L|
  ExtendedQuat to_principal_, from_L_;  // from B to the principal axes; from those with L along z to W
};

}  // namespace

std::unique_ptr<BodyMotion> asymmetric_top(const Body& body, const Vec3& gravity) {
  return std::make_unique<AsymmetricTop>(body, gravity);
}

TruthRow asymmetric_top_truth() {
  return {"asymmetric-top", "free bodies with three principal moments, in Jacobi's elliptic functions",
          [](const Scene& scene, double) {
            check_needs(scene, "asymmetric-top", "bodies in free flight");
            return closed_form(scene, [&](const Body& b) { return asymmetric_top(b, scene.gravity); });
          }};
}

}  // namespace rigor::inline truth
