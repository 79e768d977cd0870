// Spheres that fall along gravity onto a plane across it, bounce by bounce. With the first impact at t1 and speed u,
// the k-th flight begins with speed u e^k and lasts 2 u e^k / g, so it begins S e (1 - e^(k-1)) / (1 - e) after t1,
// where S = 2 u / g; at rest from S e / (1 - e) on (Zeno's limit of the geometric series).
//
// Between impacts a sphere may drift and spin freely. At an impact with the normal impulse J = m (1 + e) u friction
// acts against the slip of the contact point, (v + w x r)_t. It reduces the slip by at most mu J (1/m + r²/I), and
// never below zero; from then on the sphere rolls. Infinite friction ends the slip at the first impact, zero friction
// never changes it. A slip that outlasts the bounces continues under mu m g (Goldsmith, Impact, 1960, chapter 2; Brach,
// Mechanical Impact Dynamics, 1991, chapter 2).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/truth/closed_form/phased_motion.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw InputError("the truth 'bounce' is for spheres above one plane across gravity: " + why);
}

struct Height {
  double above;  // m, of the sphere's lowest point over the plane
  double speed;  // m/s, upwards
};

// One sphere's fall along the vertical.
class VerticalBounce {
 public:
  VerticalBounce() = default;
  VerticalBounce(Height start, double gravity, double restitution) : start_(start), g_(gravity), e_(restitution) {
    impact_speed_ = std::sqrt(start.speed * start.speed + 2 * g_ * start.above);
    // The root without cancellation: rising and falling starts each have their own.
    first_impact_ =
        start.speed >= 0 ? (start.speed + impact_speed_) / g_ : 2 * start.above / (impact_speed_ - start.speed);
  }

  Height at(double t) const {
    if (t < first_impact_) return flown(start_, t);
    const double since = t - first_impact_, period = 2 * impact_speed_ / g_;
    if (e_ == 0 || impact_speed_ == 0) return {0, 0};
    if (e_ == 1) return flown({0, impact_speed_}, since - std::floor(since / period) * period);
    // e^(k-1) lies just above this share of the series that is still to come, k being the number of the flight.
    const double to_come = 1 - since * (1 - e_) / (period * e_);
    constexpr double kNothing = 16 * kEpsilon;  // its own rounding
    if (to_come <= kNothing) return {0, 0};
    const double before = std::floor(std::log(to_come) / std::log(e_)), power = std::pow(e_, before);
    const double begin = period * e_ * (1 - power) / (1 - e_);
    return flown({0, impact_speed_ * e_ * power}, since - begin);
  }

  double top_speed() const { return impact_speed_; }  // m/s

  // The impact that follows `before` others.
  double impact_speed(int before) const { return impact_speed_ * std::pow(e_, before); }  // m/s
  double impact_time(int before) const {                                                  // s
    if (before == 0) return first_impact_;
    const double period = 2 * impact_speed_ / g_;
    return first_impact_ + (e_ == 1 ? period * before : period * e_ * (1 - std::pow(e_, before)) / (1 - e_));
  }
  // s, from which on it lies still; infinite for a ball that never does.
  double rest_time() const {
    if (impact_speed_ == 0) return 0;
    if (e_ == 1) return std::numeric_limits<double>::infinity();
    return first_impact_ + 2 * impact_speed_ / g_ * e_ / (1 - e_);
  }

 private:
  Height flown(Height from, double t) const {
    return {std::max(0.0, from.above + t * (from.speed - 0.5 * g_ * t)), from.speed - g_ * t};
  }

  Height start_{0, 0};
  double g_ = 1, e_ = 0, impact_speed_ = 0, first_impact_ = 0;
};

// The motion of one sphere along the plane, and its rotation: one phase from each impact that still changes its slip.
class SidewaysMotion {
 public:
  SidewaysMotion(const Body& body, double radius, const ExtendedVec3& up, double gravity, ContactLaw law)
      : body_(body),
        arm_(-Extended(radius) * up),
        k_(body.inertia(0, 0) / (body.mass * Extended(radius) * radius)),
        gravity_(gravity),
        law_(law),
        now_{0,
             {along(extended(body.position)), extended(body.orientation), along(extended(body.velocity)),
              extended(body.angular_velocity)}} {}

