#include "core/dynamics/contact/event/persistent/persistent_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/engine/option_values.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
// In the scene's units.
constexpr double kBeginning = 1e-11;  // of speed: a slip that begins may go back by this, which is rounding
constexpr double kLeastSize = 1e-7;   // of acceleration: weaker forces are roundings
constexpr double kStill = 1e-15;      // of speed, and of the speeds themselves: roundings of a velocity of zero
constexpr double kPulling = 2e-9;     // of the forces: twice the limit of the choice
constexpr long kAskedInStep = 64;     // times for forces, by a method that need not divide its step much
constexpr double kReversed = 0.1;     // of the fastest slip at any stage: stages differ by less
constexpr double kMostOfStop = 100;   // of the fastest point that is stopped: the change of any body's speed
constexpr double kSlow = 10;          // of the restitution threshold: a contact that parts no faster stays

constexpr const char* kAdaptive = "dormand-prince";

// An integrator that asks for forces at its stages, of no lower order than `own`.
const Integrator& integrator_in_contact(const Integrator& own) {
  if (own.holds_at_stages) return own;
  return integrator(own.order <= 4 ? "rkmk4" : kAdaptive);
}

}  // namespace

PersistentContact::PersistentContact(const ContactParts& parts, ContactPoints& contact_points)
    : system_(parts.system),
      joints_(parts.joints),
      motors_(parts.motors),
      in_contact_(rigor::integrator_in_contact(parts.integrator)),
      contact_points_(contact_points),
      persistent_(system_, contact_points, parts.joints),
      modes_(system_, persistent_, parts.joints),
      free_stepper_(parts.integrator.make({system_, nullptr, parts.orientation, parts.settings})),
      contact_stepper_(
          in_contact_.make({system_, nullptr, parts.orientation, parts.settings, nullptr, nullptr, &persistent_})),
      adaptive_stepper_(integrator(kAdaptive).make(
          {system_, nullptr, nullptr, {kAdaptive, {}, parts.settings.track}, nullptr, nullptr, &persistent_})),
      loads_(system_),
      projection_(system_, parts.joints),
      gaps_(system_, parts.joints, contact_points, projection_),
      restitution_threshold_(restitution_threshold(parts.settings, contact_points.scales())),
      rests_(parts.system.size(), 0) {}

void PersistentContact::let_go_motors(BodyColumns state) {
  if (motors_) motors_->let_go(state);
}

// The effort of a motor depends on the forces at the points, and the active points depend on the effort. The points are
// therefore determined again for each choice of the motors.
bool PersistentContact::select(MutableBodyColumns state, const std::vector<ContactPoint>& contact_points, double t,
                               double dt) {
  if (!motors_) return select_points(state, contact_points, t, dt);
  bool are_found = true;
  const bool is_decided = motors_->settle_motors(state, t, [&] {
    are_found = select_points(state, contact_points, t, dt);
    persistent_.begin_attempt();
    const double* loads = loads_.over_step(state, t, dt);
    persistent_.hold(state, loads, ConstraintForces::Rows::chosen_anew);
    return wrench_beside_joints(loads);
  });
  return are_found && is_decided;
}

// The loads, and the forces at the points as they were held last.
const double* PersistentContact::wrench_beside_joints(const double* loads) {
  beside_joints_.resize(kWrenchColumns, system_.size());
  for (std::size_t c = 0; c < kWrenchColumns; ++c) {
    double* const to = beside_joints_.column(c);
    if (loads)
      std::copy_n(loads + c * beside_joints_.stride(), system_.size(), to);
    else
      std::fill_n(to, system_.size(), 0.0);
  }
  for (const PersistentPoint& point : points()) {
    const ConeConstraint cone = point.cone();
    for (const auto& [end, body] : {std::pair(0, cone.a), std::pair(1, cone.b)}) {
      if (body == kWorld) continue;
      const Vec6 push = cone.row(end, point.frame * point.force);
      for (int k = 0; k < 3; ++k) {
        beside_joints_.column(static_cast<std::size_t>(kForce + k))[body] += push[k];
        beside_joints_.column(static_cast<std::size_t>(kTorque + k))[body] += push[3 + k];
      }
    }
  }
  return beside_joints_.data();
}

