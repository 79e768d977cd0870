#include "core/dynamics/contact/event/persistent_contact.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace rigor {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);
constexpr double kForever = std::numeric_limits<double>::infinity();
// The forces turn with the points that they act at, and so feed back on themselves: by some dt² F / (m r) in a pass.
constexpr int kMostPasses = 50, kFewestPasses = 4;
constexpr double kSettling = 0.1;   // what so many passes leave of a change at most: else a shorter step is quicker
constexpr double kSettled = 1e-12;  // of 1 m/s, the speeds and what the forces make of them in a step
constexpr double kNearlySettled = 1e-10;  // likewise, where roundings leave no more: forces on the verge of sliding
constexpr double kClosed = 1e-13;         // m: a few roundings of a position of one metre
constexpr int kMostMoves = 20;
constexpr double kSliding = 1e-9;        // m/s: ten times what an impact or a stop may leave
constexpr double kStillTouching = 1e-3;  // m: a point that drifted further than this is not in contact any more

Scene with_contact_forces(Scene scene) {
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (scene.bodies[i].collides && !scene.bodies[i].fixed)
      scene.forces.push_back({.body = i, .from = -kForever, .until = kForever});
  }
  return scene;
}

double speed_of(BodyColumns state) {
  double most = 0;
  for (std::size_t i = 0; i < state.size(); ++i) most = std::max(most, state.velocity(i).norm());
  return most;
}

void move(MutableBodyColumns state, std::size_t i, const PoseStep& motion) {
  state.set_position(i, state.position(i) + motion.head<3>());
  const Quat rotation = rotation_by(motion.tail<3>());
  state.set_orientation(i, (rotation * state.orientation(i)).normalized());
  if (state.has_rotation()) state.set_rotation(i, rotation.toRotationMatrix() * state.rotation(i));
}

}  // namespace

PersistentContact::PersistentContact(const Scene& scene, const Integrator& integrator,
                                     const OrientationUpdate* orientation, const Settings& settings,
                                     ContactPoints& contact_points)
    : system_(with_contact_forces(scene)),
      force_of_body_(scene.bodies.size(), kNone),
      stepper_(integrator.make({system_, nullptr, orientation, settings})),
      solver_(system_),
      projection_(system_),
      contact_points_(contact_points),
      wrenches_(scene.bodies.size()),
      old_wrenches_(scene.bodies.size()) {
  const auto& forces = system_.loads.forces();
  for (std::size_t k = scene.forces.size(); k < forces.size(); ++k) force_of_body_[forces[k].body] = k;
}

void PersistentContact::select(BodyColumns state, const std::vector<ContactPoint>& contact_points) {
  old_points_.swap(points_);
  points_.clear();
  for (const ContactPoint& contact : contact_points) {
    const Vec3 u = ConeSolver::velocity_at(contact.cone, state);
    constexpr double kSeparating = 1e-9;  // m/s: ten times what an impact may leave, a hundredth of the least rebound
    if (u.x() > kSeparating) continue;
    PersistentPoint point{contact, contact, u.tail<2>().norm(), 0, Vec3::Zero()};
    const auto old = std::find_if(old_points_.begin(), old_points_.end(),
                                  [&](const PersistentPoint& p) { return p.at_start.same_place(contact); });
    if (old != old_points_.end()) {
      point.force = contact.cone.frame.transpose() * (old->at_start.cone.frame * old->force);
    }
    points_.push_back(point);
  }
}

bool PersistentContact::add_slower_than(double speed, BodyColumns state,
                                        const std::vector<ContactPoint>& contact_points) {
  const std::size_t before = points_.size();
  for (const ContactPoint& contact : contact_points) {
    const bool is_persistent = std::any_of(points_.begin(), points_.end(), [&](const PersistentPoint& point) {
      return point.at_start.same_place(contact);
    });
    const Vec3 u = ConeSolver::velocity_at(contact.cone, state);
    if (!is_persistent && u.x() < speed) points_.push_back({contact, contact, u.tail<2>().norm(), 0, Vec3::Zero()});
  }
  return points_.size() > before;
}

// The points' forces as loads on the bodies. Returns by how much a step of dt moves a surface's velocity otherwise
// than it would have before [m/s].
double PersistentContact::apply_forces(double dt) {
  old_wrenches_.swap(wrenches_);
  wrenches_.assign(system_.size(), Wrench{});
  velocity_scale_ = 0;
  for (const PersistentPoint& point : points_) {
    const ConeConstraint &start = point.at_start.cone, &end = point.at_end.cone;
    const Vec3 force = 0.5 * (start.frame + end.frame) * point.force;
    wrenches_[start.a].force += force;
    wrenches_[start.a].torque += (0.5 * (start.arm_a + end.arm_a)).cross(force);
    wrenches_[start.b].force -= force;
    wrenches_[start.b].torque -= (0.5 * (start.arm_b + end.arm_b)).cross(force);
    const double inverse_mass = std::max(system_.bodies[start.a].inverse_mass, system_.bodies[start.b].inverse_mass);
    velocity_scale_ = std::max(velocity_scale_, dt * inverse_mass * force.norm());
  }
  double largest = 0;
  for (const Collider& collider : contact_points_.colliders()) {
    if (collider.fixed) continue;
    const int i = collider.body;
    system_.loads.set_force(force_of_body_[i], wrenches_[i].force, wrenches_[i].torque);
    const Inertia& body = system_.bodies[i];
    const Vec3 push = body.inverse_mass * (wrenches_[i].force - old_wrenches_[i].force);
    const double turn = body.inverse_inertia_B.norm() * (wrenches_[i].torque - old_wrenches_[i].torque).norm();
    largest = std::max(largest, dt * (push.norm() + turn * collider.bounding_radius));
  }
  return largest;
}

