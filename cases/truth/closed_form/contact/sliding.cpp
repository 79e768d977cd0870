// Boxes that lie flat on a level or sloping plane, and slide or stick. Let gravity be g_n into the plane and g_t along
// it. A moving box has the acceleration g_t - mu g_n v/|v|. A resting box sticks while |g_t| <= mu g_n, and otherwise
// slides with g_t (1 - mu g_n/|g_t|). On a level plane it stops after v²/(2 mu g); on a slope it slides if tan(slope) >
// mu (Coulomb's law; e.g. Kleppner and Kolenkow, An Introduction to Mechanics). It does not rotate. Friction at each
// point of its face acts in the same direction, and the distribution of pressure balances its moment.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "cases/truth/closed_form/contact/plane_contact.h"
#include "cases/truth/closed_form/phased_motion.h"

namespace rigor::inline truth {
namespace {

constexpr const char* kSliding = "sliding";
constexpr const char* kSlidingIsFor = "boxes that lie flat on one plane and do not turn";

class Slider {
 public:
  Slider(const Body& body, const Ground& ground, double friction) : body_(body), ground_(ground), friction_(friction) {
    check();
  }

  std::vector<Phase> phases(double duration) const {
    Phase now{0,
              {extended(body_.position), extended(body_.orientation), extended(body_.velocity), ExtendedVec3::Zero()}};
    std::vector<Phase> out;
    while (true) {
      const bool moves = now.start.velocity.norm() > 0;
      const auto end = moves ? slide_on(now) : start_or_hold(now);
      out.push_back(now);
      if (!end || *end > duration) return out;
      now = {*end, now.at(*end)};
      now.start.velocity.setZero();
    }
  }

  double radius() const { return 0.5 * std::get<Box>(*body_.shape).size.norm(); }  // m, round its centre

 private:
  void check() const {
    if (!body_.collides || !std::holds_alternative<Box>(*body_.shape)) ground_.refuse(body_, "is no such box");
    if (std::abs(ground_.gap_under(body_)) > kTouching)
      ground_.refuse(body_, fmt::format("is {:.3g} m above the plane", ground_.gap_under(body_)));
    if (!body_.angular_velocity.isZero(0)) ground_.refuse(body_, "turns");
    const ExtendedVec3 v = extended(body_.velocity);
    if (std::abs(ground_.normal().dot(v)) > 1e-12L * v.norm()) ground_.refuse(body_, "leaves or enters the plane");
    const ExtendedVec3 up = normal_in_body();
    int axis = 0;
    up.cwiseAbs().maxCoeff(&axis);
    if ((up - up[axis] * ExtendedVec3::Unit(axis)).norm() > kTouching) ground_.refuse(body_, "does not lie on a face");
  }

  ExtendedVec3 normal_in_body() const { return extended(body_.orientation).conjugate() * ground_.normal(); }

  // Friction acts half a height below the centre; the plane's pressure must be able to hold that moment from within the
  // face that lies on it.
  void check_that_it_stands(const ExtendedVec3& friction) const {
    const ExtendedVec3 half = extended(std::get<Box>(*body_.shape).size) / 2, up = normal_in_body();
    int axis = 0;
    up.cwiseAbs().maxCoeff(&axis);
    const ExtendedVec3 shift = extended(body_.orientation).conjugate() * friction * (half[axis] / ground_.pressing());
    for (int k = 0; k < 3; ++k) {
      if (k != axis && std::abs(shift[k]) > half[k]) ground_.refuse(body_, "would tip over");
    }
  }

  std::optional<Extended> slide_on(Phase& phase) const {
    if (friction_ == kInfiniteFriction) ground_.refuse(body_, "slides, which infinite friction would end at once");
    const ExtendedVec3 v = phase.start.velocity;
    if (friction_ > 0 && !are_along(v, ground_.along()))
      ground_.refuse(body_, "slides across the slope, so that its path bends");
    const ExtendedVec3 friction = -friction_ * ground_.pressing() * v.normalized();
    check_that_it_stands(friction);
    phase.acceleration = ground_.along() + friction;
    const Extended rate = phase.acceleration.dot(v.normalized());
    if (rate >= 0 || friction_ == 0) return {};
    return phase.from + v.norm() / -rate;
  }

  std::optional<Extended> start_or_hold(Phase& phase) const {
    const Extended pull = ground_.along().norm(), most = friction_ * ground_.pressing();
    constexpr Extended kDigits = 1e-12L;  // of the slope: at the threshold itself it holds
    if (pull <= most * (1 + kDigits)) {
      check_that_it_stands(-ground_.along());
      return {};
    }
    const ExtendedVec3 friction = -most * ground_.along().normalized();
    check_that_it_stands(friction);
    phase.acceleration = ground_.along() + friction;
    return {};
  }

  const Body& body_;
  const Ground& ground_;
  Extended friction_;
};

std::unique_ptr<Truth> make_sliding(const Scene& scene, double duration) {
  check_needs(scene, kSliding, kSlidingIsFor,
              {contact_feature<Box, Plane>(), contact_feature<Box, Box>(), Feature::friction_none,
               Feature::friction_coulomb, Feature::friction_infinite, Feature::restitution});
  const Ground ground(scene, kSliding, kSlidingIsFor);
  std::vector<SweptDisk> sweeps;
  const auto motion_of = [&](const Body& body) {
    const int index = static_cast<int>(&body - scene.bodies.data());
    const Slider slider(body, ground, scene.contact_law(index, ground.body()).friction);
    auto motion = std::make_unique<PhasedMotion>(slider.phases(duration), std::abs(ground.gap_under(body)));
    sweeps.push_back({&body, motion->way(duration), slider.radius()});
    return motion;
  };
  auto truth = closed_form(scene, motion_of);
  check_apart(sweeps, ground);
  return truth;
}

}  // namespace

TruthRow sliding_truth() {
  return {kSliding, "boxes sliding, stopping and holding on a plane, level or sloping, in closed form", make_sliding};
}

}  // namespace rigor::inline truth
