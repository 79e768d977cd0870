#include "core/dynamics/contact/event/impacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rigor {
namespace {

constexpr int kMostImpactRounds = 2000;  // before every touching point is taken together, without rebound
// Infinite friction stops a slip at once, by an impulse that needs a normal one, however small: one that leaves so
// little of a speed [m/s]. Slower slips are none.
constexpr int kRoundsOfInfinity = 2;
constexpr double kJamming = 1e-9, kJammed = 1e-11;

void copy_velocities(BodyColumns from, MutableBodyColumns to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to.set_velocity(i, from.velocity(i));
    to.set_angular_velocity(i, from.angular_velocity(i));
  }
}

}  // namespace

bool Impacts::resolve(MutableBodyColumns state, std::vector<ContactPoint>& contact_points) {
  solver_warning_.clear();
  rebound_ = false;
  points_.clear();
  for (const ContactPoint& contact : contact_points) points_.push_back(contact.cone);
  for (ConeConstraint& point : points_) point.impulse.setZero();
  solver_.prepare(state, points_);
  for (int round = 0;; ++round) {
    if (round == kRoundsOfInfinity) let_infinite_friction_grip();
    if (!choose(state, contact_points, round >= kMostImpactRounds)) break;
    solve_round(state);
    if (round <= kMostImpactRounds) continue;
    solver_warning_ = "an impact of several bodies did not come to an end; what was left of it was dropped";
    break;
  }
  return rebound_;
}

// Where infinite friction at a point asks for a pull there are no impulses, unless it stops slips without pressure:
// what ever greater friction tends to.
void Impacts::let_infinite_friction_grip() {
  for (ConeConstraint& point : points_) point.grips = std::isinf(point.friction);
}

// Fills chosen_ with this round's points; false if none approaches.
bool Impacts::choose(BodyColumns state, const std::vector<ContactPoint>& contact_points, bool all) {
  chosen_.clear();
  bool any_impact = false;
  for (std::size_t i = 0; i < contact_points.size(); ++i) {
    ConeConstraint& point = points_[i];
    const Vec3 u = ConeSolver::velocity_at(point, state);
    const double approach = -u.x();
    const bool jams = std::isinf(point.friction) && approach > -kStillSpeed && u.tail<2>().norm() > kJamming;
    const bool is_impact = approach > kStillSpeed || jams;
    any_impact = any_impact || is_impact;
    const bool rebounds = approach > restitution_threshold_ && !all && contact_points[i].restitution > 0;
    rebound_ = rebound_ || (is_impact && approach > restitution_threshold_) || jams;
    point.target_velocity = rebounds ? contact_points[i].restitution * approach : 0;
    if (jams) point.target_velocity = std::max(point.target_velocity, kJammed);
    if (is_impact || all || contact_points[i].restitution == 0) chosen_.push_back(point);
  }
  return any_impact;
}

void Impacts::solve_round(MutableBodyColumns state) {
  before_ = BodyColumns(state);
  const double energy = kinetic_energy(system_, state);
  const auto attempt = [&](double share) {
    copy_velocities(std::as_const(before_).columns(), state);
    std::vector<ConeConstraint> points = chosen_;
    for (ConeConstraint& point : points) point.target_velocity *= share;
    if (!solver_.solve(state, points)) solver_warning_ = "the impulses of an impact did not settle";
    return kinetic_energy(system_, state) <= energy * (1 + kNewEnergy);
  };
  const bool rebounds =
      std::any_of(chosen_.begin(), chosen_.end(), [](const auto& p) { return p.target_velocity > 0; });
  if (attempt(1) || !rebounds) return;
  double low = 0, high = 1;
  for (int k = 0; k < 50; ++k) {
    const double share = 0.5 * (low + high);
    (attempt(share) ? low : high) = share;
  }
  attempt(low);
}

double kinetic_energy(const System& system, BodyColumns state) {
  double energy = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Inertia& body = system.bodies[i];
    const Vec3 w = state.angular_velocity(i);
    energy += 0.5 * body.mass * state.velocity(i).squaredNorm() +
              0.5 * w.dot(angular_momentum_of(body, state.rotation(i), w));
  }
  return energy;
}

}  // namespace rigor
