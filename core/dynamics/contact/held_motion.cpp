#include "core/dynamics/contact/held_motion.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace rigor {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostPasses = 50;
constexpr double kSettled = 1e-12;  // of 1 m/s and the speeds; the position is then right to this times dt
constexpr double kClosed = 1e-13;   // m: a few roundings of a position of one metre
constexpr int kMostMoves = 100;
constexpr double kSliding = 1e-9;   // m/s: ten times what an impact or a stop may leave
constexpr double kTouching = 1e-3;  // m: a held point that drifted further than this is not held any more

Scene with_contact_forces(Scene scene) {
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (scene.bodies[i].collides && !scene.bodies[i].fixed)
      scene.forces.push_back({.body = i, .from = -kInfinity, .until = kInfinity});
  }
  return scene;
}

double speed_of(BodyColumns state) {
  double most = 0;
  for (std::size_t i = 0; i < state.size(); ++i) most = std::max(most, state.velocity(i).norm());
  return most;
}

}  // namespace

HeldMotion::HeldMotion(const Scene& scene, const Integrator& integrator, const OrientationUpdate* orientation,
                       const Settings& settings, Touches& touches)
    : system_(with_contact_forces(scene)),
      force_of_body_(scene.bodies.size(), kNone),
      stepper_(integrator.make({system_, nullptr, orientation, settings})),
      solver_(system_),
      touches_(touches),
      wrenches_(scene.bodies.size()),
      old_wrenches_(scene.bodies.size()) {
  const auto& forces = system_.loads.forces();
  for (std::size_t k = scene.forces.size(); k < forces.size(); ++k) force_of_body_[forces[k].body] = k;
}

void HeldMotion::hold(BodyColumns state, const std::vector<Touch>& touches) {
  old_points_.swap(points_);
  points_.clear();
  for (const Touch& touch : touches) {
    const Vec3 u = ConeSolver::velocity_at(touch.cone, state);
    constexpr double kParting = 1e-9;  // m/s: ten times what an impact may leave, a hundredth of the least rebound
    if (u.x() > kParting) continue;
    HeldPoint point{touch, touch, u.tail<2>().norm(), 0, Vec3::Zero()};
    const auto old = std::find_if(old_points_.begin(), old_points_.end(),
                                  [&](const HeldPoint& p) { return p.at_start.same_place(touch); });
    if (old != old_points_.end()) {
      point.force = touch.cone.frame.transpose() * (old->at_start.cone.frame * old->force);
    }
    points_.push_back(point);
  }
}

bool HeldMotion::hold_slower_than(double speed, BodyColumns state, const std::vector<Touch>& touches) {
  const std::size_t before = points_.size();
  for (const Touch& touch : touches) {
    const bool is_held = std::any_of(points_.begin(), points_.end(),
                                     [&](const HeldPoint& point) { return point.at_start.same_place(touch); });
    const Vec3 u = ConeSolver::velocity_at(touch.cone, state);
    if (!is_held && u.x() < speed) points_.push_back({touch, touch, u.tail<2>().norm(), 0, Vec3::Zero()});
  }
  return points_.size() > before;
}

// The held points' forces as loads on the bodies. Returns by how much a step of dt moves a surface's velocity otherwise
// than it would have before [m/s].
double HeldMotion::apply_forces(double dt) {
  old_wrenches_.swap(wrenches_);
  wrenches_.assign(system_.size(), Wrench{});
  for (const HeldPoint& point : points_) {
    const ConePoint &start = point.at_start.cone, &end = point.at_end.cone;
    const Vec3 force = 0.5 * (start.frame + end.frame) * point.force;
    wrenches_[start.a].force += force;
    wrenches_[start.a].torque += (0.5 * (start.arm_a + end.arm_a)).cross(force);
    wrenches_[start.b].force -= force;
    wrenches_[start.b].torque -= (0.5 * (start.arm_b + end.arm_b)).cross(force);
  }
  double largest = 0;
  for (const Collider& collider : touches_.colliders()) {
    if (collider.fixed) continue;
    const int i = collider.body;
    system_.loads.set_force(force_of_body_[i], wrenches_[i].force, wrenches_[i].torque);
    const Inertia& body = system_.bodies[i];
    const Vec3 push = body.inverse_mass * (wrenches_[i].force - old_wrenches_[i].force);
    const double turn = body.inverse_inertia_B.norm() * (wrenches_[i].torque - old_wrenches_[i].torque).norm();
    largest = std::max(largest, dt * (push.norm() + turn * collider.reach));
  }
  return largest;
}

