// Balls that bounce on a plane with a soft contact, each along the plane's normal. Let x be the overlap, and g gravity
// into the plane. In flight x'' = g. While k x + c x' > 0 and x > 0,
//   m x'' = m g - k x - c x',
// a damped oscillation about x = m g/k. The contact ends where the force does (Stronge, Impact Mechanics, 2000, section
// 5.1). Without gravity that is after 2 acos(z)/w, w = sqrt(k/m) sqrt(1 - z²), z = c/(2 sqrt(k m)) < 1, and the ball
// leaves with exp(-2 z acos(z)/sqrt(1 - z²)) of its speed. With gravity the end is found as a root of the force. The
// law of Hunt and Crossley has its own file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cases/truth/closed_form/contact/hunt_crossley.h"
#include "cases/truth/closed_form/contact/plane_contact.h"

namespace rigor::inline truth {
namespace {

constexpr const char* kSoftBounce = "soft-bounce";
constexpr const char* kSoftBounceIsFor = "balls that bounce on one soft plane along its normal";

// The overlap and its rate; negative above the plane.
struct SpringState {
  Extended x, v;  // m, m/s
};

struct SpringDamper {
  Extended mass, stiffness, damping, gravity;  // kg, N/m, N s/m, m/s²

  Extended force(const SpringState& at) const { return stiffness * at.x + damping * at.v; }
  Extended rate() const { return damping / (2 * mass); }              // 1/s
  Extended frequency() const { return std::sqrt(stiffness / mass); }  // rad/s, undamped
  Extended sag() const { return mass * gravity / stiffness; }         // m, at rest

  // After t in contact. With b the rate, q = b² - k/m and s = sqrt(|q|),
  //   x = sag + y0 C + (v0 + b y0) S,   C = e^{-bt} cosh(st), S = e^{-bt} sinh(st)/s for q > 0, else with cos and sin.
  SpringState in_contact(const SpringState& start, Extended t) const {
    const Extended b = rate(), q = b * b - stiffness / mass, size = std::sqrt(std::abs(q)), y = start.x - sag();
    Extended C = std::exp(-b * t), S = t * C;
    if (q > 0 && size * t > 0) {
      const Extended slow = std::exp((size - b) * t), fast = std::exp(-(size + b) * t);
      C = (slow + fast) / 2, S = (slow - fast) / (2 * size);
    } else if (size * t > 0) {
      S = C * std::sin(size * t) / size, C *= std::cos(size * t);
    }
    const Extended slope = start.v + b * y, now = y * C + slope * S;
    return {sag() + now, y * q * S + slope * C - b * now};
  }
  SpringState in_flight(const SpringState& start, Extended t) const {
    return {start.x + start.v * t + gravity * t * t / 2, start.v + gravity * t};
  }
};

struct SoftPhase {
  Extended from;  // s
  SpringState start;
  bool touches;
};

class SoftBounce final : public BodyMotion {
 public:
  SoftBounce(const Body& body, const Ground& ground, const SpringDamper& law, Extended duration)
      : body_(body), up_(ground.normal()), law_(law), depth_(-ground.gap_under(body)) {
    SpringState start{depth_, -up_.dot(extended(body.velocity))};
    bool touches = start.x > 0 && law_.force(start) > 0;
    for (Extended t = 0;; touches = !touches) {
      phases_.push_back({t, start, touches});
      if (phases_.size() > kMostPhases) ground.refuse(body, "bounces too often");
      const auto length = touches ? contact_time(start, duration - t) : std::optional(flight_time(start));
      if (!length || t + *length >= duration) return;
      start = touches ? law_.in_contact(start, *length) : law_.in_flight(start, *length);
      t += *length;
    }
  }

  ExtendedState at(Extended t) const override {
    const auto later = std::upper_bound(phases_.begin(), phases_.end(), t,
                                        [](Extended time, const SoftPhase& phase) { return time < phase.from; });
    const SoftPhase& phase = later == phases_.begin() ? *later : *(later - 1);
    const Extended in = t - phase.from;
    const SpringState now = phase.touches ? law_.in_contact(phase.start, in) : law_.in_flight(phase.start, in);
    return {extended(body_.position) - (now.x - depth_) * up_, extended(body_.orientation), -now.v * up_,
            ExtendedVec3::Zero()};
  }

  // The rounding of the place to double, and of the phases in extended precision. Each phase hands on an error of its
  // end, which is a time, and so of a fall at the largest speed.
  double error(double t) const override {
    const Extended fall = std::abs(depth_) + law_.gravity * t * t / 2 + std::abs(phases_.front().start.v) * t;
    const auto phases = static_cast<double>(phases_.size());
    return kEpsilon * (body_.position.norm() + static_cast<double>(fall)) +
           64 * kExtendedEpsilon * phases * static_cast<double>((1 + law_.frequency() * t) * fall);
  }

