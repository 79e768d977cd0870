// A heavy symmetric top on a ball joint at its axis. Without spin, also a body on a distance joint to its centre of
// mass (the spherical pendulum). z is the cosine of the axis's angle from the vertical. I1 across and I3 along the axis
// are about the joint. The momenta L_z = I1 b and L_3 = I1 a are constant,
//   z'² = f(z) = (alpha - beta z)(1 - z²) - (b - a z)²,   beta = 2 m g l / I1,
//   z = z1 + (z2 - z1) sn²(p t + u0, k),   p² = beta (z3 - z1) / 4,   k² = (z2 - z1) / (z3 - z1),
// z1 <= z2 <= 1 <= z3 are the roots of f. The remaining integrals are those of
//   phi' = (b - a z) / (1 - z²),   psi' = L_3 / I3 - z phi'
// (Whittaker, Analytical Dynamics, 4th ed., sections 55 and 71; Goldstein, Classical Mechanics, 3rd ed., section 5.7).
// q = turn(phi, vertical) turn(theta - theta0, line of nodes) turn(psi, axis) q0. In place of z stands y = 1 - z, which
// keeps its digits near the vertical.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cases/truth/closed_form/joint/even_quadrature.h"
#include "cases/truth/closed_form/joint/swinging_body.h"
#include "cases/truth/closed_form/quadruple.h"
#include "cases/truth/closed_form/smooth/jacobi_elliptic.h"
#include "cases/truth/closed_form/smooth/principal_spin.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_heavy_top(const std::string& why) {
  throw InputError(
      "the truth 'heavy-top' is for a symmetric body on a ball joint at its axis, or a distance joint to its "
      "centre: " +
      why);
}

constexpr Extended kHeavyTopRoundings = 64 * static_cast<Extended>(kEpsilon);  // of the scene's numbers, relative

// About the point that stands still.
struct HeavyBody {
  ExtendedVec3 pivot;                                 // m, in W
  ExtendedVec3 arm;                                   // m, from there to the centre of mass
  Extended across = 0;                                // kg m², I1
  Extended along = 0;                                 // kg m², I3; 0 for a body on a distance joint
  ExtendedVec3 w;                                     // rad/s, of the axis and about it, in W
  bool is_top = true;                                 // it turns with the axis
  Extended misses = static_cast<Extended>(kEpsilon);  // rad/s, the error from the rounding of the scene's numbers
};

// The three real roots of z³ + c2 z² + c1 z + c0, ascending (Viète's trigonometric form).
std::array<Quad, 3> real_roots(const Quad& c2, const Quad& c1, const Quad& c0) {
  const Quad p = c1 - c2 * c2 / 3, q = 2 * c2 * c2 * c2 / 27 - c2 * c1 / 3 + c0, radius = 2 * sqrt(Quad(-p / 3));
  Quad cosine = radius == 0 ? Quad(0) : Quad(3 * q / (p * radius));
  cosine = cosine > 1 ? Quad(1) : cosine < -1 ? Quad(-1) : cosine;
  const Quad angle = acos(cosine) / 3, third = 2 * acos(Quad(-1)) / 3;
  std::array<Quad, 3> roots;
  for (int k = 0; k < 3; ++k) roots[k] = radius * cos(Quad(angle - k * third)) - c2 / 3;
  std::sort(roots.begin(), roots.end());
  return roots;
}

class HeavyTop final : public BodyMotion {
 public:
  HeavyTop(const Body& body, const HeavyBody& heavy, const ExtendedVec3& gravity)
      : heavy_(heavy),
        length_(heavy.arm.norm()),
        up_(-gravity.normalized()),
        e_(heavy.arm / length_),
        orientation_(extended(body.orientation)),
        own_w_(extended(body.angular_velocity)),
        own_spin_(body, body.angular_velocity) {
    nodes_ = up_.cross(e_);
    const Extended sine = nodes_.norm();
    if (sine < 1e-9L) refuse_heavy_top("it begins upright, or hangs (take 'steady-precession')");
    nodes_ /= sine;
    spin_ = heavy.along > 0 ? heavy.w.dot(e_) : 0;
    const Quad weight = Quad(body.mass) * sqrt(Quad(gravity.cast<Quad>().squaredNorm()));
    solve(weight * sqrt(Quad(heavy.arm.cast<Quad>().squaredNorm())) / Quad(heavy.across), gravity);
    begin();
  }

