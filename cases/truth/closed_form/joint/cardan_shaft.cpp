// Two shafts at an angle beta, joined by a cross whose arms are at right angles to the shafts and to each other. All
// axes pass through one point, and no load acts. psi is the first shaft's angle, zero where its arm is at right angles
// to both shafts,
//   tan chi = cos beta tan psi,   w2 / w1 = cos beta / D²,   D² = 1 - sin² beta sin² psi
// for the second's angle chi (Hunt, Kinematic Geometry of Mechanisms, 1978; Cardan's joint in any textbook). The cross
// rotates relative to the first shaft about its arm by the angle eta with tan eta = -cos beta / (sin beta cos psi). The
// energy M(psi) w1² / 2 is constant. So t is the integral of sqrt(M) over psi, the integral of an even function of
// period pi.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cases/truth/closed_form/closed_form.h"
#include "cases/truth/closed_form/joint/even_quadrature.h"
#include "cases/truth/closed_form/joint/swinging_body.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_cardan(const std::string& why) {
  throw InputError("the truth 'cardan-shaft' is for two shafts joined by a cross: " + why);
}

constexpr Extended kCardanRoundings = 64 * static_cast<Extended>(kEpsilon);  // of the scene's numbers, relative

struct CardanLine {
  ExtendedVec3 point, axis;  // m; unit
};

// The role of each body, and the geometry at t = 0.
struct CardanShaft {
  int first = kWorld, cross = kWorld, second = kWorld;
  CardanLine shaft, other_shaft, arm, other_arm;
  ExtendedVec3 centre;  // m, where all axes meet
};

CardanLine line_of(const Joint& joint) {
  const auto* hinge = std::get_if<HingeJoint>(&joint.type);
  return {extended(hinge->anchor), extended(hinge->axis).normalized()};
}

CardanShaft shaft_of(const Scene& scene) {
  CardanShaft found;
  const auto is_still = [&](int body) { return stands(scene, body); };
  for (const Joint& joint : scene.joints) {
    if (is_still(joint.a) == is_still(joint.b)) continue;
    const int body = is_still(joint.a) ? joint.b : joint.a;
    if (found.first == kWorld) {
      found.first = body, found.shaft = line_of(joint);
    } else if (found.second == kWorld) {
      found.second = body, found.other_shaft = line_of(joint);
    }
  }
  if (found.second == kWorld || found.first == found.second) refuse_cardan("no two bodies turn in what stands still");
  const auto moving = std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return !b.fixed; });
  if (moving != 3 || scene.joints.size() != 4)
    refuse_cardan(fmt::format("{} bodies move, on {} joints", moving, scene.joints.size()));
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (!scene.bodies[i].fixed && i != found.first && i != found.second) found.cross = i;
  }
  int arms = 0;
  for (const Joint& joint : scene.joints) {
    if (joint.a != found.cross && joint.b != found.cross) continue;
    const int shaft = joint.a == found.cross ? joint.b : joint.a;
    (shaft == found.first ? found.arm : found.other_arm) = line_of(joint);
    arms += shaft == found.first ? 1 : shaft == found.second ? 2 : 4;
  }
  if (arms != 3) refuse_cardan("the third body is not hinged to both shafts");
  return found;
}

void check_geometry(CardanShaft& shaft) {
  const ExtendedVec3 &a = shaft.shaft.axis, &u = shaft.arm.axis;
  const auto are_at_right_angles = [](const ExtendedVec3& x, const ExtendedVec3& y) {
    return std::abs(x.dot(y)) <= kCardanRoundings;
  };
  if (!are_at_right_angles(a, u) || !are_at_right_angles(shaft.other_shaft.axis, shaft.other_arm.axis) ||
      !are_at_right_angles(u, shaft.other_arm.axis))
    refuse_cardan("an arm of the cross is not at right angles to its shaft, or to the other arm");
  if (a.dot(shaft.other_shaft.axis) < 0) shaft.other_shaft.axis = -shaft.other_shaft.axis;
  constexpr Extended kNearly = 1e-6L;
  if (a.cross(shaft.other_shaft.axis).norm() < kNearly || a.dot(shaft.other_shaft.axis) < kNearly)
    refuse_cardan("the shafts are in one line, or at right angles");
  shaft.centre = shaft.shaft.point + a.dot(shaft.arm.point - shaft.shaft.point) * a;
  for (const CardanLine* line : {&shaft.shaft, &shaft.other_shaft, &shaft.arm, &shaft.other_arm}) {
    const ExtendedVec3 to = shaft.centre - line->point;
    if (to.cross(line->axis).norm() > kCardanRoundings * (1 + to.norm()))
      refuse_cardan("its axes do not meet in one point");
  }
}

