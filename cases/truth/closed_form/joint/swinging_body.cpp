#include "cases/truth/closed_form/joint/swinging_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/truth/closed_form/smooth/principal_spin.h"

namespace rigor::inline truth {
namespace {

constexpr Extended kSwingingBodyRoundings = 64 * static_cast<Extended>(kEpsilon);  // of the scene's numbers, relative

class SwingingBody final : public BodyMotion {
 public:
  SwingingBody(const Body& body, const Swing& swing, const ExtendedVec3& axis, const PendulumPhase& phase,
               Extended misses)
      : phase_(phase),
        swing_(swing),
        axis_(axis),
        start_(extended(body.position)),
        orientation_(extended(body.orientation)),
        w_(extended(body.angular_velocity)),
        spin_(body, body.angular_velocity),
        misses_(misses) {}

  ExtendedState at(Extended t) const override {
    const PendulumPhase::HalfTurn half = phase_.at(t);
    const Extended sine = 2 * half.sine * half.cosine, less = -2 * half.sine * half.sine;
    const ExtendedVec3 position = start_ + less * swing_.along + sine * swing_.across,
                       velocity = half.rate * ((1 + less) * swing_.across - sine * swing_.along);
    if (!swing_.turns) return {position, spin_.orientation(w_.norm() * t), velocity, w_};
    const ExtendedVec3 u = half.sine * axis_;
    return {position, ExtendedQuat(half.cosine, u.x(), u.y(), u.z()) * orientation_, velocity, half.rate * axis_};
  }

  // The error: the deviation of the scene's numbers from the motion grows as it began.
  double error(double t) const override {
    const double reach = static_cast<double>(std::max(swing_.along.norm(), swing_.across.norm()));
    return (1 + reach) * (phase_.error(t) + static_cast<double>(misses_) * (1 + t)) +
           kEpsilon * (static_cast<double>(start_.norm()) + reach) +
           (swing_.turns ? 0 : spin_.error(static_cast<double>(w_.norm()) * t));
  }

 private:
  PendulumPhase phase_;
  Swing swing_;
  ExtendedVec3 axis_, start_;
  ExtendedQuat orientation_;
  ExtendedVec3 w_;
  PrincipalSpin spin_;
  Extended misses_;  // m/s and rad/s, m
};

// The sums over the scene.
struct Sums {
  Extended inertia = 0;           // kg m², about the angle
  Extended along = 0, mixed = 0;  // kg m², sum m |A|² - m |B|²; sum m A . B
  Extended momentum = 0;          // kg m²/s
  Extended P = 0, Q = 0;          // N m
};

Sums sums_of(const Scene& scene, const ExtendedVec3& axis, const std::vector<Swing>& swings) {
  Sums sums;
  const ExtendedVec3 g = extended(scene.gravity);
  for (const Swing& swing : swings) {
    const Body& body = scene.bodies[swing.body];
    const Extended mass = body.mass;
    sums.inertia += mass * swing.across.squaredNorm();
    sums.along += mass * (swing.along.squaredNorm() - swing.across.squaredNorm());
    sums.mixed += mass * swing.along.dot(swing.across);
    sums.momentum += mass * swing.across.dot(extended(body.velocity));
    sums.P += mass * g.dot(swing.along), sums.Q += mass * g.dot(swing.across);
    if (!swing.turns) continue;
    const ExtendedVec3 n = extended(body.orientation).conjugate() * axis,
                       w = extended(body.orientation).conjugate() * extended(body.angular_velocity);
    const Extended moment = n.dot(extended(body.inertia) * n);
    sums.inertia += moment, sums.momentum += moment * n.dot(w);
  }
  return sums;
}

// m/s and rad/s, by which the scene's velocities miss those of the angle's rate.
Extended missed(const Scene& scene, const ExtendedVec3& axis, const std::vector<Swing>& swings, Extended rate,
                bool spins, const Refuse& refuse) {
  Extended misses = 0;
  for (const Swing& swing : swings) {
    const Body& body = scene.bodies[swing.body];
    const ExtendedVec3 v = extended(body.velocity), w = extended(body.angular_velocity);
    const Extended off = (v - rate * swing.across).norm(), turned = (w - (swing.turns ? rate : 0) * axis).norm();
    if (off > kSwingingBodyRoundings * (1 + v.norm()))
      refuse(fmt::format("body '{}' does not move with the rest", body.name));
    misses = std::max(misses, off);
    if (!swing.turns && spins) {
      if (!PrincipalSpin(body, body.angular_velocity).holds()) refuse(fmt::format("body '{}' would tumble", body.name));
      continue;
    }
    if (turned > kSwingingBodyRoundings * (1 + w.norm()))
      refuse(fmt::format("body '{}' does not turn with the rest", body.name));
    misses = std::max(misses, turned);
  }
  return misses;
}

}  // namespace

bool stands(const Scene& scene, int body) { return body == kWorld || scene.bodies[body].fixed; }

ExtendedVec3 standing_point(const Scene& scene, int body, const Vec3& point) {
  if (body == kWorld) return extended(point);
  return extended(scene.bodies[body].position) + extended(scene.bodies[body].orientation) * extended(point);
}

Swing round_axis(int body, const ExtendedVec3& axis, const ExtendedVec3& arm, bool turns) {
  return {body, arm - axis.dot(arm) * axis, axis.cross(arm), turns};
}

std::unique_ptr<Truth> swinging(const Scene& scene, const ExtendedVec3& axis, const std::vector<Swing>& swings,
                                bool spins, const Refuse& refuse, Extended rotor) {
  const Sums sums = sums_of(scene, axis, swings);
  if (std::abs(sums.along) + std::abs(sums.mixed) > kSwingingBodyRoundings * sums.inertia)
    refuse("its inertia about the angle changes as it turns");
  const Extended rate = sums.momentum / sums.inertia;
  const Extended misses = missed(scene, axis, swings, rate, spins, refuse);
  // It would rest at the angle atan2(Q, P) from where it begins.
  const Extended pull = std::hypot(sums.P, sums.Q);
  const PendulumPhase phase(-std::atan2(sums.Q, sums.P), rate, pull / (sums.inertia + rotor));
  return closed_form(scene, [&](const Body& body) -> std::unique_ptr<BodyMotion> {
    const int index = static_cast<int>(&body - scene.bodies.data());
    const auto swing = std::find_if(swings.begin(), swings.end(), [&](const Swing& s) { return s.body == index; });
    if (swing == swings.end()) refuse(fmt::format("body '{}' is no part of it", body.name));
    return std::make_unique<SwingingBody>(body, *swing, axis, phase, misses);
  });
}

}  // namespace rigor::inline truth
