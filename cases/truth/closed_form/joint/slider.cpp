// A body on a slider, with a spring and damper and gravity along the rail n:
//   (m + armature) s'' = m g . n - k (s - rest) - c s',   s the way since t = 0.
// The spring and damper are those of the joint, or of a spring along the rail from its centre to a fixed point. With a
// spring it oscillates about rest + m g.n/k (damped_oscillation.h). Without a spring it falls along the rail: s = v0 t
// + g.n t²/2, or with a damper s = u t + (v0 - u) (1 - e^(-c t/m)) m/c, u = m g.n/c. It does not rotate (Landau and
// Lifshitz, Mechanics, 3rd ed., section 25).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/truth/closed_form/joint/swinging_body.h"
#include "cases/truth/closed_form/smooth/damped_oscillation.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_slider(const std::string& why) {
  throw InputError("the truth 'slider' is for one body on a slider that stands still: " + why);
}

// The loads along the rail.
struct Sprung {
  Extended stiffness = 0, damping = 0, rest = 0;              // N/m, N s/m; m, a way
  Extended end = -std::numeric_limits<Extended>::infinity();  // m, a way: where a spring's other end is
};

Sprung sprung_by(const Scene& scene, const Joint& joint, int index, const ExtendedVec3& rail) {
  if (scene.springs.empty()) return {joint.stiffness, joint.damping, joint.rest};
  const Spring& spring = scene.springs[0];
  if (scene.springs.size() > 1 || joint.stiffness != 0 || joint.damping != 0)
    refuse_slider("it has more than one spring");
  const bool is_a = spring.a == index;
  if (stands(scene, spring.a) == stands(scene, spring.b))
    refuse_slider("the spring is not between it and what stands still");
  if (!(is_a ? spring.point_a : spring.point_b).isZero(0)) refuse_slider("the spring does not hold it at its centre");
  const ExtendedVec3 other =
      is_a ? standing_point(scene, spring.b, spring.point_b) : standing_point(scene, spring.a, spring.point_a);
  const ExtendedVec3 from = extended(scene.bodies[index].position) - other;
  const Extended along = from.dot(rail);
  constexpr Extended kSliderRoundings = 64 * static_cast<Extended>(kEpsilon);  // of the scene's numbers
  if (along == 0 || from.cross(rail).norm() > kSliderRoundings * from.norm())
    refuse_slider("the spring is not along the rail");
  return {spring.stiffness, spring.damping, (along < 0 ? -1 : 1) * Extended(spring.rest_length) - along, -along};
}

class Sliding final : public BodyMotion {
 public:
  Sliding(const Body& body, const Sprung& sprung, const ExtendedVec3& rail, const ExtendedVec3& gravity,
          Extended armature, double duration)
      : start_(extended(body.position)), orientation_(extended(body.orientation)), rail_(rail) {
    const Extended mass = Extended(body.mass) + armature;
    pull_ = Extended(body.mass) / mass * gravity.dot(rail_), velocity_ = extended(body.velocity).dot(rail_),
    decay_ = sprung.damping / (2 * mass);
    if (sprung.stiffness == 0) return;
    moving_.decay = decay_, moving_.square = sprung.stiffness / mass, moving_.velocity = velocity_;
    middle_ = sprung.rest + pull_ / moving_.square, moving_.start = -middle_;
    if (!std::isfinite(sprung.end)) return;
    for (Extended t : moving_.turns()) {
      t = std::clamp<Extended>(t, 0, duration);
      if ((middle_ + moving_.at(t).offset) * -sprung.end <= -sprung.end * sprung.end)
        refuse_slider("it passes the spring's other end, where the force jumps");
    }
  }

  ExtendedState at(Extended t) const override {
    const DampedOscillation::Along along = moving_.square > 0 ? moving_.at(t) : without_spring(t);
    return {start_ + (middle_ + along.offset) * rail_, orientation_, along.velocity * rail_, ExtendedVec3::Zero()};
  }

  double error(double t) const override {
    const bool is_sprung = moving_.square > 0;
    const Extended way =
        is_sprung ? std::abs(middle_) + moving_.swing() : std::abs(velocity_) * t + std::abs(pull_) * t * t;
    return kEpsilon * static_cast<double>(start_.norm() + way) +
           static_cast<double>(is_sprung ? moving_.error(t) : Extended(0));
  }

 private:
  DampedOscillation::Along without_spring(Extended t) const {
    if (decay_ == 0) return {velocity_ * t + pull_ * t * t / 2, velocity_ + pull_ * t};
    const Extended last = pull_ / (2 * decay_), gone = -std::expm1(-2 * decay_ * t);
    return {last * t + (velocity_ - last) * gone / (2 * decay_), velocity_ + (last - velocity_) * gone};
  }

  ExtendedVec3 start_;
  ExtendedQuat orientation_;
  ExtendedVec3 rail_;                             // unit, in W
  Extended pull_ = 0, velocity_ = 0, decay_ = 0;  // m/s²; m/s at t = 0; 1/s
  Extended middle_ = 0;                           // m, where it would rest
  DampedOscillation moving_;                      // about there; with a spring
};

std::unique_ptr<Truth> make_slider(const Scene& scene, double duration) {
  check_needs(scene, "slider", "one body on a slider",
              {joint_feature<SliderJoint>(), Feature::armature, Feature::joint_spring, Feature::joint_damper,
               Feature::joints_with_dampers, Feature::spring});
  if (scene.joints.size() != 1) refuse_slider(fmt::format("there are {} joints", scene.joints.size()));
  const Joint& joint = scene.joints[0];
  if (stands(scene, joint.a) == stands(scene, joint.b))
    refuse_slider("the joint is not between it and what stands still");
  const int index = stands(scene, joint.a) ? joint.b : joint.a;
  const auto moving = std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return !b.fixed; });
  if (moving != 1) refuse_slider(fmt::format("{} bodies move", moving));
  // A spring of the joint pushes b along the rail, and so a the other way.
  const ExtendedVec3 rail = (index == joint.b ? 1 : -1) * extended(std::get<SliderJoint>(joint.type).axis).normalized();
  const Body& body = scene.bodies[index];
  constexpr double kSliderRoundings = 64 * kEpsilon;  // of the scene's numbers
  if (body.velocity.cross(rail.cast<double>()).norm() > kSliderRoundings * (1 + body.velocity.norm()))
    refuse_slider("its velocity is not along the rail");
  if (body.angular_velocity.norm() > kSliderRoundings) refuse_slider("it turns");
  return closed_form(scene, [&](const Body& one) {
    return std::make_unique<Sliding>(one, sprung_by(scene, joint, index, rail), rail, extended(scene.gravity),
                                     joint.armature, duration);
  });
}

}  // namespace

TruthRow slider_truth() {
  return {"slider", "a body on a slider with its spring, damper and gravity, in closed form", make_slider};
}

}  // namespace rigor::inline truth
