#include "core/dynamics/contact/event/cone_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rigor::inline dynamics {
namespace {

constexpr int kMostRounds = 60, kMostSteps = 40, kMostBacktracks = 20;
// r, in units of a point's own mass, of the first round and of the last ones. A round leaves some 1/r of an error, by
// the stiffest to the softest way the points can move; the linear equations lose as many digits, which the steps of the
// next round win back.
constexpr double kFirstSteepness = 1e2, kSteepness = 1e4, kLastSteepness = 1e6, kSteeper = 10;
constexpr double kRoundTolerance = 1e-6;  // of a round's first residual
constexpr double kNear = 1e-4;  // of the speeds: from here on friction follows the normal impulse within a round

}  // namespace

// False if they are too many.
bool ConeNewton::set_up(BodyColumns state, const std::vector<ConeConstraint>& points) {
  std::vector<int> place(system_.size(), -1);
  int count = 0;
  const auto place_of = [&](int body) {
    if (body == kWorld || system_.bodies[body].fixed) return -1;
    if (place[body] < 0) {
      place[body] = count++;
      bodies_.push_back(body);
      inertia_W_.push_back(inverse_inertia_W_[body].inverse());
    }
    return place[body];
  };
  rows_.clear(), bodies_.clear(), inertia_W_.clear();
  for (const ConeConstraint& point : points) {
    Row row;
    const auto add = [&](int body, int end, int& index, Side& by) {
      index = place_of(body);
      for (int axis = 0; axis < 3; ++axis) by.row(axis) = point.row(end, point.frame.col(axis));
      if (index < 0 || point.response >= 0) return;
      Eigen::Matrix<double, 6, 3> to;
      to << system_.bodies[body].inverse_mass * by.leftCols<3>().transpose(),
          inverse_inertia_W_[body] * by.rightCols<3>().transpose();
      row.to.emplace_back(index, to);
    };
    add(point.a, 0, row.a, row.by_a);
    add(point.b, 1, row.b, row.by_b);
    if (point.response >= 0) {
      for (const ConeSolver::Change& change : responses_[static_cast<std::size_t>(point.response)])
        row.to.emplace_back(place_of(change.body), change.by);
    }
    row.start = ConeSolver::velocity_at(point, state) + point.offset;
    row.known = row.centre = row.impulse = point.impulse;
    row.mass = 3 / point.inverse_mass.trace();
    rows_.push_back(row);
  }
  change_ = Eigen::VectorXd::Zero(6 * count);
  return count <= kMostBodies;
}

Vec3 ConeNewton::velocity_of(const Row& row, const Eigen::VectorXd& speeds) const {
  Vec3 u = Vec3::Zero();
  if (row.a >= 0) u += row.by_a * speeds.segment<6>(6 * row.a);
  if (row.b >= 0) u += row.by_b * speeds.segment<6>(6 * row.b);
  return u;
}

// Returns the energy whose slope by the velocity is minus the impulse.
double ConeNewton::take_impulse(const ConeConstraint& point, const Vec3& u, Row& row) const {
  const double r = steepness_ * row.mass;
  const Vec3 z = row.centre - r * (u - Vec3(point.target_velocity, 0, 0));
  row.slope.setZero();
  row.impulse.setZero();
  const double normal = std::max(0.0, z.x());
  row.impulse.x() = normal;
  if (normal > 0) row.slope(0, 0) = r;
  double energy = normal * normal / (2 * r);
  const double bearing = is_coupled_ ? normal : row.centre.x();
  if (!point.grips && (!(bearing > 0) || point.friction == 0)) return energy;
  const double size = z.tail<2>().norm(), radius = point.grips ? size : point.friction * bearing;
  if (size <= radius) {
    row.impulse.tail<2>() = z.tail<2>();
    row.slope.bottomRightCorner<2, 2>() = r * Eigen::Matrix2d::Identity();
    return energy + size * size / (2 * r);
  }
  const Eigen::Vector2d d = z.tail<2>() / size;
  row.impulse.tail<2>() = radius * d;
  if (is_coupled_) row.slope.block<2, 1>(1, 0) = r * point.friction * d;
  row.slope.bottomRightCorner<2, 2>() = r * radius / size * (Eigen::Matrix2d::Identity() - d * d.transpose());
  return energy + (radius * size - 0.5 * radius * radius) / r;
}