// The phase psi over time.
class CardanPhase {
 public:
  CardanPhase(const Scene& scene, const CardanShaft& shaft)
      : cos_beta_(shaft.shaft.axis.dot(shaft.other_shaft.axis)),
        sin_beta_(shaft.shaft.axis.cross(shaft.other_shaft.axis).norm()) {
    const ExtendedVec3 &a = shaft.shaft.axis, middle = a.cross(shaft.other_shaft.axis) / sin_beta_, u = shaft.arm.axis;
    start_ = std::atan2(a.cross(middle).dot(u), middle.dot(u));
    find_inertia(scene, shaft);
    quadrature_ = EvenQuadrature([this](Extended psi) { return std::sqrt(inertia(psi)); }, kHalfPi);
    if (!quadrature_.converges()) refuse_cardan("the shafts are too near to a right angle");
    from_ = quadrature_.at(start_);
    rate_ = a.dot(extended(scene.bodies[shaft.first].angular_velocity));
    momentum_ = std::sqrt(inertia(start_)) * rate_;
  }

  Extended start() const { return start_; }                                          // rad
  Extended start_rate() const { return rate_; }                                      // rad/s
  Extended rate(Extended psi) const { return momentum_ / std::sqrt(inertia(psi)); }  // rad/s

  Extended at(Extended t) const {  // rad
    const Extended wanted = from_ + momentum_ * t;
    Extended psi = start_ + rate_ * t;
    constexpr int kMostRounds = 60;  // of Newton's method on what rises all the time: a handful
    for (int round = 0; round < kMostRounds; ++round) {
      const Extended step = (quadrature_.at(psi) - wanted) / std::sqrt(inertia(psi));
      psi -= step;
      if (std::abs(step) <= 8 * kExtendedEpsilon * (1 + std::abs(psi))) break;
    }
    return psi;
  }

  // w2 / w1.
  Extended ratio(Extended psi) const { return cos_beta_ / square_of_D(psi); }
  // The second shaft's angle.
  Extended chi(Extended psi) const {
    const Extended s = std::sin(psi), c = std::cos(psi);
    return psi - std::atan2((1 - cos_beta_) * s * c, c * c + cos_beta_ * s * s);
  }
  // The cross's about its arm, and its rate over the first shaft's.
  Extended eta(Extended psi) const { return std::atan2(-cos_beta_, sin_beta_ * std::cos(psi)); }
  Extended eta_rate(Extended psi) const { return -ratio(psi) * sin_beta_ * std::sin(psi); }

 private:
  static constexpr Extended kHalfPi = std::numbers::pi_v<Extended> / 2;

  Extended square_of_D(Extended psi) const {
    const Extended s = sin_beta_ * std::sin(psi);
    return 1 - s * s;
  }

  // M(psi): twice the energy over w1², in the cross's frame of its two arms and the direction across both.
  Extended inertia(Extended psi) const {
    const Extended ratio = this->ratio(psi), turning = eta_rate(psi), along = sin_beta_ * std::cos(psi);
    return first_ + second_ * ratio * ratio + of_cross_[0] * turning * turning +
           (of_cross_[1] * along * along + of_cross_[2] * cos_beta_ * cos_beta_) / square_of_D(psi);
  }

  void find_inertia(const Scene& scene, const CardanShaft& shaft) {
    const auto about = [&](int index, const ExtendedVec3& axis) {
      const Body& body = scene.bodies[index];
      const ExtendedVec3 n = extended(body.orientation).conjugate() * axis,
                         arm = (extended(body.position) - shaft.centre).cross(axis);
      return n.dot(extended(body.inertia) * n) + static_cast<Extended>(body.mass) * arm.squaredNorm();
    };
    first_ = about(shaft.first, shaft.shaft.axis), second_ = about(shaft.second, shaft.other_shaft.axis);
    const Body& cross = scene.bodies[shaft.cross];
    if ((extended(cross.position) - shaft.centre).norm() > kCardanRoundings * (1 + shaft.centre.norm()))
      refuse_cardan("the cross's centre of mass is not where its arms meet");
    const ExtendedVec3 arms[] = {shaft.arm.axis, shaft.other_arm.axis, shaft.arm.axis.cross(shaft.other_arm.axis)};
    for (int k = 0; k < 3; ++k) {
      const ExtendedVec3 n = extended(cross.orientation).conjugate() * arms[k], moment = extended(cross.inertia) * n;
      of_cross_[k] = n.dot(moment);
      if (moment.cross(n).norm() > kCardanRoundings * moment.norm())
        refuse_cardan("the cross's arms are no principal axes of it");
    }
  }

