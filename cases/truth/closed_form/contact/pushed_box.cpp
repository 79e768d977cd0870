// A box on a level plane, pushed through its centre by a constant level force F, with balls lying on it. Each ball
// rolls on the moving box without slipping: friction gives it the acceleration a k/(1 + k), k = I/(m r²), 2/7 of the
// box's for a solid ball. So the box, with mass M and the weight of all on the plane,
//     a (M + sum m_i k_i/(1 + k_i)) = F - mu g (M + sum m_i)
// This is the rolling test of SimBenchmark (Kang and Hwangbo, 2018): 10 kg, 25 balls of 1 kg, 150 N, mu = 0.4 under the
// box. It gives 0.7385 m/s² for the box and 0.2110 m/s² for the balls. With no more force than static friction bears,
// nothing moves.
#include <fmt/format.h>

#include <cmath>

#include "cases/truth/closed_form/contact/plane_contact.h"
#include "cases/truth/closed_form/phased_motion.h"

namespace rigor::inline truth {
namespace {

constexpr const char* kPushed = "pushed";
constexpr const char* kPushedIsFor =
    "one box on a level plane, pushed level through its centre, with balls at rest on it";

class PushedBox {
 public:
  PushedBox(const Scene& scene, double duration)
      : scene_(scene), ground_(scene, kPushed, kPushedIsFor), duration_(duration), box_(find_box()) {
    const Body& box = scene.bodies[box_];
    if (ground_.along().norm() > 0) ground_.refuse(box, "is on a slope");
    check_at_rest(box);
    if (std::abs(ground_.gap_under(box)) > kTouching) ground_.refuse(box, "does not touch the plane");
    find_up_axis();
    find_acceleration();
    for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
      if (is_ball(i)) check_ball(i);
    }
    check_that_it_stands();
  }

  std::unique_ptr<BodyMotion> motion_of(const Body& body) const {
    const int index = static_cast<int>(&body - scene_.bodies.data());
    Phase phase{0, {extended(body.position), extended(body.orientation), ExtendedVec3::Zero(), ExtendedVec3::Zero()}};
    if (index == box_) {
      phase.acceleration = acceleration_;
    } else {
      const Extended k = ratio(body);
      phase.acceleration = acceleration_ * (k / (1 + k));
      // Friction a k/(1 + k) at the lowest point turns it: -n x a / ((1 + k) r).
      phase.angular_acceleration = -ground_.normal().cross(acceleration_) / ((1 + k) * radius(body));
    }
    return std::make_unique<PhasedMotion>(std::vector<Phase>{phase}, widest_gap_);
  }

 private:
  bool is_ball(int i) const { return i != box_ && !scene_.bodies[i].fixed; }
  static Extended radius(const Body& ball) { return std::get<Sphere>(*ball.shape).radius; }
  static Extended ratio(const Body& ball) { return ball.inertia(0, 0) / (ball.mass * radius(ball) * radius(ball)); }
  ExtendedVec3 half() const { return extended(std::get<Box>(*scene_.bodies[box_].shape).size) / 2; }
  ExtendedVec3 in_box(const ExtendedVec3& v) const { return extended(scene_.bodies[box_].orientation).conjugate() * v; }

  int find_box() const {
    int found = kWorld;
    for (int i = 0; i < static_cast<int>(scene_.bodies.size()); ++i) {
      const Body& body = scene_.bodies[i];
      if (body.fixed) continue;
      if (!body.collides) ground_.refuse(body, "does not collide");
      if (std::holds_alternative<Sphere>(*body.shape)) continue;
      if (!std::holds_alternative<Box>(*body.shape) || found != kWorld)
        ground_.refuse(body, "is neither the box nor a ball");
      found = i;
    }
    if (found == kWorld) ground_.refuse(scene_.bodies[ground_.body()], "has no box on it");
    return found;
  }

  void check_at_rest(const Body& body) const {
    if (!body.velocity.isZero(0) || !body.angular_velocity.isZero(0)) ground_.refuse(body, "moves at the start");
  }

  void find_up_axis() {
    const ExtendedVec3 up = in_box(ground_.normal());
    up.cwiseAbs().maxCoeff(&up_);
    if (std::abs(up[up_]) < 1 - 1e-12L) ground_.refuse(scene_.bodies[box_], "does not lie on a face");
  }

  ExtendedVec3 push() const {
    ExtendedVec3 sum = ExtendedVec3::Zero();
    for (const TimedForce& force : scene_.forces) {
      const Body& body = scene_.bodies[force.body];
      const bool is_constant = force.from == 0 && force.until >= duration_ && force.torque.isZero(0);
      if (force.body != box_ || !is_constant || !force.point.isZero(0) ||
          ground_.normal().dot(extended(force.force)) != 0)
        ground_.refuse(body, "has a force that is not a constant level push through the box's centre");
      sum += extended(force.force);
    }
    return sum;
  }

