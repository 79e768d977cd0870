// Timed torques, constant in W, about the axis of rotation, which is a principal axis. The angle follows I angle'' =
// torque, the only remaining equation of Euler (Goldstein, Classical Mechanics, 3rd ed., section 5.5). Each torque T
// therefore adds T/I (a²/2 + (until - from) b), where a is the time it has acted and b the time since its end. The
// centre of mass follows its parabola.
#include <fmt/format.h>

#include <algorithm>

#include "cases/truth/closed_form/smooth/principal_spin.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_torque(const Body& body, const std::string& why) {
  throw InputError(fmt::format(
      "the truth 'principal-torque' is for torques about the axis a body turns about, a principal axis of its inertia; "
      "body '{}' {}",
      body.name, why));
}

struct Push {
  Extended acceleration;  // rad/s², about the axis
  Extended from, until;   // s
};

class TorquedSpin final : public BodyMotion {
 public:
  TorquedSpin(const Body& body, const Scene& scene, const std::vector<TimedForce>& torques)
      : path_(body, scene.gravity), spin_(body, axis_of(body, torques)) {
    if (!spin_.holds()) refuse_torque(body, "turns about another axis");
    speed_ = along_axis(body, body.angular_velocity);
    for (const TimedForce& torque : torques) {
      if (!torque.force.isZero(0)) refuse_torque(body, "has a force as well");
      pushes_.push_back({along_axis(body, torque.torque) / spin_.moment(), torque.from, torque.until});
    }
  }

  ExtendedState at(Extended t) const override {
    Extended angle = speed_ * t, speed = speed_;
    for (const Push& push : pushes_) {
      const Extended acted = time_acted(push, t);
      speed += push.acceleration * acted;
      angle += push.acceleration * acted * (acted / 2 + time_over(push, t));
    }
    return {path_.position(t), spin_.orientation(angle), path_.velocity(t), speed * spin_.axis()};
  }

  double error(double t) const override {
    Extended turned = std::abs(speed_) * t;  // at most
    for (const Push& push : pushes_) {
      const Extended acted = time_acted(push, t);
      turned += std::abs(push.acceleration) * acted * (acted / 2 + time_over(push, t));
    }
    return path_.error(t) + spin_.error(static_cast<double>(turned));
  }

 private:
  static Vec3 axis_of(const Body& body, const std::vector<TimedForce>& torques) {
    if (!body.angular_velocity.isZero(0)) return body.angular_velocity;
    for (const TimedForce& torque : torques) {
      if (!torque.torque.isZero(0)) return torque.torque;
    }
    return Vec3::Zero();
  }

  Extended along_axis(const Body& body, const Vec3& vector) const {
    const ExtendedVec3 v = extended(vector);
    constexpr Extended kRoundings = 4;  // of the vector's own numbers
    if (v.cross(spin_.axis()).norm() > kRoundings * static_cast<Extended>(kEpsilon) * v.norm()) {
      refuse_torque(body,
                    fmt::format("has a torque of ({}, {}, {}) N m across it", vector.x(), vector.y(), vector.z()));
    }
    return v.dot(spin_.axis());
  }

  static Extended time_acted(const Push& push, Extended t) {
    return std::max<Extended>(0, std::min(t, push.until) - std::max<Extended>(0, push.from));
  }
  static Extended time_over(const Push& push, Extended t) {
    return std::max<Extended>(0, t - std::max<Extended>(0, push.until));
  }

  Parabola path_;
  PrincipalSpin spin_;
  Extended speed_ = 0;  // rad/s about the axis at t = 0
  std::vector<Push> pushes_;
};

}  // namespace

TruthRow principal_torque_truth() {
  return {"principal-torque", "timed torques about the principal axis a body turns about, in closed form",
          [](const Scene& scene, double) {
            check_needs(scene, "principal-torque", "free bodies under timed torques", {Feature::timed_force});
            return closed_form(scene, [&](const Body& body) {
              std::vector<TimedForce> torques;
              for (const TimedForce& force : scene.forces) {
                if (&scene.bodies[force.body] == &body) torques.push_back(force);
              }
              return std::make_unique<TorquedSpin>(body, scene, torques);
            });
          }};
}

}  // namespace rigor::inline truth
