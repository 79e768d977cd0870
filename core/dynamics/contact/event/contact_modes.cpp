#include "core/dynamics/contact/event/contact_modes.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/joints/islands.h"

namespace rigor::inline dynamics {
namespace {

// In the scene's units of acceleration and speed.
constexpr double kLeastSize = 1e-7;   // smaller accelerations are roundings
constexpr double kResting = 1e-12;    // roundings of a speed at rest, and of an acceleration as a share of the largest
constexpr double kSeparating = 1e-9;  // ten times the residual of an impact: a slower contact does not separate
// Thresholds of separating, and of beginning to slide, as shares of the accelerations. A mode ends at twice as much, so
// that a new choice differs.
constexpr double kPulling = 1e-9;  // of the forces
constexpr double kSeparatingShare = 1e-8, kSlipping = 1e-7, kEnding = 2;
// of the accelerations: the weight of a slip beside them; the error of its direction is 1/kSlip
constexpr double kSlip = 1e4;

}  // namespace

// On the verge of sliding the least forces are far from the cones, while the last forces are on them. If points of an
// island slide, the least forces are nearer.
void ContactModes::start_from_cones() {
  const std::vector<PersistentPoint>& points = persistent_.points();
  std::vector<std::pair<int, int>> pairs;
  for (const ConeConstraint& cone : cones_) pairs.emplace_back(cone.a, cone.b);
  for (const Island& island : islands_of(system_, pairs, joints_)) {
    const bool all_stick = std::all_of(island.points.begin(), island.points.end(), [&](std::size_t i) {
      return points[i].mode == PersistentPoint::Mode::sticks && points[i].force_in_cone.x() > 0;
    });
    if (!all_stick) continue;
    for (const std::size_t i : island.points) cones_[i].impulse = points[i].force_in_cone;
  }
}

bool ContactModes::slides(const PersistentPoint& point, Slips slips) const {
  if (slips == Slips::as_chosen && point.mode == PersistentPoint::Mode::slides) return true;
  return std::isfinite(point.friction()) && point.velocity.tail<2>().norm() > kSliding * scales().speed();
}

bool ContactModes::solve(BodyColumns state, const double* wrench, Slips slips) {
  accelerations_ = state;
  const double* const total = joints_ ? joints_->hold(state, wrench, ConstraintForces::Rows::chosen_anew) : wrench;
  const MutableBodyColumns table = accelerations_.columns();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto [linear, angular] = persistent_.free_acceleration(state, total, static_cast<int>(i));
    table.set_velocity(i, linear), table.set_angular_velocity(i, angular);
  }
  cones_.clear();
  size_ = kLeastSize * scales().acceleration_unit();
  for (const PersistentPoint& point : persistent_.points()) {
    ConeConstraint cone = point.cone();
    cone.offset = point.bias;
    cone.target_velocity = 0;
    cone.impulse = point.force.x() > 0 ? point.force : Vec3::Zero();
    if (!slides(point, slips)) cone.friction = point.static_friction();
    size_ = std::max(size_, (ConeSolver::velocity_at(cone, table) + point.bias).norm());
    cones_.push_back(cone);
  }
  start_from_cones();
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    const PersistentPoint& point = persistent_.points()[i];
    if (slides(point, Slips::by_speed))
      cones_[i].offset.tail<2>() += kSlip * size_ * point.velocity.tail<2>().normalized();
  }
  solver_.prepare(table, cones_);
  for (const ConeConstraint& cone : cones_) solver_.push(cone, cone.impulse, table);
  bool has_settled = solver_.solve(table, cones_);
  while (has_settled && let_slip(table, slips)) has_settled = solver_.solve(table, cones_);
  for (const ConeConstraint& cone : cones_) size_ = std::max(size_, (cone.inverse_mass * cone.impulse).norm());
  for (std::size_t i = 0; i < cones_.size(); ++i) persistent_.points()[i].force_in_cone = cones_[i].impulse;
  return has_settled;
}

// Takes their static friction from points that it does not hold. Whether there are any; others may then slip, too.
bool ContactModes::let_slip(MutableBodyColumns accelerations, Slips slips) {
  bool are_any = false;
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    const PersistentPoint& point = persistent_.points()[i];
    if (slides(point, slips) || !(cones_[i].friction > point.friction())) continue;
    if (!(acceleration_of(i).tail<2>().norm() > kSlipping * size_)) continue;
    cones_[i].friction = point.friction();
    const Vec3 without = -cones_[i].impulse;
    solver_.push(cones_[i], without, accelerations);
    cones_[i].impulse.setZero();
    are_any = true;
  }
  return are_any;
}