  void find_acceleration() {
    const Body& box = scene_.bodies[box_];
    Extended weight = box.mass, inertia = box.mass;
    for (int i = 0; i < static_cast<int>(scene_.bodies.size()); ++i) {
      if (!is_ball(i)) continue;
      const Body& ball = scene_.bodies[i];
      weight += ball.mass, inertia += ball.mass * ratio(ball) / (1 + ratio(ball));
    }
    const ExtendedVec3 force = push();
    const ContactLaw& law = scene_.contact_law(box_, ground_.body());
    normal_force_ = weight * ground_.pressing();
    const bool sticks = force.norm() <= law.sticking_friction() * normal_force_;
    friction_force_ = sticks ? force.norm() : law.friction * normal_force_;
    acceleration_.setZero();
    if (!sticks) acceleration_ = force.normalized() * ((force.norm() - friction_force_) / inertia);
  }

  void check_ball(int index) {
    const Body& ball = scene_.bodies[index];
    check_at_rest(ball);
    const double I = ball.inertia(0, 0);
    if ((ball.inertia - I * Mat3::Identity()).norm() > 4 * kEpsilon * I)
      ground_.refuse(ball, "has an inertia that is not the same about every axis");
    const ExtendedVec3 start = in_box(extended(ball.position) - extended(scene_.bodies[box_].position));
    const ExtendedVec3 up = in_box(ground_.normal());
    const Extended gap = start[up_] * (up[up_] > 0 ? 1 : -1) - half()[up_] - radius(ball);
    if (std::abs(gap) > kTouching) ground_.refuse(ball, "does not lie on the box");
    widest_gap_ = std::max(widest_gap_, static_cast<double>(std::abs(gap)));
    const Extended k = ratio(ball), needed = acceleration_.norm() * k / (1 + k);
    if (needed > scene_.contact_law(index, box_).sticking_friction() * ground_.pressing())
      ground_.refuse(ball, "would slip on the box");
    const Extended moved = -static_cast<Extended>(duration_) * duration_ / 2 / (1 + k);
    for (const ExtendedVec3& at : {start, ExtendedVec3(start + moved * in_box(acceleration_))}) {
      for (int axis = 0; axis < 3; ++axis) {
        if (axis != up_ && std::abs(at[axis]) > half()[axis]) ground_.refuse(ball, "would roll off the box");
      }
    }
    for (int other = 0; other < index; ++other) {
      if (!is_ball(other)) continue;
      const Body& b = scene_.bodies[other];
      const bool go_alike = std::abs(ratio(b) - k) <= 8 * static_cast<Extended>(kEpsilon);
      if (!go_alike || (b.position - ball.position).norm() <= static_cast<double>(radius(b) + radius(ball)))
        ground_.refuse(ball, fmt::format("could touch '{}'", b.name));
    }
  }

  // The plane's pressure must hold the moment of all friction, and of the balls off the middle, from within the face;
  // and the balls must lie evenly on both sides of the push.
  void check_that_it_stands() const {
    Extended moment = half()[up_] * (friction_force_ + acceleration_.norm() * normal_force_ / ground_.pressing());
    ExtendedVec3 off = ExtendedVec3::Zero();
    Extended size = 0;
    for (int i = 0; i < static_cast<int>(scene_.bodies.size()); ++i) {
      if (!is_ball(i)) continue;
      const Body& ball = scene_.bodies[i];
      const ExtendedVec3 arm = extended(ball.position) - extended(scene_.bodies[box_].position);
      off += ball.mass * ground_.pressing() * arm, size += ball.mass * ground_.pressing() * arm.norm();
      moment += ball.mass * ground_.pressing() * acceleration_.norm() * duration_ * duration_ / 2;
    }
    Extended least = std::numeric_limits<Extended>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (axis != up_) least = std::min(least, half()[axis]);
    }
    if (ground_.part_along(off).norm() + moment > least * normal_force_)
      ground_.refuse(scene_.bodies[box_], "might tip over");
    // Friction above and below it acts where the balls press: beside the push it would turn the box.
    const Extended beside = std::abs(ground_.normal().cross(push()).dot(off));
    if (beside > 64 * static_cast<Extended>(kEpsilon) * size * push().norm())
      ground_.refuse(scene_.bodies[box_], "is loaded to one side of its push, which would turn it");
  }

  const Scene& scene_;
  Ground ground_;
  double duration_;
  int box_, up_ = 2;
  double widest_gap_ = 0;
  ExtendedVec3 acceleration_;                       // m/s², of the box
  Extended normal_force_ = 0, friction_force_ = 0;  // N, under the box
};

std::unique_ptr<Truth> make_pushed(const Scene& scene, double duration) {
  check_needs(scene, kPushed, kPushedIsFor,
              {contact_feature<Box, Plane>(), contact_feature<Box, Sphere>(), contact_feature<Plane, Sphere>(),
               contact_feature<Sphere, Sphere>(), Feature::friction_none, Feature::friction_coulomb,
               Feature::friction_infinite, Feature::static_friction, Feature::restitution, Feature::timed_force});
  const PushedBox pushed(scene, duration);
  return closed_form(scene, [&](const Body& body) { return pushed.motion_of(body); });
}

}  // namespace

TruthRow pushed_truth() {
  return {kPushed, "a box pushed over a level plane with balls rolling on it, in closed form", make_pushed};
}

}  // namespace rigor::inline truth