  ExtendedState at(Extended t) const override {
    const Extended u = start_ + p_ * t;
    const Nod nod = nod_at(u);
    const Extended sine = std::sqrt(nod.y * (2 - nod.y)), rate = nod.y_rate / sine;  // of theta
    const Extended phi = (phi_.at(u) - phi_.at(start_)) / p_,
                   psi = spin_ * t - phi + (psi_.at(u) - psi_.at(start_)) / p_;
    const Extended tilt = half_angle(nod.y) - half_angle(y0_);
    const ExtendedQuat swing = turn(phi * up_) * turn(2 * tilt * nodes_);
    const ExtendedVec3 e = swing * e_, nodes = turn(phi * up_) * nodes_;
    const Extended phi_rate = azimuth_rate(nod.y);
    const ExtendedVec3 of_axis = phi_rate * up_ + rate * nodes, position = heavy_.pivot + length_ * e,
                       velocity = of_axis.cross(length_ * e);
    if (!heavy_.is_top) return {position, own_spin_.orientation(own_w_.norm() * t), velocity, own_w_};
    const ExtendedVec3 w = of_axis + (spin_ - phi_rate * (1 - nod.y)) * e;
    return {position, swing * turn(psi * e_) * orientation_, velocity, w};
  }

  // Rounding of the phases, of k', which changes the length of every nod, and of small quantities near the vertical.
  double error(double t) const override {
    const Extended fastest = std::max(std::abs(azimuth_rate(y_low_)), std::abs(azimuth_rate(y_high_)));
    const Extended phases = (p_ + fastest + std::abs(spin_)) * t + 1;
    const Extended steep = fastest / p_ + 1;  // rad of azimuth for one of the nodding's phase
    const Extended off =
        16 * std::numeric_limits<Extended>::epsilon() * phases * steep + unsure_ * steep * (1 + p_ * t);
    return static_cast<double>((1 + length_) * (off + heavy_.misses * (1 + t))) +
           kEpsilon * static_cast<double>(heavy_.pivot.norm() + length_) +
           (heavy_.is_top ? 0 : own_spin_.error(static_cast<double>(own_w_.norm()) * t));
  }

 private:
  struct Nod {
    Extended y, y_rate;  // 1, 1/s
  };

  Nod nod_at(Extended u) const {
    const Extended reduced = complement_ == 0 ? u : std::remainder(u, 4 * quarter_period(complement_));
    const JacobiElliptic at = jacobi_elliptic(reduced, complement_);
    return {y_high_ * at.cn * at.cn + y_low_ * at.sn * at.sn, -2 * (y_high_ - y_low_) * at.sn * at.cn * at.dn * p_};
  }

  // phi' = (b - a z) / (1 - z²)
  Extended azimuth_rate(Extended y) const { return (b_less_a_ + a_ * y) / (y * (2 - y)); }
  // theta / 2 with cos theta = 1 - y
  static Extended half_angle(Extended y) { return std::atan2(std::sqrt(y), std::sqrt(2 - y)); }

  // `strength` [1/s²]: m g l / I1. In quadruple precision: at steady motion two roots are one.
  void solve(const Quad& strength, const ExtendedVec3& gravity) {
    const QuadVec3 arm = heavy_.arm.cast<Quad>(), w = heavy_.w.cast<Quad>(), g = gravity.cast<Quad>();
    const QuadVec3 e = arm / sqrt(arm.squaredNorm()), up = -g / sqrt(g.squaredNorm()), rate = w.cross(e);
    const Quad z0 = e.dot(up), y0 = 1 - z0, beta = 2 * strength;
    // L_z = I1 w_z across the axis, and what of L_3 lies along the vertical.
    const Quad a = Quad(heavy_.along) * w.dot(e) / Quad(heavy_.across), b = rate.dot(up.cross(e)) + a * z0,
               alpha = rate.squaredNorm() + beta * z0;
    const auto roots = real_roots(-(alpha + a * a) / beta, (2 * a * b - beta) / beta, (alpha - b * b) / beta);
    const Quad y1 = 1 - roots[0], y2 = 1 - roots[1], wide = roots[2] - roots[0];
    a_ = rounded(a), b_less_a_ = rounded(b - a), y_high_ = rounded(y1), y_low_ = rounded(y2), y0_ = rounded(y0);
    p_ = std::sqrt(rounded(beta * wide / 4));
    const Quad apart = (roots[2] - roots[1]) / wide;  // k'²
    complement_ = std::min<Extended>(1, std::sqrt(std::max<Extended>(0, rounded(apart))));
    constexpr Extended kQuadRoundings = 1e-32L;
    unsure_ = kQuadRoundings / std::max<Extended>(kQuadRoundings, rounded(apart * apart));
    // sn² : cn² is z0 - z1 : z2 - z0, and z rises where sn cn is positive.
    const Extended above = std::max<Extended>(0, rounded(y1 - y0)), below = std::max<Extended>(0, rounded(y0 - y2));
    const Extended rising = rate.dot(up) < 0 ? -1 : 1;
    start_ = jacobi_argument(rising * std::sqrt(above), std::sqrt(below), complement_);
  }

  void begin() {
    if (complement_ == 0 || y_low_ <= 0 || y_high_ >= 2) refuse_heavy_top("it passes through the vertical");
    const Extended K = quarter_period(complement_);
    phi_ = EvenQuadrature([this](Extended u) { return azimuth_rate(nod_at(u).y); }, K);
    psi_ = EvenQuadrature(
        [this](Extended u) {
          const Extended y = nod_at(u).y;
          return (b_less_a_ + a_ * y) / (2 - y);
        },
        K);
    if (!phi_.converges() || !psi_.converges()) refuse_heavy_top("it passes too near the vertical (take 'reference')");
  }

