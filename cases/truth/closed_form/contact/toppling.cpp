// A box that rotates about one of its edges, which stays in place on a level plane. It is an inverted pendulum
// (Goldstein, Classical Mechanics, 3rd ed., 5.1; for blocks: Housner, The behavior of inverted pendulum structures
// during earthquakes, Bull. Seismol. Soc. Am. 53, 1963). phi is the angle from upright to the line of length r from the
// edge to the centre of mass, and k² = I/m about the edge,
//   phi'' = g r/k² sin phi,
// by its Taylor series of order 24 from one node to the next. With s = sin phi and c = cos phi, s' = c phi' and c' = -s
// phi'. The edge force is H = m r (phi'' cos phi - phi'² sin phi) and V = m g - m r (phi'' sin phi + phi'² cos phi). It
// must stay inside the friction cone. The truth ends where it leaves the cone, or another side lands.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cases/truth/closed_form/contact/plane_contact.h"

namespace rigor::inline truth {
namespace {

constexpr const char* kName = "toppling";
constexpr const char* kIsFor = "one box that turns over an edge on a level plane";
constexpr int kOrder = 24;
constexpr Extended kNode = 1.0L / 256;  // s; at some 5/s the last term is 1e-40 of the first

struct Edge {
  ExtendedVec3 at, axis;  // m, of the point nearest to the centre of mass; unit; in W
};

struct Angle {
  Extended phi, rate;  // rad, rad/s
};

// After the time h.
Angle advanced(const Angle& from, Extended stiffness, Extended h) {
  std::array<Extended, kOrder + 1> phi{}, rate{}, s{}, c{};
  phi[0] = from.phi, rate[0] = from.rate, s[0] = std::sin(from.phi), c[0] = std::cos(from.phi);
  for (int n = 0; n < kOrder; ++n) {
    Extended ds = 0, dc = 0;
    for (int j = 0; j <= n; ++j) ds += c[j] * rate[n - j], dc -= s[j] * rate[n - j];
    phi[n + 1] = rate[n] / (n + 1), rate[n + 1] = stiffness * s[n] / (n + 1);
    s[n + 1] = ds / (n + 1), c[n + 1] = dc / (n + 1);
  }
  Angle to{0, 0};
  for (int n = kOrder; n >= 0; --n) to.phi = to.phi * h + phi[n], to.rate = to.rate * h + rate[n];
  return to;
}

class Toppling final : public BodyMotion {
 public:
  Toppling(const Scene& scene, const Body& box, double duration)
      : ground_(scene, kName, kIsFor), box_(box), q_(extended(box.orientation)) {
    if (ground_.along().norm() > 0) ground_.refuse(box, "is on a slope");
    if (!box.collides || (!std::holds_alternative<Box>(*box.shape) && !is_cylinder()))
      ground_.refuse(box, "is no box and no cylinder that collides");
    if (is_cylinder()) find_rim();
    gap_ = static_cast<double>(std::abs(ground_.gap_under(box)));
    if (gap_ > kTouching) ground_.refuse(box, "does not touch the plane");
    find_edge();
    const ExtendedVec3 arm = extended(box.position) - edge_.at, n = ground_.normal(), side = edge_.axis.cross(n);
    radius_ = arm.norm();
    const ExtendedMat3 R = q_.toRotationMatrix();
    const ExtendedVec3 turning = R * extended(box.inertia) * R.transpose() * edge_.axis;
    if (is_cylinder() && turning.cross(edge_.axis).norm() > 1e-12L * turning.norm())
      ground_.refuse(box, "turns on one point, and not about a principal axis");
    const Extended about = edge_.axis.dot(turning) / box.mass;
    stiffness_ = ground_.pressing() * radius_ / (about + radius_ * radius_);
    nodes_ = {{std::atan2(arm.dot(side), arm.dot(n)), extended(box.angular_velocity).dot(edge_.axis)}};
    while (static_cast<Extended>(nodes_.size() - 1) * kNode < duration) {
      nodes_.push_back(advanced(nodes_.back(), stiffness_, kNode));
    }
    const double friction = scene.contact_law(static_cast<int>(&box - scene.bodies.data()), ground_.body()).friction;
    if (const char* why = reason_against(nodes_[0], friction)) ground_.refuse(box, why);
    std::size_t last = 0;
    while (last + 1 < nodes_.size() && !reason_against(nodes_[last + 1], friction) && !has_landed(nodes_[last + 1]))
      ++last;
    until_ = last + 1 == nodes_.size() ? duration : static_cast<double>(static_cast<Extended>(last) * kNode);
  }

  ExtendedState at(Extended t) const override {
    const auto i = std::min(static_cast<std::size_t>(std::max<Extended>(t, 0) / kNode), nodes_.size() - 1);
    const Angle now = advanced(nodes_[i], stiffness_, t - static_cast<Extended>(i) * kNode);
    const ExtendedVec3 n = ground_.normal(), side = edge_.axis.cross(n), w = now.rate * edge_.axis;
    const ExtendedVec3 arm = radius_ * (std::cos(now.phi) * n + std::sin(now.phi) * side);
    return {edge_.at + arm, turn((now.phi - nodes_[0].phi) * edge_.axis) * q_, w.cross(arm), w};
  }

