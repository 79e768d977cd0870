#include "core/dynamics/contact/event/impacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/dynamics/contact/event/event_options.h"
#include "core/dynamics/joints/islands.h"
#include "core/engine/option_values.h"

namespace rigor::inline dynamics {
namespace {

constexpr int kMostImpactRounds = 2000;  // before every touching point is taken together, without rebound
constexpr int kRoundsOfInfinity = 2;
constexpr double kDeciding = 1e-6;  // of the change of velocities: orders that differ by more have different results
// In the scene's units of speed.
constexpr double kHitting = 1e-6;      // a slower approach has no lasting effect, in any order of contacts
constexpr double kStillSpeed = 1e-10;  // roundings of an impact leave at most this of a speed that should be zero
// Infinite friction stops a slip above kJamming at once. Its impulse needs a normal one, which leaves the speed
// kJammed.
constexpr double kJamming = 1e-9, kJammed = 1e-11;

void copy_velocities(BodyColumns from, MutableBodyColumns to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to.set_velocity(i, from.velocity(i));
    to.set_angular_velocity(i, from.angular_velocity(i));
  }
}

}  // namespace

// Slower bounces would be as low as roundings of a position.
double restitution_threshold(const Settings& settings, const ContactScales& scales) {
  return number_option(settings, kRestitutionThresholdOption,
                       kRestitutionThreshold * std::max(1.0, scales.factor) * scales.speed_unit());
}

bool Impacts::resolve(MutableBodyColumns state, std::vector<ContactPoint>& contact_points) {
  solver_warning_.clear();
  tied_.clear();
  points_.clear();
  for (const ContactPoint& contact : contact_points) points_.push_back(contact.cone);
  solver_.prepare(state, points_);
  if (watches_ties_) start_ = BodyColumns(state);
  const bool have_rebounded = take_rounds(state, contact_points);
  if (!watches_ties_) return have_rebounded;
  const std::vector<Vec3> impulses = impulses_;
  find_ties(state, contact_points);
  impulses_ = impulses;
  return have_rebounded;
}

bool Impacts::take_rounds(MutableBodyColumns state, const std::vector<ContactPoint>& contact_points) {
  rebound_ = false;
  impulses_.assign(points_.size(), Vec3::Zero());
  for (ConeConstraint& point : points_) point.impulse.setZero(), point.grips = false;
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

// If infinite friction at a point would need a pull, no impulses exist, unless friction stops slips without pressure:
// the limit of ever larger friction.
void Impacts::let_infinite_friction_grip() {
  for (ConeConstraint& point : points_) point.grips = std::isinf(point.friction);
}

// Fills chosen_ with this round's points; false if none approaches.
bool Impacts::choose(BodyColumns state, const std::vector<ContactPoint>& contact_points, bool all) {
  chosen_.clear(), places_.clear();
  bool any_impact = false;
  for (std::size_t i = 0; i < contact_points.size(); ++i) {
    ConeConstraint& point = points_[i];
    if (only_ && *only_ != std::pair(point.a, point.b)) continue;
    const Vec3 u = ConeSolver::velocity_at(point, state);
    const double approach = -u.x(), unit = scales_.speed_unit(point.is_couple), still = kStillSpeed * unit;
    const bool jams = std::isinf(point.friction) && approach > -still && u.tail<2>().norm() > kJamming * unit;
    const bool is_impact = approach > still || jams;
    any_impact = any_impact || is_impact;
    const bool rebounds = approach > restitution_threshold_ && !all && contact_points[i].restitution > 0;
    rebound_ = rebound_ || (is_impact && approach > restitution_threshold_) || jams;
    point.target_velocity = rebounds ? contact_points[i].restitution * approach : 0;
    if (jams) point.target_velocity = std::max(point.target_velocity, kJammed * unit);
    if (is_impact || all || contact_points[i].restitution == 0) chosen_.push_back(point), places_.push_back(i);
  }
  return any_impact;
}

std::vector<std::pair<int, int>> Impacts::hitting_pairs(BodyColumns state) const {
  std::vector<std::pair<int, int>> pairs;
  for (const ConeConstraint& point : points_) {
    const bool hits = -ConeSolver::velocity_at(point, state).x() > kHitting * scales_.speed_unit(point.is_couple);
    const std::pair pair(point.a, point.b);
    if (hits && std::find(pairs.begin(), pairs.end(), pair) == pairs.end()) pairs.push_back(pair);
  }
  return pairs;
}

// Pairs that act on each other lie on one island. Bodies that meet in one instant are resolved together, and the other
// orders are tried beside that.
void Impacts::find_ties(BodyColumns result, const std::vector<ContactPoint>& contact_points) {
  const BodyColumns start = std::as_const(start_).columns();
  const std::vector<std::pair<int, int>> hitting = hitting_pairs(start);
  if (hitting.size() < 2) return;
  std::vector<std::pair<int, int>> all;
  for (const ConeConstraint& point : points_) all.emplace_back(point.a, point.b);
  const std::string warning = solver_warning_;
  const bool had_rebounded = rebound_;
  for (const Island& island : islands_of(system_, all, joints_)) {
    std::vector<std::pair<int, int>> here;
    for (const auto& pair : hitting) {
      const bool is_here = std::any_of(island.points.begin(), island.points.end(),
                                       [&](std::size_t point) { return all[point] == pair; });
      if (is_here) here.push_back(pair);
    }
    const auto matters = [&](const auto& first) { return decides(first, result, contact_points); };
    if (here.size() > 1 && std::any_of(here.begin(), here.end(), matters))
      tied_.insert(tied_.end(), here.begin(), here.end());
  }
  solver_warning_ = warning, rebound_ = had_rebounded;
}

// Whether the velocities differ from the result if this pair meets before the others.
bool Impacts::decides(const std::pair<int, int>& first, BodyColumns result,
                      const std::vector<ContactPoint>& contact_points) {
  other_ = std::as_const(start_).columns();
  only_ = first;
  take_rounds(other_.columns(), contact_points);
  only_.reset();
  take_rounds(other_.columns(), contact_points);
  const BodyColumns start = std::as_const(start_).columns(), other = std::as_const(other_).columns();
  double most = 0, change = 0;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto apart = [&](BodyColumns a, BodyColumns b) {
      return (a.velocity(i) - b.velocity(i)).norm() +
             scales_.length * (a.angular_velocity(i) - b.angular_velocity(i)).norm();
    };
    most = std::max(most, apart(other, result)), change = std::max(change, apart(start, result));
  }
  return most > kDeciding * change;
}

void Impacts::solve_round(MutableBodyColumns state) {
  before_ = BodyColumns(state);
  const double energy = kinetic_energy(system_, state);
  std::vector<ConeConstraint> points;
  const auto attempt = [&](double share) {
    copy_velocities(std::as_const(before_).columns(), state);
    points = chosen_;
    for (ConeConstraint& point : points) point.target_velocity *= share;
    if (!solver_.solve(state, points)) solver_warning_ = "the impulses of an impact did not settle";
    return kinetic_energy(system_, state) <= energy * (1 + kNewEnergy);
  };
  const bool rebounds =
      std::any_of(chosen_.begin(), chosen_.end(), [](const auto& p) { return p.target_velocity > 0; });
  if (!attempt(1) && rebounds) {
    double low = 0, high = 1;
    for (int k = 0; k < 50; ++k) {
      const double share = 0.5 * (low + high);
      (attempt(share) ? low : high) = share;
    }
    attempt(low);
  }
  for (std::size_t i = 0; i < points.size(); ++i) impulses_[places_[i]] += points[i].impulse;
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

}  // namespace rigor::inline dynamics