  HeavyBody heavy_;
  Extended length_;              // m
  ExtendedVec3 up_, e_, nodes_;  // unit, in W, at t = 0: away from gravity, from the pivot to the centre, up x e
  ExtendedQuat orientation_;
  ExtendedVec3 own_w_;
  PrincipalSpin own_spin_;
  Extended a_ = 0, b_less_a_ = 0;                // rad/s
  Extended spin_ = 0;                            // rad/s, L_3 / I3
  Extended y_high_ = 0, y_low_ = 0, y0_ = 0;     // 1 - z1, 1 - z2, and at t = 0
  Extended p_ = 0, complement_ = 1, start_ = 0;  // 1/s; k'; u0
  Extended unsure_ = 0;                          // rounding of k', relative
  EvenQuadrature phi_, psi_;                     // times p
};

HeavyBody top_on(const Scene& scene, int index, const Vec3& anchor) {
  const Body& body = scene.bodies[index];
  HeavyBody heavy{extended(anchor), extended(body.position) - extended(anchor), 0, 0, extended(body.angular_velocity)};
  const Extended length = heavy.arm.norm();
  if (length == 0) refuse_heavy_top("the joint is at the centre of mass (take 'axisymmetric-top')");
  const ExtendedVec3 e_B = extended(body.orientation).conjugate() * ExtendedVec3(heavy.arm / length);
  const ExtendedMat3 inertia = extended(body.inertia), line = e_B * e_B.transpose();
  heavy.along = e_B.dot(inertia * e_B);
  const Extended across = (inertia.trace() - heavy.along) / 2;
  if ((inertia - across * (ExtendedMat3::Identity() - line) - heavy.along * line).norm() >
      kHeavyTopRoundings * inertia.norm())
    refuse_heavy_top(fmt::format("the inertia of body '{}' is not symmetric about the line to the joint", body.name));
  heavy.misses += (inertia - across * (ExtendedMat3::Identity() - line) - heavy.along * line).norm() / inertia.norm() *
                  heavy.w.norm();
  heavy.across = across + body.mass * length * length;
  const ExtendedVec3 v = heavy.w.cross(heavy.arm);
  if ((extended(body.velocity) - v).norm() > kHeavyTopRoundings * (1 + heavy.w.norm()) * (1 + length))
    refuse_heavy_top(fmt::format("the velocity of body '{}' is not what its spin about the joint gives", body.name));
  return heavy;
}

HeavyBody bob_on(const Scene& scene, int index, const Joint& joint) {
  const auto& distance = std::get<DistanceJoint>(joint.type);
  const bool is_a = joint.a == index;
  if (!(is_a ? distance.point_a : distance.point_b).isZero(0))
    refuse_heavy_top("the distance joint is not at its centre of mass");
  const Body& body = scene.bodies[index];
  HeavyBody heavy;
  heavy.pivot =
      is_a ? standing_point(scene, joint.b, distance.point_b) : standing_point(scene, joint.a, distance.point_a);
  heavy.arm = extended(body.position) - heavy.pivot;
  heavy.is_top = false;
  const Extended square = heavy.arm.squaredNorm();
  heavy.across = body.mass * square;
  heavy.w = heavy.arm.cross(extended(body.velocity)) / square;
  if (!PrincipalSpin(body, body.angular_velocity).holds())
    refuse_heavy_top(fmt::format("body '{}' would tumble", body.name));
  return heavy;
}

std::unique_ptr<Truth> make_heavy_top(const Scene& scene, double) {
  check_needs(scene, "heavy-top", "one body on one joint",
              {joint_feature<BallJoint>(), joint_feature<DistanceJoint>()});
  if (scene.joints.size() != 1) refuse_heavy_top(fmt::format("there are {} joints", scene.joints.size()));
  const Joint& joint = scene.joints[0];
  if (stands(scene, joint.a) == stands(scene, joint.b))
    refuse_heavy_top("the joint is not between it and what stands still");
  const auto moving = std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return !b.fixed; });
  if (moving != 1) refuse_heavy_top(fmt::format("{} bodies move", moving));
  if (scene.gravity.isZero(0)) refuse_heavy_top("there is no gravity (take 'axisymmetric-top')");
  const int index = stands(scene, joint.a) ? joint.b : joint.a;
  const auto* ball = std::get_if<BallJoint>(&joint.type);
  const HeavyBody heavy = ball ? top_on(scene, index, ball->anchor) : bob_on(scene, index, joint);
  return closed_form(
      scene, [&](const Body& body) { return std::make_unique<HeavyTop>(body, heavy, extended(scene.gravity)); });
}

}  // namespace

TruthRow heavy_top_truth() {
  return {"heavy-top", "a heavy symmetric top on a ball joint, or a spherical pendulum, in elliptic functions",
          make_heavy_top};
}

}  // namespace rigor::inline truth