  std::vector<Phase> phases(const VerticalBounce& bounce, double duration) {
    if (law_.friction == 0 || slip().norm() == 0) return {now_};
    const double rest = bounce.rest_time();
    constexpr int kMost = 100000;       // impacts that change the slip
    constexpr double kTooSlow = 1e-17;  // of the first impact: its impulse is lost in the rounding of the sum
    for (int n = 0; n < kMost; ++n) {
      const double speed = bounce.impact_speed(n), time = bounce.impact_time(n);
      if (time > duration || (rest > duration && speed == 0)) return finished();
      if (speed <= kTooSlow * bounce.top_speed()) return slide_from(rest);
      if (hit(time, (1 + law_.restitution) * Extended(speed))) return finished();
    }
    refuse(fmt::format("body '{}' slips through more than {} impacts", body_.name, kMost));
  }

 private:
  ExtendedVec3 along(const ExtendedVec3& v) const { return v - arm_.dot(v) / arm_.squaredNorm() * arm_; }
  ExtendedVec3 slip() const { return along(now_.start.velocity + now_.start.angular_velocity.cross(arm_)); }

  std::vector<Phase> finished() {
    done_.push_back(now_);
    return std::move(done_);
  }
  void go_on_from(Extended time) {
    done_.push_back(now_);
    now_ = {time, now_.at(time)};
  }
  void push(const ExtendedVec3& impulse) {  // m/s, per mass
    now_.start.velocity += impulse;
    now_.start.angular_velocity += arm_.cross(impulse) / (k_ * arm_.squaredNorm());
  }

  // The impulses are per mass. True if the slip has ended.
  bool hit(Extended time, Extended normal_impulse) {
    go_on_from(time);
    const ExtendedVec3 u = slip();
    const Extended to_stop = u.norm() / (1 + 1 / k_);
    const bool stops = law_.friction == kInfiniteFriction || law_.friction * normal_impulse >= to_stop;
    push(-(stops ? to_stop : law_.friction * normal_impulse) * u.normalized());
    return stops;
  }

  // It lies on the plane and slips on, until it rolls.
  std::vector<Phase> slide_from(double time) {
    if (law_.friction == kInfiniteFriction) {
      hit(time, 0);
      return finished();
    }
    go_on_from(time);
    const ExtendedVec3 u = slip(), friction = -law_.friction * gravity_ * u.normalized();
    now_.acceleration = friction;
    now_.angular_acceleration = arm_.cross(friction) / (k_ * arm_.squaredNorm());
    const ExtendedVec3 w = now_.start.angular_velocity;
    if (w.cross(now_.angular_acceleration).norm() > 1e-12L * w.norm() * now_.angular_acceleration.norm()) {
      refuse(fmt::format("body '{}' spins about another axis than that about which friction turns it", body_.name));
    }
    go_on_from(time + u.norm() / (friction.norm() * (1 + 1 / k_)));
    return finished();
  }

  const Body& body_;
  ExtendedVec3 arm_;  // m, from the centre to the contact point
  Extended k_;        // 1, I/(m r²)
  Extended gravity_;  // m/s²
  ContactLaw law_;
  Phase now_;
  std::vector<Phase> done_;
};

struct Ball {
  int body;
  VerticalBounce bounce;
  double ground;          // m, height of the centre when it touches
  PhasedMotion sideways;  // without its height
  bool drifts;            // along the plane
};