  Extended cos_beta_, sin_beta_;
  Extended first_ = 0, second_ = 0, of_cross_[3] = {};  // kg m²
  Extended start_ = 0, from_ = 0, rate_ = 0, momentum_ = 0;
  EvenQuadrature quadrature_;
};

enum class CardanPart { first, cross, second };

class CardanBody final : public BodyMotion {
 public:
  CardanBody(const Body& body, CardanPart part, const CardanShaft& shaft, const CardanPhase& phase)
      : part_(part),
        shaft_(shaft),
        phase_(phase),
        arm_(extended(body.position) - shaft.centre),
        turn_(extended(body.orientation)) {}

  ExtendedState at(Extended t) const override {
    const Extended psi = phase_.at(t), w1 = phase_.rate(psi);
    const ExtendedVec3 &a = shaft_.shaft.axis, &b = shaft_.other_shaft.axis;
    ExtendedQuat turned = turn((psi - phase_.start()) * a);
    ExtendedVec3 w = w1 * a;
    if (part_ == CardanPart::second) {
      turned = turn((phase_.chi(psi) - phase_.chi(phase_.start())) * b);
      w = w1 * phase_.ratio(psi) * b;
    } else if (part_ == CardanPart::cross) {
      w += w1 * phase_.eta_rate(psi) * (turned * shaft_.arm.axis);
      turned = turned * turn((phase_.eta(psi) - phase_.eta(phase_.start())) * shaft_.arm.axis);
    }
    const ExtendedVec3 arm = turned * arm_;
    return {shaft_.centre + arm, turned * turn_, w.cross(arm), w};
  }

  // The scene's numbers are roundings: of its rates, by which the phase gains, and of its lengths.
  double error(double t) const override {
    const double reach = static_cast<double>(arm_.norm()), rate = static_cast<double>(std::abs(phase_.start_rate()));
    return 4 * kEpsilon * (1 + reach) * (1 + rate * t) + kEpsilon * static_cast<double>(shaft_.centre.norm());
  }

  // m/s and rad/s, by which the body's own velocities at t = 0 miss these.
  Extended misses(const Body& body) const {
    const ExtendedState now = at(0);
    return (now.velocity - extended(body.velocity)).norm() +
           (now.angular_velocity - extended(body.angular_velocity)).norm();
  }

 private:
  CardanPart part_;
  CardanShaft shaft_;
  CardanPhase phase_;
  ExtendedVec3 arm_;  // m, from where the axes meet, at t = 0
  ExtendedQuat turn_;
};

std::unique_ptr<Truth> make_cardan_shaft(const Scene& scene, double) {
  check_needs(scene, "cardan-shaft", "two shafts joined by a cross", {joint_feature<HingeJoint>()});
  if (!scene.gravity.isZero(0)) refuse_cardan("gravity acts");
  CardanShaft shaft = shaft_of(scene);
  check_geometry(shaft);
  const CardanPhase phase(scene, shaft);
  return closed_form(scene, [&](const Body& body) -> std::unique_ptr<BodyMotion> {
    const int index = static_cast<int>(&body - scene.bodies.data());
    const CardanPart part = index == shaft.first   ? CardanPart::first
                            : index == shaft.cross ? CardanPart::cross
                                                   : CardanPart::second;
    auto motion = std::make_unique<CardanBody>(body, part, shaft, phase);
    if (motion->misses(body) > kCardanRoundings * (1 + std::abs(phase.start_rate())))
      refuse_cardan(fmt::format("body '{}' does not move with the rest", body.name));
    return motion;
  });
}

}  // namespace

TruthRow cardan_shaft_truth() {
  return {"cardan-shaft", "two shafts joined by a cross, by Cardan's ratio and the energy that stays",
          make_cardan_shaft};
}

}  // namespace rigor::inline truth
