// Spheres that fall along gravity onto a plane across it, bounce by bounce. With the first impact at t1 and speed u,
// the k-th flight begins with speed u e^k and lasts 2 u e^k / g, so it begins S e (1 - e^(k-1)) / (1 - e) after t1,
// where S = 2 u / g; at rest from S e / (1 - e) on (Zeno's limit of the geometric series).
//
// Between impacts a sphere may drift and spin freely. Without friction nothing changes either; with infinite friction
// the first impact stops the slip of the contact point, (v + w x r)_t = 0, and the sphere rolls on from then
// (Goldsmith, Impact, 1960, section 2.1).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/truth/truth.h"
#include "core/error.h"

namespace rigor {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

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

  double first_impact() const { return first_impact_; }  // s

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

 private:
  Height flown(Height from, double t) const {
    return {std::max(0.0, from.above + t * (from.speed - 0.5 * g_ * t)), from.speed - g_ * t};
  }

  Height start_{0, 0};
  double g_ = 1, e_ = 0, impact_speed_ = 0, first_impact_ = 0;
};

struct Sideways {
  Vec3 velocity;          // m/s, along the plane, in W
  Vec3 angular_velocity;  // rad/s, in W
};

struct Ball {
  int body;
  VerticalBounce bounce;
  double ground;           // m, height of the centre when it touches
  Vec3 foot;               // m, the position without its height
  Sideways before, after;  // the first impact
};

class Bounce final : public Truth {
 public:
  explicit Bounce(const Scene& scene) : scene_(scene) {
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
      largest = std::max({largest, body.position.norm() + speed * t, 1 + body.angular_velocity.norm() * t});
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
    Ball ball;
    ball.body = index;
    ball.ground = std::get<Plane>(*scene_.bodies[plane].shape).offset + radius;
    double above = up_.dot(body.position) - ball.ground;
    const double rounding = 8 * kEpsilon * (std::abs(ball.ground) + radius);
    if (above < -rounding) refuse(fmt::format("body '{}' starts {:.3g} m inside the plane", body.name, -above));
    ball.bounce = VerticalBounce({std::max(0.0, above), up_.dot(body.velocity)}, g, law.restitution);
    ball.foot = along_plane(body.position);
    ball.before = {along_plane(body.velocity), body.angular_velocity};
    ball.after = after_impact(body, radius, law.friction, ball.before);
    return ball;
  }

  Vec3 along_plane(const Vec3& v) const { return v - up_.dot(v) * up_; }

  Sideways after_impact(const Body& body, double radius, double friction, const Sideways& before) const {
    const double I = body.inertia(0, 0);
    if (before.angular_velocity.norm() > 0 && (body.inertia - I * Mat3::Identity()).norm() > 4 * kEpsilon * I) {
      refuse(fmt::format("body '{}' spins, and its inertia is not the same about every axis", body.name));
    }
    const Vec3 arm = -radius * up_, slip = along_plane(before.velocity + before.angular_velocity.cross(arm));
    if (friction == 0 || slip.norm() == 0) return before;
    if (friction != kInfiniteFriction) {
      refuse(fmt::format("body '{}' slips over the plane with a finite friction of {}", body.name, friction));
    }
    const Vec3 impulse = -slip / (1 / body.mass + radius * radius / I);
    return {before.velocity + impulse / body.mass, before.angular_velocity + arm.cross(impulse) / I};
  }

  // Nothing but the plane may be hit. Balls that move sideways could meet, so then there may be only one.
  void check_that_balls_stay_apart() const {
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Body &a = scene_.bodies[balls_[i].body], &b = scene_.bodies[balls_[j].body];
        const double reach = std::get<Sphere>(*a.shape).radius + std::get<Sphere>(*b.shape).radius;
        const bool stand = balls_[i].before.velocity.isZero(0) && balls_[i].after.velocity.isZero(0) &&
                           balls_[j].before.velocity.isZero(0) && balls_[j].after.velocity.isZero(0);
        if (stand && (balls_[i].foot - balls_[j].foot).norm() >= reach) continue;
        refuse(fmt::format("bodies '{}' and '{}' could touch", a.name, b.name));
      }
    }
  }

  BodyState ball_at(const Ball& ball, double t) const {
    const Height height = ball.bounce.at(t);
    const double impact = ball.bounce.first_impact(), before = std::min(t, impact), after = t - before;
    const Sideways& now = t < impact ? ball.before : ball.after;
    return {
        ball.foot + (ball.ground + height.above) * up_ + before * ball.before.velocity + after * ball.after.velocity,
        rotation_by(after * ball.after.angular_velocity) * rotation_by(before * ball.before.angular_velocity) *
            scene_.bodies[ball.body].orientation,
        height.speed * up_ + now.velocity, now.angular_velocity};
  }

  Scene scene_;
  Vec3 up_ = Vec3::UnitY();
  std::vector<Ball> balls_;
};

}  // namespace

TruthRow bounce_truth() {
  return {"bounce", "spheres falling on a plane, bounce by bounce to rest, in closed form",
          [](const Scene& scene, double) { return std::make_unique<Bounce>(scene); }};
}

}  // namespace rigor