// The impulses that follow from a change of the bodies' speeds. residual_ gets their difference from the impulses that
// make this change.
ConeNewton::Fit ConeNewton::assess(const std::vector<ConeConstraint>& points, const Eigen::VectorXd& change) {
  residual_ = change;
  Fit fit;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Eigen::Vector3d v = change.segment<3>(6 * k), w = change.segment<3>(6 * k + 3);
    fit.energy += 0.5 * (system_.bodies[bodies_[k]].mass * v.squaredNorm() + w.dot(inertia_W_[k] * w));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Row& row = rows_[i];
    const Vec3 u = velocity_of(row, change);
    fit.energy += take_impulse(points[i], row.start + u, row) + row.known.dot(u);
    for (const auto& [place, to] : row.to) residual_.segment<6>(6 * place) -= to * (row.impulse - row.known);
  }
  for (const Row& row : rows_) fit.residual = std::max(fit.residual, velocity_of(row, residual_).norm());
  return fit;
}

ConeNewton::Fit ConeNewton::take_step(const std::vector<ConeConstraint>& points) {
  const Fit before = assess(points, change_);
  derivative_ = Eigen::MatrixXd::Identity(change_.size(), change_.size());
  for (const Row& row : rows_) {
    for (const auto& [place, to] : row.to) {
      if (row.a >= 0) derivative_.block<6, 6>(6 * place, 6 * row.a) += to * row.slope * row.by_a;
      if (row.b >= 0) derivative_.block<6, 6>(6 * place, 6 * row.b) += to * row.slope * row.by_b;
    }
  }
  factors_.factorise(derivative_, DenseFactors::Kind::general);
  const Eigen::VectorXd step = factors_.solve(-residual_);
  if (!step.allFinite()) return before;
  double share = 1;
  for (int k = 0;; ++k, share *= 0.5) {
    const Fit now = assess(points, change_ + share * step);
    // Near the end the energy's own rounding hides by how much it falls.
    const double rounding = 1e-13 * std::abs(before.energy);
    const bool is_better = is_coupled_ || std::abs(now.energy - before.energy) < rounding
                               ? now.residual < before.residual
                               : now.energy < before.energy;
    if (is_better || k == kMostBacktracks) {
      if (is_better) change_ += share * step;
      return is_better ? now : before;
    }
  }
}

bool ConeNewton::solve(BodyColumns state, std::vector<ConeConstraint>& points, double tolerance, int& steps) {
  if (!set_up(state, points)) return false;
  const double near = kNear / 1e-13 * tolerance;
  double moved = std::numeric_limits<double>::infinity();
  steepness_ = kFirstSteepness;
  for (int round = 0; round < kMostRounds && moved > tolerance && steps > 0; ++round) {
    is_coupled_ = moved < near;
    if (is_coupled_) steepness_ = kLastSteepness;
    Fit fit = assess(points, change_);
    const double enough = std::max(tolerance, kRoundTolerance * fit.residual);
    for (int k = 0; k < kMostSteps && fit.residual > enough && steps > 0; ++k, --steps) {
      const Fit now = take_step(points);
      if (now.residual == fit.residual) break;
      fit = now;
    }
    assess(points, change_);
    moved = 0;
    for (Row& row : rows_) {
      moved = std::max(moved, (row.impulse - row.centre).norm() / (row.mass * (is_coupled_ ? steepness_ : 1)));
      row.centre = row.impulse;
    }
    steepness_ = std::min(kSteepness, kSteeper * steepness_);
  }
  for (std::size_t i = 0; i < points.size(); ++i) points[i].impulse = rows_[i].impulse;
  return true;
}

}  // namespace rigor::inline dynamics
