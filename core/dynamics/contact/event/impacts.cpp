#include "core/dynamics/contact/event/impacts.h"

#include <utility>

namespace rigor {
namespace {

constexpr int kMostImpactRounds = 2000;  // before every touching point is taken together, without rebound
constexpr double kNewEnergy = 1e-12;     // of the energy before: rounding

void copy_velocities(BodyColumns from, MutableBodyColumns to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to.set_velocity(i, from.velocity(i));
    to.set_angular_velocity(i, from.angular_velocity(i));
  }
}

}  // namespace

bool Impacts::resolve(MutableBodyColumns state, std::vector<ContactPoint>& contact_points, bool inelastic) {
  solver_warning_.clear();
  rebound_ = false;
  points_.clear();
  for (const ContactPoint& contact : contact_points) points_.push_back(contact.cone);
  for (ConeConstraint& point : points_) point.impulse.setZero();
  solver_.prepare(state, points_);
  int round = 0;
  while (choose(state, contact_points, inelastic, round >= kMostImpactRounds)) {
    solve_round(state);
    if (round++ > kMostImpactRounds) {
      solver_warning_ = "an impact of several bodies did not come to an end; what was left of it was dropped";
      break;
    }
  }
  return rebound_;
}

// Fills chosen_ with this round's points; false if none approaches.
bool Impacts::choose(BodyColumns state, const std::vector<ContactPoint>& contact_points, bool inelastic, bool all) {
  chosen_.clear();
  bool hit = false;
  for (std::size_t i = 0; i < contact_points.size(); ++i) {
    ConeConstraint& point = points_[i];
    const double approach = -ConeSolver::velocity_at(point, state).x();
    const bool hits = approach > kStillSpeed;
    hit = hit || hits;
    const bool rebounds = approach > restitution_threshold_ && !inelastic && !all && contact_points[i].restitution > 0;
    rebound_ = rebound_ || (hits && approach > restitution_threshold_);
    point.target_velocity = rebounds ? contact_points[i].restitution * approach : 0;
    if (hits || all || contact_points[i].restitution == 0) chosen_.push_back(point);
  }
  return hit;
}

void Impacts::solve_round(MutableBodyColumns state) {
  before_ = BodyColumns(state);
  const double energy = kinetic_energy(state);
  const auto attempt = [&](double share) {
    copy_velocities(std::as_const(before_).columns(), state);
    std::vector<ConeConstraint> points = chosen_;
    for (ConeConstraint& point : points) point.target_velocity *= share;
    if (!solver_.solve(state, points)) solver_warning_ = "the impulses of an impact did not settle";
    return kinetic_energy(state) <= energy * (1 + kNewEnergy);
  };
  if (attempt(1)) return;
  double low = 0, high = 1;
  for (int k = 0; k < 50; ++k) {
    const double share = 0.5 * (low + high);
    (attempt(share) ? low : high) = share;
  }
  attempt(low);
}

double Impacts::kinetic_energy(BodyColumns state) const {
  double energy = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Inertia& body = system_.bodies[i];
    const Vec3 w = state.angular_velocity(i);
    energy += 0.5 * body.mass * state.velocity(i).squaredNorm() +
              0.5 * w.dot(angular_momentum_of(body, state.rotation(i), w));
  }
  return energy;
}

}  // namespace rigor
