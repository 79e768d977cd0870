// Spheres and lying cylinders that roll or slip on a level or sloping plane. Let k = I/(m r²), let gravity be g_n into
// the plane and g_t along it, and u the slip of the contact point. While the sphere slips, friction is -mu g_n u/|u|,
// and the slip changes by g_t - mu g_n (1 + 1/k) u/|u|. After the slip the sphere rolls with g_t/(1 + k) if friction
// suffices, |g_t|
// <= mu g_n (1 + k)/k. Otherwise it slips on downhill. For a solid sphere k = 2/5: 5/7 g_t, up to tan(slope) = 3.5 mu
// (Kleppner and Kolenkow, An Introduction to Mechanics, chapter 6).
//
// With rolling friction of length d the plane's force acts d ahead of the contact point (Johnson, Contact Mechanics,
// 1985, section 8.5). A rolling body then has the acceleration (g_t - (d/r) g_n v/|v|)/(1 + k), and it rests while
// |g_t| <= (d/r) g_n. With torsional friction of length s a sphere that spins about the normal slows by s g_n/(k r²).
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "cases/truth/closed_form/contact/plane_contact.h"
#include "cases/truth/closed_form/phased_motion.h"

namespace rigor::inline truth {
namespace {

constexpr const char* kRolling = "rolling";
constexpr const char* kRollingIsFor = "spheres and cylinders that touch one plane and move along one line on it";

// One sphere on the plane, phase by phase.
class Roller {
 public:
  Roller(const Body& body, const Ground& ground, const ContactLaw& law)
      : body_(body),
        ground_(ground),
        friction_(law.friction),
        rolling_friction_(law.rolling_friction),
        torsional_friction_(law.torsional_friction),
        r_(check()),
        k_(rolling_inertia(body) / (body.mass * r_ * r_)) {}

  std::vector<Phase> phases(double duration) {
    Phase now{0,
              {extended(body_.position), extended(body_.orientation), extended(body_.velocity),
               extended(body_.angular_velocity)}};
    std::vector<Phase> out;
    if (spins()) return spin_down(now);
    bool slips = friction_ == 0 || slip(now.start).norm() > kNoSlip * (now.start.velocity.norm() + 1);
    while (true) {
      if (slips && rolling_friction_ > 0)
        ground_.refuse(body_, "slips, and rolling friction is taken of bodies that roll");
      const auto end = slips ? slip_on(now) : rolling_friction_ > 0 ? roll_against(now) : roll_on(now);
      out.push_back(now);
      if (!end || *end > duration) return out;
      now = {*end, now.at(*end)};
      slips = false;
    }
  }

 private:
  static constexpr Extended kNoSlip = 1e-14L;  // of the speeds: roundings of the case file's numbers

  // Of a sphere about any axis, of a cylinder about its own.
  static double rolling_inertia(const Body& body) {
    return std::holds_alternative<Cylinder>(*body.shape) ? body.inertia(2, 2) : body.inertia(0, 0);
  }

  // A cylinder lies along the plane and moves across its axis.
  void check_cylinder() const {
    const ExtendedVec3 axis = extended(body_.orientation) * ExtendedVec3::UnitZ().eval(), v = extended(body_.velocity),
                       w = extended(body_.angular_velocity);
    constexpr Extended kDigits = 1e-12L;
    if (std::abs(axis.dot(ground_.normal())) > kDigits) ground_.refuse(body_, "does not lie along the plane");
    if (std::abs(axis.dot(v)) > kDigits * v.norm() || w.cross(axis).norm() > kDigits * w.norm() ||
        std::abs(axis.dot(ground_.along())) > kDigits * ground_.along().norm())
      ground_.refuse(body_, "does not roll across its axis");
    const Mat3& I = body_.inertia;
    if (std::abs(I(0, 2)) + std::abs(I(1, 2)) > 4 * kEpsilon * I(2, 2))
      ground_.refuse(body_, "has an axis that is no principal one");
  }