  // The rounding of the position, and of the angle as an unstable pendulum magnifies it. Infinite after the box slips,
  // lands or leaves the plane.
  double error(double t) const override {
    if (t > until_ * (1 + 1e-12)) return std::numeric_limits<double>::infinity();
    const double growth = std::exp(static_cast<double>(std::sqrt(stiffness_)) * t);
    return kEpsilon * static_cast<double>(edge_.at.norm() + radius_) + gap_ +
           64 * kExtendedEpsilon * growth * static_cast<double>(radius_);
  }

 private:
  bool is_cylinder() const { return std::holds_alternative<Cylinder>(*box_.shape); }

  // A cylinder turns about one point of its rim, in the plane across its spin. There it is a rectangle.
  void find_rim() {
    const ExtendedVec3 axis = q_ * ExtendedVec3::UnitZ().eval(), w = extended(box_.angular_velocity);
    if (std::abs(axis.dot(w)) > 1e-12L * w.norm()) ground_.refuse(box_, "spins about its own axis");
    across_ = w.cross(axis).normalized();
  }

  ExtendedVec3 arm_of(int corner) const {
    const ExtendedVec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    if (const auto* cylinder = std::get_if<Cylinder>(&*box_.shape)) {
      const ExtendedVec3 axis = q_ * ExtendedVec3::UnitZ().eval();
      return sign.x() * cylinder->radius * across_ + sign.z() * cylinder->length / 2 * axis;
    }
    return q_ * (extended(std::get<Box>(*box_.shape).size) / 2).cwiseProduct(sign).eval();
  }

  // Through the two corners that touch and do not move.
  void find_edge() {
    std::vector<ExtendedVec3> still;
    const ExtendedVec3 v = extended(box_.velocity), w = extended(box_.angular_velocity), n = ground_.normal();
    const Extended lowest = lowest_arm();
    for (int corner = 0; corner < 8; ++corner) {
      const ExtendedVec3 arm = arm_of(corner), u = v + w.cross(arm);
      if (n.dot(arm) - lowest > kTouching) continue;
      if (u.norm() <= 1e-12L * (v.norm() + w.norm() * arm.norm()))
        still.push_back(arm);
      else if (!(n.dot(u) > 0))
        ground_.refuse(box_, "does not turn about an edge");
    }
    if (still.size() != 2) ground_.refuse(box_, "does not turn about one edge");
    edge_.axis = is_cylinder() ? w.normalized() : (still[1] - still[0]).normalized();
    if (!are_along(w, edge_.axis)) ground_.refuse(box_, "does not turn along its edge");
    const ExtendedVec3 p = extended(box_.position);
    edge_.at = p + still[0] - edge_.axis * edge_.axis.dot(still[0]);
  }

  Extended lowest_arm() const {
    Extended lowest = 0;
    for (int corner = 0; corner < 8; ++corner) lowest = std::min(lowest, ground_.normal().dot(arm_of(corner)));
    return lowest;
  }

  // Why it is no pendulum at an instant, or null.
  const char* reason_against(const Angle& now, double friction) const {
    const Extended acceleration = stiffness_ * std::sin(now.phi), square = now.rate * now.rate;
    const Extended along = radius_ * (acceleration * std::cos(now.phi) - square * std::sin(now.phi));
    const Extended up = ground_.pressing() - radius_ * (acceleration * std::sin(now.phi) + square * std::cos(now.phi));
    if (!(up > 0)) return "would leave the plane";
    return std::abs(along) > friction * up ? "would slip" : nullptr;
  }

  // Whether another corner than those of the edge has come down.
  bool has_landed(const Angle& now) const {
    const ExtendedQuat turned = turn((now.phi - nodes_[0].phi) * edge_.axis);
    const ExtendedVec3 to_edge = edge_.at - extended(box_.position);
    for (int corner = 0; corner < 8; ++corner) {
      const ExtendedVec3 arm = arm_of(corner) - to_edge;
      const bool is_on_edge = (arm - edge_.axis * edge_.axis.dot(arm)).norm() < 1e-9L * radius_;
      if (!is_on_edge && !(ground_.normal().dot(turned * arm) > 0)) return true;
    }
    return false;
  }

  Ground ground_;
  const Body& box_;
  ExtendedQuat q_;
  ExtendedVec3 across_ = ExtendedVec3::Zero();  // of a cylinder: unit, in W, from its axis to the rim
  Edge edge_;
  Extended radius_ = 0, stiffness_ = 0;  // m; 1/s²
  std::vector<Angle> nodes_;             // every kNode
  double until_ = 0;                     // s, as long as it is a pendulum
  double gap_ = 0;                       // m, of the case file's digits
};

}  // namespace

TruthRow toppling_truth() {
  return {kName, "a box or cylinder that turns over its edge without slipping, as an inverted pendulum",
          [](const Scene& scene, double duration) {
            check_needs(scene, kName, kIsFor,
                        {contact_feature<Box, Plane>(), contact_feature<Cylinder, Plane>(), Feature::restitution,
                         Feature::friction_none, Feature::friction_coulomb, Feature::friction_infinite});
            return closed_form(scene,
                               [&](const Body& body) { return std::make_unique<Toppling>(scene, body, duration); });
          }};
}

}  // namespace rigor::inline truth
