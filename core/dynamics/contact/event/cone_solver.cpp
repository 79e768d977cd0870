#include "core/dynamics/contact/event/cone_solver.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/contact/event/cone_newton.h"
#include "core/dynamics/contact/event/cone_sweeps.h"
#include "core/dynamics/joints/islands.h"

namespace rigor::inline dynamics {
namespace {

constexpr int kSweepsAtATime = 30;
constexpr int kMostTurnsToBeNear = 10;   // impulses that are not near rest after the allowed rounds: a tall heap
constexpr int kMostNewtonSteps = 400;    // of an island; what settles takes some 50
constexpr double kCreeping = 0.99;       // of a sequence whose ratio is not known yet
constexpr double kSlow = 0.9;            // from here on Newton's method is quicker
constexpr double kOfNewton = 0.5;        // Newton's method leaves no sequence: its error counts as it is
constexpr int kFewestSweeps = 5;         // before that is judged
constexpr int kBetweenLeaps = 6;         // sweeps
constexpr double kHeldByJoints = 1e-12;  // of the free bodies' inverse mass: what joints do not let move at all

// Larger eigenvalue of a 2 x 2 matrix that is symmetric.
double larger_eigenvalue(const Eigen::Matrix2d& m) {
  const double mean = 0.5 * (m(0, 0) + m(1, 1)), half = 0.5 * (m(0, 0) - m(1, 1));
  return mean + std::hypot(half, m(0, 1));
}

// Whether two bodies touch at several points. Many impulses may then do the same to the motion, or nearly so. Through
// joints Newton's method takes too long for that.
bool may_share_in_many_ways(const std::vector<ConeConstraint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].response >= 0) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (points[i].a == points[j].a && points[i].b == points[j].b) return true;
    }
  }
  return false;
}

}  // namespace

Mat3 contact_frame(const Vec3& n) {
  int least = 0;
  n.cwiseAbs().minCoeff(&least);
  const Vec3 t = n.cross(Vec3::Unit(least)).normalized();
  Mat3 frame;
  frame << n, t, n.cross(t);
  return frame;
}

void ConeSolver::prepare(BodyColumns state, std::vector<ConeConstraint>& points) {
  inverse_inertia_W_.resize(system_.size());
  if (joints_) return find_responses(state, points);
  for (const ConeConstraint& point : points) {
    for (const int body : {point.a, point.b}) {
      const Mat3 R = state.rotation(body);
      inverse_inertia_W_[body] = R * system_.bodies[body].inverse_inertia_B * R.transpose();
    }
  }
  for (ConeConstraint& point : points) {
    const Mat3 a = cross_matrix(point.arm_a), b = cross_matrix(point.arm_b);
    const Mat3 in_world =
        (system_.bodies[point.a].inverse_mass + system_.bodies[point.b].inverse_mass) * Mat3::Identity() -
        a * inverse_inertia_W_[point.a] * a - b * inverse_inertia_W_[point.b] * b;
    point.inverse_mass = point.frame.transpose() * in_world * point.frame;
    point.tangent_effective_mass = 1 / larger_eigenvalue(point.inverse_mass.bottomRightCorner<2, 2>());
  }
}

void ConeSolver::find_responses(BodyColumns state, std::vector<ConeConstraint>& points) {
  responses_.clear();
  if (points.empty()) return;
  joints_->velocity_impulse(state);  // for its factor
  through_joints_->set_pose(state);
  for (std::size_t i = 0; i < system_.size(); ++i) {
    const Mat3 R = state.rotation(i);
    inverse_inertia_W_[i] = R * system_.bodies[i].inverse_inertia_B * R.transpose();
  }
  for (ConeConstraint& point : points) find_response(point);
}