Vec3 ContactModes::acceleration_of(std::size_t point) const {
  return ConeSolver::velocity_at(cones_[point], accelerations_.columns()) + persistent_.points()[point].bias;
}

bool ContactModes::choose(BodyColumns state, const double* wrench) {
  std::vector<PersistentPoint>& points = persistent_.points();
  persistent_.place(state);
  if (!solve(state, wrench, Slips::by_speed)) return false;
  std::vector<PersistentPoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    PersistentPoint& point = points[i];
    const Vec3 acceleration = acceleration_of(i);
    if (acceleration.x() > kSeparatingShare * size_) continue;
    if (point.velocity.x() > kSeparating * scales().speed_unit(cones_[i].is_couple) && !(cones_[i].impulse.x() > 0))
      continue;
    const Eigen::Vector2d slip = point.velocity.tail<2>(), change = acceleration.tail<2>();
    const bool slides = this->slides(point, Slips::by_speed);
    point.begins_to_slip = !slides && std::isfinite(point.friction()) && change.norm() > kSlipping * size_;
    point.mode = slides || point.begins_to_slip || point.friction() == 0 ? PersistentPoint::Mode::slides
                                                                         : PersistentPoint::Mode::sticks;
    point.slip_direction.setZero();
    if (slides) point.slip_direction = point.frame.rightCols<2>() * slip.normalized();
    if (point.begins_to_slip) point.slip_direction = point.frame.rightCols<2>() * change.normalized();
    point.force = cones_[i].impulse;
    point.tangential_mass = cones_[i].tangent_effective_mass;
    const double across = slip.x() * change.y() - slip.y() * change.x();
    point.turn_rate = slides ? std::abs(across) / slip.squaredNorm() : 0;
    kept.push_back(point);
  }
  points.swap(kept);
  return drop_pulling_points(state, wrench);
}

// If points slide, the distribution of forces matters, and some of the least forces may pull. Without those points the
// others carry the body. Returns false if it then sinks there, where no consistent forces exist (Painlevé).
bool ContactModes::drop_pulling_points(BodyColumns state, const double* wrench) {
  std::vector<PersistentPoint>& points = persistent_.points();
  std::vector<PersistentPoint> dropped;
  while (persistent_.has_friction_of_slip()) {
    persistent_.begin_attempt();
    persistent_.hold(state, wrench, ConstraintForces::Rows::as_chosen);
    const auto least =
        std::min_element(points.begin(), points.end(),
                         [](const PersistentPoint& a, const PersistentPoint& b) { return a.force.x() < b.force.x(); });
    if (least->force.x() >= -kPulling * persistent_.largest_force()) break;
    dropped.push_back(*least);
    points.erase(least);
  }
  if (dropped.empty()) return true;
  persistent_.begin_attempt();
  const double* total = persistent_.hold(state, wrench, ConstraintForces::Rows::as_chosen);
  return std::none_of(dropped.begin(), dropped.end(), [&](PersistentPoint& point) {
    return persistent_.normal_acceleration(state, total, point) < -kSeparatingShare * size_;
  });
}

bool ContactModes::is_at_rest(BodyColumns state, int body) const {
  if (system_.bodies[body].fixed) return true;
  const BodyColumns rates = accelerations_.columns();
  const double still = kResting * scales().speed_unit(), arm = scales().length;
  return state.velocity(body).norm() <= still && arm * state.angular_velocity(body).norm() <= still &&
         rates.velocity(body).norm() <= kResting * size_ &&
         arm * rates.angular_velocity(body).norm() <= kResting * size_;
}

bool ContactModes::are_at_rest(BodyColumns state) const {
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!is_at_rest(state, static_cast<int>(i))) return false;
  }
  return true;
}

double ContactModes::violation(BodyColumns state, const double* wrench) {
  const bool has_settled = solve(state, wrench, Slips::as_chosen);
  double most = has_settled ? -1 : 1;
  for (std::size_t i = 0; i < persistent_.points().size(); ++i) {
    const Vec3 acceleration = acceleration_of(i) / size_;
    most = std::max(most, acceleration.x() - kEnding * kSeparatingShare);
    if (persistent_.points()[i].mode == PersistentPoint::Mode::sticks)
      most = std::max(most, acceleration.tail<2>().norm() - kEnding * kSlipping);
  }
  return most;
}

}  // namespace rigor::inline dynamics