bool PersistentContact::select_points(MutableBodyColumns state, const std::vector<ContactPoint>& contact_points,
                                      double t, double dt) {
  std::vector<PersistentPoint>& points = persistent_.points();
  old_points_.swap(points);
  old_points_.insert(old_points_.end(), resting_points_.begin(), resting_points_.end());
  forget_points();
  follows_turning_slip_ = false;
  if (joints_) noted_ = joints_->noted();
  const auto& colliders = contact_points_.colliders();
  for (const ContactPoint& contact : contact_points) {
    const Vec3 u = ConeSolver::velocity_at(contact.cone, state);
    if (u.x() > kSlow * threshold_of(contact)) continue;
    PersistentPoint point;
    point.contact = contact;
    if (!contact.is_limit()) {
      const Collider &a = colliders[contact.a], &b = colliders[contact.b];
      const ManifoldPoint place{contact.cone.frame.col(0),
                                state.position(contact.cone.a) + contact.cone.arm_a,
                                contact.gap,
                                contact.feature,
                                contact.part_a,
                                contact.part_b};
      point.features = features_at(place, a, pose_of(state, a.body), b, pose_of(state, b.body));
    }
    const bool slides = contact.cone.friction == 0 || (std::isfinite(contact.cone.friction) &&
                                                       u.tail<2>().norm() > ContactModes::kSliding * scales().speed());
    point.mode = slides ? PersistentPoint::Mode::slides : PersistentPoint::Mode::sticks;
    const auto old = std::find_if(old_points_.begin(), old_points_.end(),
                                  [&](const PersistentPoint& p) { return p.contact.same_place(contact); });
    if (old != old_points_.end()) {
      point.force = contact.cone.frame.transpose() * (old->frame * old->force);
      point.force_in_cone = contact.cone.frame.transpose() * (old->frame * old->force_in_cone);
    }
    points.push_back(point);
  }
  if (points.empty()) return true;
  const bool are_found = modes_.choose(state, loads_.over_step(state, t, dt));
  stop_points(state, are_found ? When::before : When::without_forces);
  note_ends(state);
  if (are_found) set_resting_aside(state);
  return are_found;
}

// A point that begins at an end of its features may go back by what distance_from_ends() leaves open. Beyond that the
// manifold has no other features for it, so that its end cannot be found.
void PersistentContact::note_ends(BodyColumns state) {
  const double open = kAtEnd * scales().gap_unit();
  for (PersistentPoint& point : persistent_.points()) {
    const double distance = persistent_.distance_from_ends(state, point);
    point.passes_at = distance > open ? 0 : distance >= -open ? -2 * open : -kForever;
  }
}

// In units of gaps, at the end of the last advance: negative where a point has passed to another feature.
double PersistentContact::distance_from_ends() const {
  double least = kForever;
  for (const PersistentPoint& point : points())
    least = std::min(least, persistent_.distance_from_ends(end_, point) - point.passes_at);
  return least / scales().gap_unit();
}

// m/s or rad/s: the contact's restitution threshold.
double PersistentContact::threshold_of(const ContactPoint& contact) const {
  return restitution_threshold_ * scales().speed_unit(contact.cone.is_couple) / scales().speed_unit();
}

std::size_t PersistentContact::most_together(const std::vector<ContactPoint>& contact_points) const {
  std::vector<std::pair<int, int>> pairs;
  for (const ContactPoint& contact : contact_points) pairs.emplace_back(contact.cone.a, contact.cone.b);
  std::size_t most = 0;
  for (const Island& island : islands_of(system_, pairs, joints_)) most = std::max(most, island.bodies.size());
  return most;
}

void PersistentContact::forget_points() {
  persistent_.points().clear(), resting_points_.clear();
  rests_.assign(system_.size(), 0);
}