  double check() const {
    const bool is_cylinder = body_.collides && std::holds_alternative<Cylinder>(*body_.shape);
    if (!body_.collides || (!std::holds_alternative<Sphere>(*body_.shape) && !is_cylinder))
      ground_.refuse(body_, "is no such sphere or cylinder");
    if (std::abs(ground_.gap_under(body_)) > kTouching)
      ground_.refuse(body_, fmt::format("is {:.3g} m above the plane", ground_.gap_under(body_)));
    if (is_cylinder) {
      check_cylinder();
      return check_motion(std::get<Cylinder>(*body_.shape).radius);
    }
    const double I = body_.inertia(0, 0);
    if ((body_.inertia - I * Mat3::Identity()).norm() > 4 * kEpsilon * I)
      ground_.refuse(body_, "has an inertia that is not the same about every axis");
    return check_motion(std::get<Sphere>(*body_.shape).radius);
  }

  double check_motion(double radius) const {
    const ExtendedVec3 v = extended(body_.velocity), w = extended(body_.angular_velocity);
    if (std::abs(ground_.normal().dot(v)) > 1e-12L * v.norm()) ground_.refuse(body_, "leaves or enters the plane");
    if (std::abs(ground_.normal().dot(w)) > 1e-12L * w.norm() && !spins())
      ground_.refuse(body_, "spins about the plane's normal");
    return radius;
  }

  // Only a ball that stays where it is, under torsional friction.
  bool spins() const {
    const ExtendedVec3 w = extended(body_.angular_velocity);
    return torsional_friction_ > 0 && w.norm() > 0 && std::holds_alternative<Sphere>(*body_.shape) &&
           ground_.part_along(w).norm() <= 1e-12L * w.norm() && body_.velocity.isZero(0) &&
           ground_.along().norm() <= rolling_friction_ / r_of_ball() * ground_.pressing();
  }
  Extended r_of_ball() const { return std::get<Sphere>(*body_.shape).radius; }

  std::vector<Phase> spin_down(Phase phase) const {
    const ExtendedVec3 w = ground_.normal().dot(phase.start.angular_velocity) * ground_.normal();
    phase.start.angular_velocity = w;
    phase.angular_acceleration = -torsional_friction_ * ground_.pressing() / (k_ * r_ * r_) * w.normalized();
    const Extended end = phase.from + w.norm() / phase.angular_acceleration.norm();
    Phase rest{end, phase.at(end)};
    rest.start.angular_velocity.setZero();
    return {phase, rest};
  }

  ExtendedVec3 slip(const ExtendedState& s) const {
    return ground_.part_along(s.velocity - r_ * s.angular_velocity.cross(ground_.normal()));
  }

  ExtendedVec3 turned_by(const ExtendedVec3& friction) const {  // rad/s², by a friction in m/s²
    return -ground_.normal().cross(friction) / (k_ * r_);
  }

  // Sets the accelerations of a phase that starts slipping, or about to; the instant at which the slip ends, if it
  // does.
  std::optional<Extended> slip_on(Phase& phase) const {
    ExtendedVec3 u = slip(phase.start);
    if (friction_ == kInfiniteFriction) ground_.refuse(body_, "slips, which infinite friction would end at once");
    const bool starts = u.norm() == 0 || friction_ == 0;
    const ExtendedVec3 direction = starts ? unit(ground_.along()) : u.normalized();
    if (friction_ > 0 && (!are_along(u, ground_.along()) || !are_along(phase.start.velocity, direction)))
      ground_.refuse(body_, "slips across its way or the slope, so that its path bends");
    const ExtendedVec3 friction = -friction_ * ground_.pressing() * direction;
    phase.acceleration = ground_.along() + friction;
    phase.angular_acceleration = turned_by(friction);
    if (friction_ == 0) return {};
    const Extended rate = (ground_.along() + (1 + 1 / k_) * friction).dot(direction);
    if (starts || rate >= 0) return {};
    return phase.from + u.norm() / -rate;
  }