// Brings the end's velocities in line with the laws, and the forces with them.
void PersistentContact::correct(MutableBodyColumns end, double dt) {
  cones_.clear();
  for (PersistentPoint& point : points_) {
    contact_points_.follow(end, point.at_end);
    cones_.push_back(point.at_end.cone);
    cones_.back().impulse = dt * point.force;
  }
  solver_.prepare(end, cones_);
  if (!solver_.solve(end, cones_)) solver_warning_ = "the forces of the touching bodies did not settle";
  for (std::size_t i = 0; i < points_.size(); ++i) {
    points_[i].force = cones_[i].impulse / dt;
    points_[i].slip_at_end = ConeSolver::velocity_at(cones_[i], end).tail<2>().norm();
  }
}

bool PersistentContact::advance(BodyColumns start, MutableBodyColumns end, double t, double dt) {
  solver_warning_.clear();
  for (PersistentPoint& point : points_) point.at_end = point.at_start;
  apply_forces(dt);
  const double speed = speed_of(start);
  double last = kForever;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    copy_columns(start, end);
    stepper_->step(end, t, dt);
    ++passes_;
    if (points_.empty()) return true;
    solver_warning_.clear();  // only of the last pass
    correct(end, dt);
    const double change = apply_forces(dt);
    const double size = 1 + speed + velocity_scale_;
    if (change <= kSettled * size) return true;
    if (pass % kFewestPasses != 0) continue;
    if (!(change < last) && change <= kNearlySettled * size) return true;
    if (!(change < kSettling * last) && change > kNearlySettled * size) break;
    last = change;
  }
  solver_warning_ = "the motion of touching bodies and the forces between them did not settle";
  return false;
}

double PersistentContact::distance_from_sticking() const {
  double least = kForever;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const ConeConstraint& cone = cones_[i];
    if (points_[i].slip_at_start <= kSliding || cone.impulse.x() <= 0) continue;
    if (cone.friction == 0 || std::isinf(cone.friction)) continue;
    const double spare = cone.friction * cone.impulse.x() - cone.impulse.tail<2>().norm();
    least = std::min(least, points_[i].slip_at_end - std::max(0.0, spare) / cone.tangent_effective_mass);
  }
  return least;
}

bool PersistentContact::carries(const ContactPoint& contact) const {
  return std::any_of(points_.begin(), points_.end(), [&](const PersistentPoint& point) {
    return point.at_end.same_place(contact) && point.force.x() > 0;
  });
}

bool PersistentContact::close_gaps(MutableBodyColumns state, const std::vector<std::pair<int, int>>& pairs,
                                   Closing which) {
  double before = kForever;
  for (int k = 0; k < kMostMoves; ++k) {
    open_.clear(), targets_.clear();
    contact_points_.find(state, pairs, kStillTouching, open_);
    double widest = 0;
    for (const ContactPoint& contact : open_) {
      const bool is_carrying = which == Closing::all && carries(contact);
      if (!(contact.gap < 0 || is_carrying)) continue;
      widest = std::max(widest, std::abs(contact.gap));
      add_target(contact.cone, 0, -contact.gap, is_carrying);
    }
    // Where it does not fall by much any more, it is rounding, or there is no place for all bodies.
    if (!(widest > kClosed) || widest > 0.5 * before) return k > 0;
    before = widest;
    const std::vector<PoseStep>& motion = projection_.project(state, targets_);
    for (std::size_t i = 0; i < motion.size(); ++i) {
      if (!motion[i].isZero(0)) move(state, i, motion[i]);
    }
  }
  return true;
}

void PersistentContact::stop_carrying_points(MutableBodyColumns state) {
  targets_.clear();
  for (const PersistentPoint& point : points_) {
    ContactPoint now = point.at_end;
    if (!(point.force.x() > 0) || !contact_points_.follow(state, now) || now.gap > kStillTouching) continue;
    const Vec3 u = ConeSolver::velocity_at(now.cone, state);
    add_target(now.cone, 0, -u.x(), true);
    if (point.slip_at_end > kSliding || now.cone.friction == 0) continue;
    add_target(now.cone, 1, -u.y(), true);
    add_target(now.cone, 2, -u.z(), true);
  }
  const std::vector<PoseStep>& motion = projection_.project(state, targets_);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (motion[i].isZero(0)) continue;
    state.set_velocity(i, state.velocity(i) + motion[i].head<3>());
    state.set_angular_velocity(i, state.angular_velocity(i) + motion[i].tail<3>());
  }
}

void PersistentContact::add_target(const ConeConstraint& cone, int axis, double amount, bool bilateral) {
  targets_.push_back({.a = cone.a,
                      .b = cone.b,
                      .arm_a = cone.arm_a,
                      .arm_b = cone.arm_b,
                      .direction = cone.frame.col(axis),
                      .amount = amount,
                      .bilateral = bilateral});
}

}  // namespace rigor
