// A ball on a spring that swings along one line against a wall across it (Shaw, Holmes, A periodically forced piecewise
// linear oscillator, J. Sound Vib. 90, 1983). With x from where the spring is at rest, w² = k/m and the wall at x = d >
// 0,
//   x = R cos(wt - phi),   R² = x0² + (v0/w)²,   phi = atan2(v0/w, x0),
// until x = d, at wt = phi - acos(d/R) if the ball is on its way out; there v becomes -e v. Gone from the wall, it
// comes back after wt = 2 pi - 2 acos(d/R): blows cannot crowd, for each takes more than half a period.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cases/truth/closed_form/contact/plane_contact.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

constexpr const char* kSprungBall = "sprung-ball";
constexpr const char* kSprungBallIsFor = "one ball on one spring without damping that swings straight at a plane";

[[noreturn]] void refuse_swing(const std::string& why) {
  throw InputError(fmt::format("the truth '{}' is for {}: {}", kSprungBall, kSprungBallIsFor, why));
}

// The scene as the line sees it: x counts from where the spring is at rest, towards the wall.
struct SwingAtWall {
  ExtendedVec3 middle, line;  // m, in W; unit, in W
  Extended frequency;         // rad/s, w
  Extended wall;              // m, of the ball's centre when it touches: d
  Extended restitution;
  Extended start, speed;  // m and m/s at t = 0
};

int only_one(const Scene& scene, bool fixed, const char* what) {
  int found = kWorld;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (scene.bodies[i].fixed != fixed || (fixed && !scene.bodies[i].collides)) continue;
    if (found != kWorld) refuse_swing(fmt::format("body '{}' is another {}", scene.bodies[i].name, what));
    found = i;
  }
  if (found == kWorld) refuse_swing(fmt::format("there is no {}", what));
  return found;
}

// The vector from the spring's fixed end to the ball's centre, at t = 0.
ExtendedVec3 along_spring(const Scene& scene, int ball) {
  if (scene.springs.size() != 1) refuse_swing(fmt::format("there are {} springs", scene.springs.size()));
  const Spring& spring = scene.springs.front();
  if (spring.damping != 0) refuse_swing("the spring has a damper");
  if (spring.stiffness == 0) refuse_swing("the spring has no stiffness");
  const bool holds_a = spring.a == ball;
  if ((holds_a ? spring.b : spring.a) != kWorld || (!holds_a && spring.b != ball))
    refuse_swing("the spring is not between the ball and the world");
  if (!(holds_a ? spring.point_a : spring.point_b).isZero(0))
    refuse_swing("the spring does not hold the ball at its centre");
  return extended(scene.bodies[ball].position) - extended(holds_a ? spring.point_b : spring.point_a);
}

SwingAtWall find_swing(const Scene& scene) {
  if (!scene.gravity.isZero(0)) refuse_swing("there is gravity");
  const int ball = only_one(scene, false, "body that moves"), wall = only_one(scene, true, "wall");
  const Body& body = scene.bodies[ball];
  const auto* sphere = body.collides ? std::get_if<Sphere>(&*body.shape) : nullptr;
  const auto* plane = std::get_if<Plane>(&*scene.bodies[wall].shape);
  if (!sphere) refuse_swing(fmt::format("body '{}' is no sphere that collides", body.name));
  if (!plane) refuse_swing(fmt::format("body '{}' is no plane", scene.bodies[wall].name));
  if (!body.angular_velocity.isZero(0)) refuse_swing(fmt::format("body '{}' turns", body.name));

  const ExtendedVec3 reach = along_spring(scene, ball), line = -extended(plane->normal).normalized();
  const Spring& spring = scene.springs.front();
  if (!are_along(reach, line) || !are_along(extended(body.velocity), line))
    refuse_swing("the spring, or the ball's velocity, is not square to the wall");
  const Extended length = reach.norm(), outward = reach.dot(line) > 0 ? 1 : -1, rest = spring.rest_length;
  SwingAtWall swing{.middle = extended(body.position) - (length - rest) / length * reach,
                    .line = line,
                    .frequency = std::sqrt(Extended(spring.stiffness) / Extended(body.mass)),
                    .wall = 0,
                    .restitution = scene.contact_law(ball, wall).restitution,
                    .start = outward * (length - rest),
                    .speed = extended(body.velocity).dot(line)};
  swing.wall = -Extended(plane->offset) - swing.middle.dot(line) - Extended(sphere->radius);
  if (!(swing.wall > 0)) refuse_swing("the wall stands where the spring would rest, or presses it");
  if (swing.start > swing.wall + kTouching) refuse_swing("the ball is in the wall");
  if (std::hypot(swing.start, swing.speed / swing.frequency) >= rest)
    refuse_swing("the ball reaches the spring's other end");
  return swing;
}