void ConeSolver::find_response(ConeConstraint& point) {
  const std::vector<int> moved = through_joints_->moved_by(point.a, point.b);
  point.response = static_cast<int>(responses_.size());
  Response& response = responses_.emplace_back();
  for (const int body : moved) response.emplace_back().body = body;
  double free = 0;  // the inverse mass without joints
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 direction = point.frame.col(axis);
    const Vec6 on_a = point.row(0, direction), on_b = point.row(1, direction);
    const std::vector<Vec6>& change = through_joints_->of(moved, point.a, on_a, point.b, on_b);
    for (std::size_t k = 0; k < moved.size(); ++k) response[k].by.col(axis) = change[moved[k]];
    free = std::max(free,
                    on_a.dot(through_joints_->alone(point.a, on_a)) + on_b.dot(through_joints_->alone(point.b, on_b)));
  }
  point.inverse_mass.setZero();
  for (const Change& change : response) {
    for (const auto& [end, body] : {std::pair(0, point.a), std::pair(1, point.b)}) {
      if (change.body != body) continue;
      for (int axis = 0; axis < 3; ++axis)
        point.inverse_mass.row(axis) += point.row(end, point.frame.col(axis)).transpose() * change.by;
    }
  }
  if (point.inverse_mass(0, 0) <= kHeldByJoints * free) point.inverse_mass(0, 0) = 0;
  const double tangential = larger_eigenvalue(point.inverse_mass.bottomRightCorner<2, 2>());
  point.tangent_effective_mass = tangential > kHeldByJoints * free ? 1 / tangential : 0;
}

Vec3 ConeSolver::velocity_at(const ConeConstraint& point, BodyColumns state) {
  const auto velocity = [&](int body, const Vec3& arm) -> Vec3 {
    if (body == kWorld) return Vec3::Zero();
    if (point.is_couple) return state.angular_velocity(body);
    return state.velocity(body) + state.angular_velocity(body).cross(arm);
  };
  const Vec3 a = velocity(point.a, point.arm_a), b = velocity(point.b, point.arm_b);
  return point.frame.transpose() * (a - b);
}

void ConeSolver::push(const ConeConstraint& point, const Vec3& impulse, MutableBodyColumns state) const {
  if (point.response >= 0) {
    for (const Change& change : responses_[static_cast<std::size_t>(point.response)]) {
      const Vec6 by = change.by * impulse;
      state.set_velocity(change.body, state.velocity(change.body) + by.head<3>());
      state.set_angular_velocity(change.body, state.angular_velocity(change.body) + by.tail<3>());
    }
    return;
  }
  const Vec3 in_world = point.frame * impulse;
  const auto change = [&](int body, const Vec3& arm, double sign) {
    if (system_.bodies[body].fixed) return;
    state.set_velocity(body, state.velocity(body) + sign * system_.bodies[body].inverse_mass * in_world);
    state.set_angular_velocity(body,
                               state.angular_velocity(body) + sign * (inverse_inertia_W_[body] * arm.cross(in_world)));
  };
  change(point.a, point.arm_a, 1);
  change(point.b, point.arm_b, -1);
}

bool ConeSolver::take_newton_steps(MutableBodyColumns state, std::vector<ConeConstraint>& points, double tolerance,
                                   int& steps) const {
  const std::vector<ConeConstraint> before = points;
  const int before_steps = steps;
  const bool are_few = ConeNewton(system_, inverse_inertia_W_, responses_).solve(state, points, tolerance, steps);
  work_ += before_steps - steps;
  if (!are_few) return false;
  for (std::size_t i = 0; i < points.size(); ++i) push(points[i], points[i].impulse - before[i].impulse, state);
  return true;
}

// The scale of rounding: the bodies' speeds at the points, and their changes by the impulses.
double ConeSolver::size_of(BodyColumns state, const std::vector<ConeConstraint>& points) const {
  const auto speed = [&](int body, const Vec3& arm) {
    if (body == kWorld || system_.bodies[body].fixed) return 0.0;
    return state.velocity(body).norm() + state.angular_velocity(body).norm() * arm.norm();
  };
  double size = 0;
  for (const ConeConstraint& point : points) {
    size = std::max(
        {size, speed(point.a, point.arm_a), speed(point.b, point.arm_b), (point.inverse_mass * point.impulse).norm()});
  }
  return size;
}

