#include "core/dynamics/contact/event/crowded_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/dynamics/contact/event/contact_modes.h"
#include "core/dynamics/contact/event/impacts.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kLongest = 1.0 / 24;  // in the scene's units of time
constexpr double kShare = 1.0 / 4;     // of a step: shorter steps are to be nearer to the truth here too

// A step errs by its own length squared; impulses that are nearer to the laws than that are not worth their time.
constexpr ConeAccuracy kAccuracy{.at_rest = 1e-4, .near_rest = 5e-2, .most_turns = 2, .by_newton = false};

const char* const kNotSettled = "the impulses between touching bodies did not settle";

void turn_and_move(MutableBodyColumns state, std::size_t i, const Vec3& way, const Vec3& turn) {
  state.set_position(i, state.position(i) + way);
  const Quat rotation = rotation_by(turn);
  state.set_orientation(i, (rotation * state.orientation(i)).normalized());
  if (state.has_rotation()) state.set_rotation(i, rotation.toRotationMatrix() * state.rotation(i));
}

}  // namespace

CrowdedSteps::CrowdedSteps(const ContactParts& parts, ContactPoints& contact_points)
    : system_(parts.system),
      joints_(parts.joints),
      contact_points_(contact_points),
      stepper_(parts.integrator.make({system_, nullptr, parts.orientation, parts.settings, parts.joints})),
      solver_(system_, kAccuracy, parts.joints) {}

double CrowdedSteps::longest(double dt) const {
  return std::min(kLongest * contact_points_.scales().time, kShare * dt);
}

std::string CrowdedSteps::wording() const {
  return fmt::format("{} inelastic steps of first order, {:.3g} s in all", steps_, seconds_);
}

// Of the last step's contacts, what impulse_before() needs.
void CrowdedSteps::archive_state(StateArchive& archive) {
  archive(length_before_, seconds_, steps_, solver_warning_);
  archive.resized(touching_);
  for (ContactPoint& point : touching_) archive(point.a, point.b, point.feature, point.cone.frame, point.cone.impulse);
  if (archive.restores()) impulses_.assign(touching_.size(), Vec3::Zero());
  stepper_->archive_state(archive);
}

double CrowdedSteps::short_of_passing(BodyColumns state, double rest, double longest) const {
  constexpr double kShortest = 1.0 / 64;  // of the longest; of the rest it would never come to its end
  double h = longest;
  for (const Collider& collider : contact_points_.colliders()) {
    if (collider.fixed) continue;
    const double speed =
        state.velocity(collider.body).norm() + state.angular_velocity(collider.body).norm() * collider.bounding_radius;
    h = std::min(h, collider.inradius / speed);
  }
  return std::min(std::max(h, kShortest * longest), rest);
}

double CrowdedSteps::take(MutableBodyColumns state, double t, double rest, double longest) {
  solver_warning_.clear();
  const double h = short_of_passing(state, rest, longest);
  stepper_->step(state, t, h);
  free_ = BodyColumns(state);
  stop_overlaps(state, h);
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vec3 v = state.velocity(i) - free_.columns().velocity(i),
               w = state.angular_velocity(i) - free_.columns().angular_velocity(i);
    if (!v.isZero(0) || !w.isZero(0)) turn_and_move(state, i, 0.5 * h * v, 0.5 * h * w);
  }
  if (joints_) joints_->project(state);
  solve_where_they_came_to(state);
  seconds_ += h, ++steps_;
  length_before_ = h;
  return h;
}

void CrowdedSteps::stop_overlaps(MutableBodyColumns state, double h) {
  before_.swap(touching_);
  touching_.clear();
  contact_points_.find(state, contact_points_.candidates(state), ContactPoint::kClosed, touching_);
  const double least = 2 * system_.scene_gravity.norm() * h;  // m/s, of what rebounds
  cones_.clear();
  for (const ContactPoint& contact : touching_) {
    cones_.push_back(contact.cone);
    cones_.back().grips = std::isinf(contact.cone.friction);
    const double slip = ConeSolver::velocity_at(contact.cone, state).tail<2>().norm();
    if (slip <= ContactModes::kSliding * contact_points_.scales().speed())
      cones_.back().friction = contact.static_friction;
    cones_.back().impulse = impulse_before(contact) * (h / length_before_);
    const double approach = -ConeSolver::velocity_at(contact.cone, state).x();
    if (!(approach > least) || contact.restitution == 0) continue;
    cones_.back().target_velocity = contact.restitution * approach;
  }
  solver_.prepare(state, cones_);
  const double energy = kinetic_energy(system_, state);
  for (const ConeConstraint& cone : cones_) solver_.push(cone, cone.impulse, state);
  bool has_settled = solver_.solve(state, cones_);
  if (kinetic_energy(system_, state) > energy * (1 + kNewEnergy)) {
    copy_columns(std::as_const(free_).columns(), state);
    for (ConeConstraint& cone : cones_) cone.target_velocity = 0, cone.impulse.setZero();
    has_settled = solver_.solve(state, cones_, ConeSolver::Means::sweeps);
  }
  if (!has_settled) solver_warning_ = kNotSettled;
  impulses_.clear();
  for (const ConeConstraint& cone : cones_) impulses_.push_back(cone.frame * cone.impulse);
}

// The search begins with the impulses of the last step.
Vec3 CrowdedSteps::impulse_before(const ContactPoint& contact) const {
  const auto old = std::find_if(before_.begin(), before_.end(),
                                [&](const ContactPoint& point) { return point.same_place(contact); });
  if (old == before_.end()) return Vec3::Zero();
  return contact.cone.frame.transpose() * (old->cone.frame * old->cone.impulse);
}

// The arms and normals have changed. Without this correction a rolling or standing body would keep a slip.
void CrowdedSteps::solve_where_they_came_to(MutableBodyColumns state) {
  for (std::size_t i = 0; i < touching_.size(); ++i) {
    touching_[i].cone = cones_[i];
    contact_points_.follow(state, touching_[i]);
    cones_[i] = touching_[i].cone;
  }
  free_ = BodyColumns(state);
  solver_.prepare(state, cones_);
  if (!solver_.solve(state, cones_)) solver_warning_ = kNotSettled;
  const double before = kinetic_energy(system_, std::as_const(free_).columns());
  if (kinetic_energy(system_, state) > before * (1 + kNewEnergy)) {
    copy_columns(std::as_const(free_).columns(), state);
  } else {
    for (std::size_t i = 0; i < touching_.size(); ++i)
      impulses_[i] += cones_[i].frame * (cones_[i].impulse - touching_[i].cone.impulse);
  }
  for (std::size_t i = 0; i < touching_.size(); ++i) touching_[i].cone = cones_[i];
}

}  // namespace rigor::inline dynamics