// Brings the end's velocities in line with the laws, and the forces with them.
void HeldMotion::correct(MutableBodyColumns end, double dt) {
  cones_.clear();
  for (HeldPoint& point : points_) {
    touches_.follow(end, point.at_end);
    cones_.push_back(point.at_end.cone);
    cones_.back().impulse = dt * point.force;
  }
  solver_.prepare(end, cones_);
  if (!solver_.solve(end, cones_)) complaint_ = "the forces of the touching bodies did not settle";
  for (std::size_t i = 0; i < points_.size(); ++i) {
    points_[i].force = cones_[i].impulse / dt;
    points_[i].slip_at_end = ConeSolver::velocity_at(cones_[i], end).tail<2>().norm();
  }
}

void HeldMotion::advance(BodyColumns start, MutableBodyColumns end, double t, double dt) {
  complaint_.clear();
  for (HeldPoint& point : points_) point.at_end = point.at_start;
  const double settled = kSettled * (1 + speed_of(start));
  apply_forces(dt);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    copy_columns(start, end);
    stepper_->step(end, t, dt);
    if (points_.empty()) return;
    correct(end, dt);
    if (!(apply_forces(dt) > settled)) return;
  }
  complaint_ = "the motion of touching bodies and the forces between them did not settle";
}

double HeldMotion::distance_from_sticking() const {
  double least = kInfinity;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const ConePoint& cone = cones_[i];
    if (points_[i].slip_at_start <= kSliding || cone.impulse.x() <= 0) continue;
    if (cone.friction == 0 || std::isinf(cone.friction)) continue;
    const double spare = cone.friction * cone.impulse.x() - cone.impulse.tail<2>().norm();
    least = std::min(least, points_[i].slip_at_end - std::max(0.0, spare) / cone.tangent_pace);
  }
  return least;
}

bool HeldMotion::carries(const Touch& touch) const {
  return std::any_of(points_.begin(), points_.end(),
                     [&](const HeldPoint& point) { return point.at_end.same_place(touch) && point.force.x() > 0; });
}

// Along the normal, each body by as much as an impulse there would move it.
void HeldMotion::move_apart(MutableBodyColumns state, const Touch& touch) const {
  const Vec3 n = touch.cone.frame.col(0);
  double give = 0;  // 1/kg, of the two bodies at the point
  const auto turn_of = [&](int body, const Vec3& arm) {
    return angular_velocity_of(system_.bodies[body], state.rotation(body), arm.cross(n));
  };
  const Vec3 turn_a = turn_of(touch.cone.a, touch.cone.arm_a), turn_b = turn_of(touch.cone.b, touch.cone.arm_b);
  give += system_.bodies[touch.cone.a].inverse_mass + n.dot(turn_a.cross(touch.cone.arm_a));
  give += system_.bodies[touch.cone.b].inverse_mass + n.dot(turn_b.cross(touch.cone.arm_b));
  const auto move = [&](int body, const Vec3& turn, double amount) {
    if (system_.bodies[body].fixed) return;
    state.set_position(body, state.position(body) + amount * system_.bodies[body].inverse_mass * n);
    const Quat rotation = rotation_by(amount * turn);
    state.set_orientation(body, (rotation * state.orientation(body)).normalized());
    if (state.has_rotation()) state.set_rotation(body, rotation.toRotationMatrix() * state.rotation(body));
  };
  move(touch.cone.a, turn_a, -touch.gap / give);
  move(touch.cone.b, turn_b, touch.gap / give);
}

void HeldMotion::close_gaps(MutableBodyColumns state, const std::vector<std::pair<int, int>>& pairs) {
  for (int k = 0; k < kMostMoves; ++k) {
    open_.clear();
    touches_.find(state, pairs, kTouching, open_);
    double widest = 0;
    for (const Touch& touch : open_) {
      Touch now = touch;
      // Moved by its neighbours since it was found.
      if (!touches_.follow(state, now) || !(now.gap < 0 || carries(touch))) continue;
      widest = std::max(widest, std::abs(now.gap));
      if (std::abs(now.gap) > kClosed) move_apart(state, now);
    }
    if (!(widest > kClosed)) return;
  }
}

}  // namespace rigor