// The time from one impact to the next.
struct Arc {
  Extended from;  // s
  Extended x, v;  // m and m/s, then
};

class SprungBall final : public BodyMotion {
 public:
  SprungBall(const Body& body, const SwingAtWall& swing, Extended duration)
      : orientation_(body.orientation), swing_(swing) {
    arcs_.push_back({0, swing.start, swing.speed});
    for (Extended t = time_to_wall(arcs_.back()); arcs_.back().from + t <= duration; t = time_to_wall(arcs_.back())) {
      const Arc hit = moved(arcs_.back(), t);
      arcs_.push_back({hit.from, swing.wall, -swing.restitution * hit.v});
    }
  }

  ExtendedState at(Extended t) const override {
    const auto next =
        std::upper_bound(arcs_.begin(), arcs_.end(), t, [](Extended time, const Arc& arc) { return time < arc.from; });
    const Arc& arc = next == arcs_.begin() ? *next : *(next - 1);
    const Arc now = moved(arc, t - arc.from);
    return {swing_.middle + now.x * swing_.line, extended(orientation_), now.v * swing_.line, ExtendedVec3::Zero()};
  }

  // The rounding of the place to double, and of the phase, which each blow hands on.
  double error(double t) const override {
    const Extended widest = widest_of(arcs_.front());
    const auto blows = static_cast<double>(arcs_.size());
    return kEpsilon * static_cast<double>(swing_.middle.norm() + widest) +
           16 * kExtendedEpsilon * blows * static_cast<double>((1 + swing_.frequency * t) * widest);
  }

 private:
  Extended widest_of(const Arc& arc) const { return std::hypot(arc.x, arc.v / swing_.frequency); }

  Arc moved(const Arc& arc, Extended t) const {
    const Extended w = swing_.frequency, c = std::cos(w * t), s = std::sin(w * t);
    return {arc.from + t, arc.x * c + arc.v / w * s, arc.v * c - arc.x * w * s};
  }

  // s, from an arc's start until it next arrives at the wall; infinite if it does not swing so far.
  Extended time_to_wall(const Arc& arc) const {
    const Extended widest = widest_of(arc), turn = 2 * std::numbers::pi_v<Extended>;
    if (!(widest > swing_.wall)) return std::numeric_limits<Extended>::infinity();
    const Extended at_wall = std::acos(swing_.wall / widest);
    if (arcs_.size() > 1) return (turn - 2 * at_wall) / swing_.frequency;
    Extended phase = std::atan2(arc.v / swing_.frequency, arc.x) - at_wall;
    if (phase < 0) phase += turn;
    return phase / swing_.frequency;
  }

  Quat orientation_;
  SwingAtWall swing_;
  std::vector<Arc> arcs_;
};

}  // namespace

TruthRow sprung_ball_truth() {
  return {kSprungBall, "a ball on a spring that strikes a wall, blow by blow, in closed form",
          [](const Scene& scene, double duration) {
            check_needs(scene, kSprungBall, kSprungBallIsFor,
                        {Feature::spring, contact_feature<Plane, Sphere>(), Feature::restitution,
                         Feature::friction_none, Feature::friction_coulomb, Feature::friction_infinite});
            const SwingAtWall swing = find_swing(scene);
            return closed_form(scene,
                               [&](const Body& body) { return std::make_unique<SprungBall>(body, swing, duration); });
          }};
}

}  // namespace rigor::inline truth