// Bodies that rest together under forces that stay as they are go on resting. A spring may have an end that moves.
// Joints would have to rest, too.
void PersistentContact::set_resting_aside(BodyColumns state) {
  if (joints_ || system_.loads.drives_joints() || !system_.loads.springs().empty() || modes_.are_at_rest(state)) return;
  std::vector<std::pair<int, int>> pairs;
  for (const PersistentPoint& point : points()) pairs.emplace_back(point.contact.cone.a, point.contact.cone.b);
  std::vector<char> is_aside(pairs.size(), 0);
  for (const Island& island : islands_of(system_, pairs)) {
    const bool is_resting =
        std::all_of(island.bodies.begin(), island.bodies.end(), [&](int i) { return modes_.is_at_rest(state, i); });
    if (!is_resting) continue;
    for (const int body : island.bodies) rests_[static_cast<std::size_t>(body)] = 1;
    for (const std::size_t i : island.points) is_aside[i] = 1;
  }
  std::vector<PersistentPoint> moving;
  for (std::size_t i = 0; i < pairs.size(); ++i) (is_aside[i] ? resting_points_ : moving).push_back(points()[i]);
  persistent_.points().swap(moving);
}

void PersistentContact::advance(BodyColumns start, MutableBodyColumns end, double t, double dt) {
  persistent_.begin_attempt();
  copy_columns(start, end);
  const long asked_before = persistent_.times_asked();
  if (joints_) joints_->note_only(noted_);
  stepper().step(end, t, dt);
  passes_ += std::max(1L, (persistent_.times_asked() - asked_before) / kAskedInStep);
  for (std::size_t i = 0; i < end.size(); ++i) {
    if (!rests_[i]) continue;
    end.set_body(i, start.body(i));
    if (end.has_rotation()) end.set_rotation(i, start.rotation(i));
  }
  if (is_free()) return;
  if (end.has_rotation() && (in_contact_.default_orientation.empty() || follows_turning_slip_)) {
    for (std::size_t i = 0; i < end.size(); ++i) end.set_rotation(i, matrix_of(end.orientation(i)));
  }
  end_ = end;
  wrench_at_end_ = loads_.over_step(end, t, dt);
  persistent_.hold(end, wrench_at_end_, ConstraintForces::Rows::as_chosen);
  if (!motors_) return;
  motors_->read(end, dt);
  if (motors_->needs_efforts()) motors_->note_efforts(end, wrench_beside_joints(wrench_at_end_));
}

Stepper& PersistentContact::stepper() const {
  if (is_free()) return *free_stepper_;
  return follows_turning_slip_ ? *adaptive_stepper_ : *contact_stepper_;
}

// Timed forces are constant within a part of a step, and so are springs where nothing moves.
bool PersistentContact::is_at_rest(BodyColumns state) const {
  return !points().empty() && !system_.loads.drives_joints() && modes_.are_at_rest(state);
}

// The distance of the forces from pulling, or from leaving their cones.
double PersistentContact::margin() const {
  double least = kForever;
  for (const PersistentPoint& point : points()) {
    least = std::min(least, point.force.x());
    if (point.mode == PersistentPoint::Mode::sticks && std::isfinite(point.friction()))
      least = std::min(least, point.static_friction() * point.force.x() - point.force.tail<2>().norm());
  }
  return least;
}

// The distances of the slips, and of the forces where their distribution matters.
double PersistentContact::slipping_margin() const {
  double least = kForever;
  const bool shares_matter = persistent_.has_friction_of_slip();
  const double size = persistent_.largest_force();
  for (const PersistentPoint& point : points()) {
    if (shares_matter && size > kLeastSize * scales().acceleration_unit() * point.tangential_mass)
      least = std::min(least, point.force.x() / size + kPulling);
    if (point.mode != PersistentPoint::Mode::slides || point.friction() == 0) continue;
    least = std::min(least, point.slip / scales().speed_unit() + (point.begins_to_slip ? kBeginning : 0));
    // A slip that ended within a long step and began again. Trial steps that an adaptive method refuses are no sign of
    // it.
    if (!is_adaptive() && point.least_slip < -kReversed * point.largest_slip)
      least = std::min(least, point.least_slip / scales().speed_unit());
  }
  return least;
}

