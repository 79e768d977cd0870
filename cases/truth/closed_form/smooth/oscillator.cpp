// A body on one spring and damper through its centre of mass, moving along the spring's line:
//   m r'' = -k (r - rest) - c r' + m g,   r the distance from the fixed end.
// With s = r - rest - m g / k, decay = c / 2m and w0² = k / m it is damped_oscillation.h's. The spring has no torque
// about the centre of mass.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/truth/closed_form/smooth/damped_oscillation.h"
#include "cases/truth/closed_form/smooth/principal_spin.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_oscillator(const std::string& why) {
  throw InputError(
      "the truth 'oscillator' is for one body on one spring through its centre of mass, moving along the spring: " +
      why);
}

// The moving body, and the fixed end of its spring.
struct Hanging {
  int body;
  ExtendedVec3 anchor;  // m, in W
  ExtendedVec3 line;    // unit, in W, from the anchor to the body
  Extended misses = 0;  // rad, by which velocity and gravity miss the line
};

// The sine of the angle from the line.
Extended miss(const ExtendedVec3& v, const ExtendedVec3& line) {
  return v.isZero(0) ? 0 : v.cross(line).norm() / v.norm();
}

int the_moving_body(const Scene& scene) {
  int moving = kWorld;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (scene.bodies[i].fixed) continue;
    if (moving != kWorld) refuse_oscillator(fmt::format("body '{}' moves as well", scene.bodies[i].name));
    moving = i;
  }
  if (moving == kWorld) refuse_oscillator("no body moves");
  return moving;
}

ExtendedVec3 place(const Scene& scene, int body, const Vec3& point) {
  if (body == kWorld) return extended(point);
  return extended(scene.bodies[body].position) + extended(scene.bodies[body].orientation) * extended(point);
}

Hanging find_hanging(const Scene& scene) {
  const int moving = the_moving_body(scene);
  if (scene.springs.size() != 1) refuse_oscillator(fmt::format("there are {} springs", scene.springs.size()));
  const Spring& spring = scene.springs[0];
  if ((spring.a == moving) == (spring.b == moving))
    refuse_oscillator("the spring is not between it and what stands still");
  const bool holds_a = spring.a == moving;
  const Vec3& hook = holds_a ? spring.point_a : spring.point_b;
  if (!hook.isZero(0))
    refuse_oscillator(fmt::format("the spring holds it at ({}, {}, {})", hook.x(), hook.y(), hook.z()));
  if (spring.stiffness == 0) refuse_oscillator("the spring has no stiffness");

  const Body& body = scene.bodies[moving];
  Hanging hanging{moving, {}, ExtendedVec3::UnitX()};
  hanging.anchor = holds_a ? place(scene, spring.b, spring.point_b) : place(scene, spring.a, spring.point_a);
  const ExtendedVec3 offset = extended(body.position) - hanging.anchor, velocity = extended(body.velocity),
                     gravity = extended(scene.gravity);
  for (const ExtendedVec3& along : {gravity, velocity, offset}) {  // the last that is not zero
    if (!along.isZero(0)) hanging.line = along.normalized();
  }
  constexpr Extended kRoundings = 8 * static_cast<Extended>(kEpsilon);  // of the scene's numbers
  if (miss(velocity, hanging.line) > kRoundings) refuse_oscillator("its velocity is not along the spring");
  if (miss(gravity, hanging.line) > kRoundings) refuse_oscillator("gravity is not along the spring");
  hanging.misses = std::max(miss(velocity, hanging.line), miss(gravity, hanging.line));
  return hanging;
}

class Oscillator final : public BodyMotion {
 public:
  Oscillator(const Scene& scene, const Hanging& hanging, double duration)
      : Oscillator(scene, scene.bodies[hanging.body], scene.springs[0], hanging) {
    const Spring& spring = scene.springs[0];
    const Extended least = nearest(duration);
    if (spring.rest_length == 0) return;
    if (least <= 0) refuse_oscillator("it passes through the spring's other end, where the force jumps");
    const Extended pressed = std::max<Extended>(0, spring.rest_length - least);
    buckling_ = std::sqrt(moving_.square * pressed / least);
  }

  ExtendedState at(Extended t) const override {
    const DampedOscillation::Along along = moving_.at(t);
    return {hanging_.anchor + (middle_ + along.offset) * hanging_.line, spin_.orientation(w_.norm() * t),
            along.velocity * hanging_.line, w_};
  }

  // The rounding to double of the largest coordinate, and of a phase. If the scene's rounding misses the line, the body
  // leaves it, faster and faster while the spring is compressed.
  double error(double t) const override {
    const Extended speed = moving_.swing() * std::sqrt(moving_.square);
    const Extended farthest = hanging_.anchor.norm() + std::abs(middle_) + moving_.swing();
    const Extended beside =
        hanging_.misses == 0 ? 0 : hanging_.misses * (farthest + speed * t) * std::cosh(buckling_ * t);
    return kEpsilon * static_cast<double>(farthest) + static_cast<double>(moving_.error(t) + beside) +
           spin_.error(static_cast<double>(w_.norm()) * t);
  }

 private:
  Oscillator(const Scene& scene, const Body& body, const Spring& spring, const Hanging& hanging)
      : hanging_(hanging), spin_(body, body.angular_velocity), w_(extended(body.angular_velocity)) {
    moving_.decay = spring.damping / (2 * extended_mass(body)), moving_.square = spring.stiffness / extended_mass(body);
    if (!spin_.holds()) refuse_oscillator(fmt::format("body '{}' would tumble", body.name));
    middle_ = spring.rest_length + extended(scene.gravity).dot(hanging.line) / moving_.square;
    moving_.start = (extended(body.position) - hanging.anchor).dot(hanging.line) - middle_;
    moving_.velocity = extended(body.velocity).dot(hanging.line);
  }
  static Extended extended_mass(const Body& body) { return body.mass; }

  // The least distance [m] from the fixed end, in [0, duration].
  Extended nearest(double duration) const {
    Extended least = middle_ + std::min(moving_.start, moving_.at(duration).offset);
    for (const Extended t : moving_.turns()) {
      if (t > 0 && t < duration) least = std::min(least, middle_ + moving_.at(t).offset);
    }
    return least;
  }

  Hanging hanging_;
  PrincipalSpin spin_;
  ExtendedVec3 w_;            // rad/s, in W
  Extended middle_ = 0;       // m from the anchor: where it would rest
  DampedOscillation moving_;  // from there, away from the anchor
  Extended buckling_ = 0;     // 1/s, the rate at which it leaves the line at most
};

}  // namespace

TruthRow oscillator_truth() {
  return {"oscillator", "a body on a spring and damper through its centre of mass, in closed form",
          [](const Scene& scene, double duration) {
            check_needs(scene, "oscillator", "a body on a spring", {Feature::spring});
            const Hanging hanging = find_hanging(scene);
            return closed_form(scene,
                               [&](const Body&) { return std::make_unique<Oscillator>(scene, hanging, duration); });
          }};
}

}  // namespace rigor::inline truth