bool ConeSolver::solve(MutableBodyColumns state, std::vector<ConeConstraint>& points, Means means) const {
  std::vector<std::pair<int, int>> pairs;
  for (const ConeConstraint& point : points) pairs.emplace_back(point.a, point.b);
  bool have_settled = true;
  ConeSweeps sweeps(system_, inverse_inertia_W_, responses_);
  std::vector<ConeConstraint> of_island;
  for (const Island& island : islands_of(system_, pairs, joints_)) {
    of_island.clear();
    for (const std::size_t i : island.points) of_island.push_back(points[i]);
    have_settled = solve_island(state, of_island, sweeps, means) && have_settled;
    for (std::size_t k = 0; k < island.points.size(); ++k) points[island.points[k]] = of_island[k];
  }
  return have_settled;
}

// If impulses are not unique, sweeps would divide them by the order of the points. Newton's method does not depend on
// the order.
bool ConeSolver::solve_island(MutableBodyColumns state, std::vector<ConeConstraint>& points, ConeSweeps& sweeps,
                              Means means) const {
  if (means != Means::all || !accuracy_.by_newton || !may_share_in_many_ways(points))
    return sweep_until_settled(state, points, sweeps, means, Start::as_given);
  const BodyTable before(BodyColumns{state});
  const std::vector<ConeConstraint> points_before = points;
  if (sweep_until_settled(state, points, sweeps, means, Start::by_newton)) return true;
  copy_columns(before.columns(), state);
  points = points_before;
  return sweep_until_settled(state, points, sweeps, means, Start::as_given);
}

bool ConeSolver::sweep_until_settled(MutableBodyColumns state, std::vector<ConeConstraint>& points, ConeSweeps& sweeps,
                                     Means means, Start start) const {
  double size = 0, last = 0, ratio = kCreeping;
  int steps = kMostNewtonSteps;
  if (start == Start::by_newton) {
    size = size_of(state, points);
    if (take_newton_steps(state, points, accuracy_.at_rest * size, steps)) ratio = kOfNewton;
  }
  sweeps.set_up(state, points);
  const auto goes_on = [&](int turn) {
    return turn < accuracy_.most_turns || (turn < kMostTurnsToBeNear && last > accuracy_.near_rest * size);
  };
  for (int turn = 0; goes_on(turn); ++turn) {
    for (int k = 0; k < kSweepsAtATime; ++k) {
      const double change = sweeps.sweep(points);
      ++sweeps_;
      if (k == 0) {
        sweeps.write(state);
        size = std::max(size, size_of(state, points));
      }
      if (!std::isfinite(change)) return false;
      // For a slowly converging sequence the remaining change counts.
      if (k > 0) ratio = last > 0 ? std::min(change / last, kCreeping) : kCreeping;
      last = change;
      if (change * ratio <= accuracy_.at_rest * size * (1 - ratio)) {
        sweeps.write(state);
        return true;
      }
      // The residual after a leap is judged only after the next two sweeps.
      const bool may_leap = means == Means::all && !accuracy_.by_newton && k + 1 < kSweepsAtATime;
      if (may_leap && (k + 1) % kBetweenLeaps == 0 && sweeps.leap(points)) last = 0;
      if (accuracy_.by_newton && k >= kFewestSweeps && ratio > kSlow) break;
    }
    sweeps.write(state);
    if (!accuracy_.by_newton || !take_newton_steps(state, points, accuracy_.at_rest * size, steps)) continue;
    sweeps.read(state);
    ratio = kOfNewton;
  }
  return last <= accuracy_.near_rest * size;
}

}  // namespace rigor::inline dynamics