  std::optional<Extended> roll_on(Phase& phase) const {
    const Extended needed = ground_.along().norm() * k_ / (1 + k_);
    if (needed > friction_ * ground_.pressing()) {
      phase.start.angular_velocity = rolling_with(phase.start.velocity);  // the slip is only rounding
      return slip_downhill(phase);
    }
    if (!are_along(phase.start.velocity, ground_.along()))
      ground_.refuse(body_, "rolls across the slope, so that its path bends");
    phase.start.angular_velocity = rolling_with(phase.start.velocity);
    phase.acceleration = ground_.along() / (1 + k_);
    phase.angular_acceleration = rolling_with(phase.acceleration);
    return {};
  }

  // As roll_on(), against rolling friction. Ends where the body comes to rest.
  std::optional<Extended> roll_against(Phase& phase) const {
    const ExtendedVec3 v = phase.start.velocity;
    const Extended resistance = rolling_friction_ / r_ * ground_.pressing();
    const bool moves = v.norm() > kNoSlip, rests = !moves && ground_.along().norm() <= resistance;
    if (moves && !are_along(v, ground_.along()))
      ground_.refuse(body_, "rolls across the slope, so that its path bends");
    const ExtendedVec3 way = moves ? ExtendedVec3(v.normalized()) : unit(ground_.along());
    if (!rests) phase.acceleration = (ground_.along() - resistance * way) / (1 + k_);
    if ((phase.acceleration - ground_.along()).norm() > friction_ * ground_.pressing())
      ground_.refuse(body_, "slips, and rolling friction is taken of bodies that roll");
    if (!moves) phase.start.velocity.setZero();
    phase.start.angular_velocity = rolling_with(phase.start.velocity);
    phase.angular_acceleration = rolling_with(phase.acceleration);
    const Extended gains = phase.acceleration.dot(way);
    if (!moves || gains >= 0) return {};
    return phase.from + v.norm() / -gains;
  }

  std::optional<Extended> slip_downhill(Phase& phase) const {
    const ExtendedVec3 friction = -friction_ * ground_.pressing() * unit(ground_.along());
    if (!are_along(phase.start.velocity, ground_.along()))
      ground_.refuse(body_, "slips across the slope, so that its path bends");
    phase.acceleration = ground_.along() + friction;
    phase.angular_acceleration = turned_by(friction);
    return {};
  }

  ExtendedVec3 rolling_with(const ExtendedVec3& v) const { return ground_.normal().cross(v) / r_; }
  static ExtendedVec3 unit(const ExtendedVec3& v) { return v.norm() > 0 ? ExtendedVec3(v.normalized()) : v; }

  const Body& body_;
  const Ground& ground_;
  Extended friction_;
  Extended rolling_friction_, torsional_friction_;  // m
  Extended r_;                                      // m
  Extended k_;                                      // 1, I/(m r²)
};

std::unique_ptr<Truth> make_rolling(const Scene& scene, double duration) {
  check_needs(scene, kRolling, kRollingIsFor,
              {contact_feature<Cylinder, Plane>(), contact_feature<Plane, Sphere>(), contact_feature<Sphere, Sphere>(),
               Feature::friction_none, Feature::friction_coulomb, Feature::friction_infinite, Feature::restitution,
               Feature::contact_filter, Feature::rolling_friction, Feature::torsional_friction});
  const Ground ground(scene, kRolling, kRollingIsFor);
  std::vector<SweptDisk> sweeps;
  const auto motion_of = [&](const Body& body) {
    const int index = static_cast<int>(&body - scene.bodies.data());
    if (!scene.contact_law(index, ground.body()).collides) ground.refuse(body, "passes through the plane");
    Roller roller(body, ground, scene.contact_law(index, ground.body()));
    auto motion = std::make_unique<PhasedMotion>(roller.phases(duration), std::abs(ground.gap_under(body)));
    sweeps.push_back({&body, motion->way(duration), bounding_radius(*body.shape)});
    return motion;
  };
  auto truth = closed_form(scene, motion_of);
  check_apart(sweeps, ground);
  return truth;
}

}  // namespace

TruthRow rolling_truth() {
  return {kRolling, "spheres slipping and rolling on a plane, level or sloping, in closed form", make_rolling};
}

}  // namespace rigor::inline truth