double PersistentContact::distance_from_change() {
  const double of_points = distance_from_change_of_points();
  return motors_ ? std::min(of_points, motors_->margin_of_motors()) : of_points;
}

double PersistentContact::distance_from_change_of_points() {
  if (points().empty()) return kForever;
  const double least = std::min(slipping_margin(), distance_from_ends());
  if (least < 0 || margin() >= 0) return least;
  const double violation = modes_.violation(end_, wrench_at_end_);
  return violation > 0 ? -violation : least;
}

bool PersistentContact::close_gaps(MutableBodyColumns state, const std::vector<std::pair<int, int>>& pairs,
                                   Closing which) {
  return gaps_.close(state, pairs, which == Closing::all ? std::span(points()) : std::span<const PersistentPoint>());
}

void PersistentContact::close_joints(MutableBodyColumns state) {
  if (joints_) joints_->project(state);
}

// A residual slip that is too slow to count. A point that begins to slip in another direction would first have to stop.
// Friction has no direction there, and an integrator would not pass this point.
void PersistentContact::stop_points(MutableBodyColumns state, When when) {
  if (points().empty()) return;
  persistent_.place(state);
  targets_.clear();
  double most = 0, speed = 0;
  for (const PersistentPoint& point : points()) {
    const ConeConstraint cone = point.cone();
    const bool stands = point.mode == PersistentPoint::Mode::sticks || (when != When::after && point.begins_to_slip);
    const int last = stands ? 2 : 0;
    for (int axis = 0; axis <= last; ++axis) {
      targets_.push_back(target_of(cone, axis, -point.velocity[axis], true));
      most = std::max(most, std::abs(point.velocity[axis]));
    }
    for (const int body : {cone.a, cone.b}) {
      if (body != kWorld) speed = std::max(speed, state.velocity(body).norm());
    }
  }
  if (most <= kStill * (scales().speed_unit() + speed)) return;
  if (when == When::before && stop_with_friction(state, most)) return;
  const std::vector<PoseStep>& motion = projection_.project(state, targets_);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (motion[i].isZero(0)) continue;
    state.set_velocity(i, state.velocity(i) + motion[i].head<3>());
    state.set_angular_velocity(i, state.angular_velocity(i) + motion[i].tail<3>());
  }
}

// What slides and separates too slowly to bounce would fall back, with friction at each of its impacts. Returns false,
// and leaves the state, where friction would need a far larger impulse (a point that nearly jams).
bool PersistentContact::stop_with_friction(MutableBodyColumns state, double most) {
  if (!persistent_.has_friction_of_slip()) return false;
  before_ = BodyColumns(state);
  persistent_.stop(state);
  const BodyColumns before = std::as_const(before_).columns();
  const double largest = kMostOfStop * most;
  bool is_small = true;
  for (std::size_t i = 0; i < state.size() && is_small; ++i) {
    const double turn = scales().length * (state.angular_velocity(i) - before.angular_velocity(i)).norm();
    is_small = (state.velocity(i) - before.velocity(i)).norm() <= largest && turn <= largest;  // false also for NaN
  }
  if (!is_small) copy_columns(before, state);
  return is_small;
}

// Of the points, what select_points() takes over from them. A step chooses all else anew.
void PersistentContact::archive_state(StateArchive& archive) {
  for (std::vector<PersistentPoint>* points : {&persistent_.points(), &resting_points_}) {
    archive.resized(*points);
    for (PersistentPoint& point : *points)
      archive(point.contact.a, point.contact.b, point.contact.feature, point.frame, point.force, point.force_in_cone);
  }
  archive(noted_, passes_, follows_turning_slip_, fastest_damping_);
  for (Stepper* stepper : {free_stepper_.get(), contact_stepper_.get(), adaptive_stepper_.get()})
    stepper->archive_state(archive);
}

std::string PersistentContact::solver_warning() const { return stepper().solver_warning(); }

}  // namespace rigor::inline dynamics