 private:
  static constexpr std::size_t kMostPhases = 10000;

  // Until the force begins: where the ball comes back to the plane, or inside of it, where k x + c x' is zero again. A
  // flight may start inside, when the damper would pull; that sum is then negative until its later root.
  Extended flight_time(const SpringState& start) const {
    const Extended g = law_.gravity, k = law_.stiffness;
    if (start.x > 0) {
      const Extended slope = k * start.v + law_.damping * g;
      const Extended root = std::sqrt(std::max<Extended>(0, slope * slope - 2 * k * g * law_.force(start)));
      const Extended t = (root - slope) / (k * g);
      if (law_.in_flight(start, t).x > 0) return t;
    }
    return (-start.v + std::sqrt(start.v * start.v - 2 * g * start.x)) / g;
  }

  // Until the force ends; none if it does not within `longest`. The force is m (g - y''), whose oscillation has no more
  // than one root in a quarter of its period.
  std::optional<Extended> contact_time(const SpringState& start, Extended longest) const {
    constexpr int kOfPeriod = 64, kHalvings = 80;
    const Extended step = 1 / (kOfPeriod * (law_.frequency() + law_.rate()));
    const auto force = [&](Extended t) { return law_.force(law_.in_contact(start, t)); };
    // Once the oscillation is below the sag, the force keeps its sign.
    const Extended b = law_.rate(), speed = std::abs(start.v) + law_.frequency() * std::abs(start.x - law_.sag());
    const Extended settled =
        b > 0 ? std::log(std::max<Extended>(2, 8 * speed * (law_.frequency() + b) / law_.gravity)) / slowest_decay()
              : std::numeric_limits<Extended>::infinity();
    for (Extended t = step; t < std::min(longest, settled) + step; t += step) {
      if (force(t) > 0) continue;
      Extended low = t - step, high = t;
      for (int i = 0; i < kHalvings; ++i) {
        const Extended middle = (low + high) / 2;
        (force(middle) > 0 ? low : high) = middle;
      }
      return high;
    }
    return {};
  }

  Extended slowest_decay() const {
    const Extended b = law_.rate(), q = b * b - law_.stiffness / law_.mass;
    return q > 0 ? b - std::sqrt(q) : b;
  }

  const Body& body_;
  ExtendedVec3 up_;
  SpringDamper law_;
  Extended depth_;  // m, at the start; negative above the plane
  std::vector<SoftPhase> phases_;
};

void check_ball(const Body& body, const Ground& ground) {
  if (!body.collides || !std::holds_alternative<Sphere>(*body.shape)) ground.refuse(body, "is no ball");
  if (!are_along(extended(body.velocity), ground.normal())) ground.refuse(body, "moves along the plane");
  if (!body.angular_velocity.isZero(0)) ground.refuse(body, "turns");
  if (ground.along().norm() > 1e-12L * ground.pressing()) ground.refuse(body, "is on a slope");
}

std::unique_ptr<BodyMotion> bounce_of(const Body& body, const ContactLaw& law, const Ground& ground,
                                      Extended duration) {
  if (law.dissipation > 0) return hunt_crossley_bounce(body, ground, law.stiffness, law.dissipation, duration);
  return std::make_unique<SoftBounce>(body, ground,
                                      SpringDamper{body.mass, law.stiffness, law.damping, ground.pressing()}, duration);
}

std::unique_ptr<Truth> make_soft_bounce(const Scene& scene, double duration) {
  check_needs(scene, kSoftBounce, kSoftBounceIsFor,
              {contact_feature<Plane, Sphere>(), contact_feature<Sphere, Sphere>(), Feature::friction_none,
               Feature::soft_contact, Feature::hunt_crossley});
  const Ground ground(scene, kSoftBounce, kSoftBounceIsFor);
  std::vector<SweptDisk> sweeps;
  auto truth = closed_form(scene, [&](const Body& body) {
    check_ball(body, ground);
    const ContactLaw law = scene.contact_law(static_cast<int>(&body - scene.bodies.data()), ground.body());
    if (!law.is_soft()) ground.refuse(body, "has a rigid contact");
    sweeps.push_back({&body, {extended(body.position)}, bounding_radius(*body.shape)});
    return bounce_of(body, law, ground, duration);
  });
  check_apart(sweeps, ground);
  return truth;
}

}  // namespace

TruthRow soft_bounce_truth() {
  return {kSoftBounce,
          "balls bouncing on a plane with a spring and damper in the contact, in closed form or as power series",
          make_soft_bounce};
}

}  // namespace rigor::inline truth