class Bounce final : public Truth {
 public:
  Bounce(const Scene& scene, double duration) : scene_(scene), duration_(duration) {
    check_that_only_contact_acts();
    const double g = scene.gravity.norm();
    if (g == 0) refuse("there is no gravity");
    up_ = -scene.gravity / g;
    const int plane = find_plane();
    for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
      if (!scene.bodies[i].fixed) balls_.push_back(make_ball(i, plane, g));
    }
    check_that_balls_stay_apart();
  }

  void at(double t, MutableBodyColumns out) const override {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const Body& body = scene_.bodies[i];
      if (body.fixed) out.set_body(i, {body.position, body.orientation, Vec3::Zero(), Vec3::Zero()});
    }
    for (const Ball& ball : balls_) out.set_body(ball.body, ball_at(ball, t));
  }

  // Roundings of the terms summed; the phase of a bounce is a time's rounding at the top speed.
  double error(double t) const override {
    double largest = 0;
    for (const Ball& ball : balls_) {
      const Body& body = scene_.bodies[ball.body];
      const double speed = body.velocity.norm() + ball.bounce.top_speed();
      largest = std::max({largest, body.position.norm() + speed * t, 1 + body.angular_velocity.norm() * t,
                          ball.sideways.error(t) / kEpsilon});
    }
    return 16 * kEpsilon * largest;
  }

 private:
  void check_that_only_contact_acts() const {
    if (!scene_.springs.empty()) refuse("this scene has springs");
    if (!scene_.joints.empty()) refuse("this scene has joints");
    if (!scene_.forces.empty()) refuse("this scene has forces");
  }

  int find_plane() const {
    int plane = kWorld;
    for (int i = 0; i < static_cast<int>(scene_.bodies.size()); ++i) {
      const Body& body = scene_.bodies[i];
      if (!body.fixed || !body.collides) continue;
      if (!std::holds_alternative<Plane>(*body.shape)) {
        refuse(fmt::format("body '{}' is a fixed {}", body.name, shape_name(*body.shape)));
      }
      if (plane != kWorld) refuse(fmt::format("'{}' is a second plane", body.name));
      plane = i;
    }
    if (plane == kWorld) refuse("there is no plane that collides");
    const Vec3& normal = std::get<Plane>(*scene_.bodies[plane].shape).normal;
    constexpr double kAligned = 1e-12;  // rad; sideways gravity over minutes is then below a nanometre
    if ((normal - up_).norm() > kAligned) {
      refuse(fmt::format("the normal of '{}' is ({}, {}, {}), which is not opposite to gravity",
                         scene_.bodies[plane].name, normal.x(), normal.y(), normal.z()));
    }
    return plane;
  }

  Ball make_ball(int index, int plane, double g) const {
    const Body& body = scene_.bodies[index];
    if (!body.collides || !body.shape || !std::holds_alternative<Sphere>(*body.shape)) {
      refuse(fmt::format("body '{}' is not a sphere that collides", body.name));
    }
    const double radius = std::get<Sphere>(*body.shape).radius;
    const ContactLaw law = scene_.contact_law(index, plane);
    const double ground = std::get<Plane>(*scene_.bodies[plane].shape).offset + radius;
    double above = up_.dot(body.position) - ground;
    const double rounding = 8 * kEpsilon * (std::abs(ground) + radius);
    if (above < -rounding) refuse(fmt::format("body '{}' starts {:.3g} m inside the plane", body.name, -above));
    check_inertia(body);
    const VerticalBounce bounce({std::max(0.0, above), up_.dot(body.velocity)}, g, law.restitution);
    SidewaysMotion sideways(body, radius, extended(up_).normalized(), g, law);
    std::vector<Phase> phases = sideways.phases(bounce, duration_);
    const bool drifts =
        std::any_of(phases.begin(), phases.end(), [](const Phase& p) { return p.start.velocity.norm() > 0; });
    return {index, bounce, ground, PhasedMotion(std::move(phases), 0), drifts};
  }

  static void check_inertia(const Body& body) {
    const double I = body.inertia(0, 0);
    const bool turns = !body.angular_velocity.isZero(0) || !body.velocity.isZero(0);
    if (turns && (body.inertia - I * Mat3::Identity()).norm() > 4 * kEpsilon * I) {
      refuse(
          fmt::format("body '{}' spins, or may come to, and its inertia is not the same about every axis", body.name));
    }
  }

  // Nothing but the plane may be hit. Balls that move sideways could meet, so then there may be only one.
  void check_that_balls_stay_apart() const {
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Body &a = scene_.bodies[balls_[i].body], &b = scene_.bodies[balls_[j].body];
        const double reach = std::get<Sphere>(*a.shape).radius + std::get<Sphere>(*b.shape).radius;
        const Vec3 apart = a.position - b.position, level = apart - up_.dot(apart) * up_;
        if (!balls_[i].drifts && !balls_[j].drifts && level.norm() >= reach) continue;
        refuse(fmt::format("bodies '{}' and '{}' could touch", a.name, b.name));
      }
    }
  }

  BodyState ball_at(const Ball& ball, double t) const {
    const Height height = ball.bounce.at(t);
    const ExtendedState level = ball.sideways.at(t);
    return {Vec3(level.position.cast<double>()) + (ball.ground + height.above) * up_, level.orientation.cast<double>(),
            Vec3(level.velocity.cast<double>()) + height.speed * up_, level.angular_velocity.cast<double>()};
  }

  Scene scene_;
  double duration_;  // s
  Vec3 up_ = Vec3::UnitY();
  std::vector<Ball> balls_;
};

}  // namespace

TruthRow bounce_truth() {
  return {"bounce", "spheres falling on a plane, bounce by bounce to rest, in closed form",
          [](const Scene& scene, double duration) { return std::make_unique<Bounce>(scene, duration); }};
}

}  // namespace rigor::inline truth
