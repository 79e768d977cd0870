#include "core/dynamics/contact/event/cone_sweeps.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace rigor::inline dynamics {
namespace {

double disc(double friction, double normal) {
  if (!(normal > 0)) return 0;
  return std::isinf(friction) ? friction : friction * normal;
}

Eigen::Vector2d onto_disc(const Eigen::Vector2d& p, double radius) {
  const double square = p.squaredNorm();
  return square <= radius * radius ? p : Eigen::Vector2d(p * (radius / std::sqrt(square)));
}

// Normal and tangential parts in turn. They converge together from one sweep to the next, so changes much smaller than
// those of the sweep are left to the next one.
Vec3 impulse_in_turns(const ConeConstraint& point, const Vec3& free) {
  constexpr int kTurns = 8;
  constexpr double kSmall = 1e-2;
  const Mat3& W = point.inverse_mass;
  const double per_normal = 1 / W(0, 0);
  Vec3 p = point.impulse;
  for (int turn = 0; turn < kTurns; ++turn) {
    const Vec3 before = p;
    p.x() = std::max(0.0, (point.target_velocity - free.x() - W(0, 1) * p.y() - W(0, 2) * p.z()) * per_normal);
    const Vec3 slip = free + W * p;
    const double radius = point.grips ? kInfiniteFriction : disc(point.friction, p.x());
    p.tail<2>() = onto_disc(p.tail<2>() - point.tangent_effective_mass * slip.tail<2>(), radius);
    if ((p - before).squaredNorm() <= kSmall * kSmall * (p - point.impulse).squaredNorm()) break;
  }
  return p;
}

// On the cone's rim, p = p_n (1, mu d), with d against the slip that it leaves: Newton's method for d, from the
// direction that is there. None where it goes astray.
std::optional<Vec3> sliding_impulse(const ConeConstraint& point, const Vec3& free) {
  constexpr int kSteps = 6;
  // rad: the remaining error is its square, and after the next sweep the square of that
  constexpr double kSmall = 1e-4;
  const Mat3& W = point.inverse_mass;
  const Eigen::Vector2d before = point.impulse.tail<2>(), start = before.isZero(0) ? -free.tail<2>() : before;
  Eigen::Vector2d d = start.normalized();
  const auto along = [&](const Eigen::Vector2d& t) { return W(0, 1) * t.x() + W(0, 2) * t.y(); };
  for (int k = 0; k < kSteps; ++k) {
    const double mass = 1 / (W(0, 0) + point.friction * along(d));
    const double normal = mass * (point.target_velocity - free.x());
    if (!(normal > 0)) return {};
    const Vec3 p(normal, point.friction * normal * d.x(), point.friction * normal * d.y());
    const Eigen::Vector2d slip = (free + W * p).tail<2>(), across(-d.y(), d.x());
    // p' by the angle of d.
    const Vec3 rate = point.friction * (normal * Vec3(0, across.x(), across.y()) - mass * along(across) * p);
    const double slope = across.dot((W * rate).tail<2>()) - d.dot(slip);
    if (!(slope > 0)) return {};
    const double turn = -across.dot(slip) / slope;
    if (std::abs(turn) <= kSmall) {
      if (d.dot(slip) > 0) return {};
      d = (1 - 0.5 * turn * turn) * (d + turn * across);
      const double last = (point.target_velocity - free.x()) / (W(0, 0) + point.friction * along(d));
      return Vec3(last, point.friction * last * d.x(), point.friction * last * d.y());
    }
    d = (d + turn * across).normalized();
  }
  return {};
}

// The impulse that satisfies the laws, given the velocity u with point.impulse acting.
Vec3 impulse_at(const ConeConstraint& point, const Mat3& sticking, const Vec3& u) {
  const Mat3& W = point.inverse_mass;
  const Vec3 free = u - W * point.impulse;  // the velocity there would be without this point's impulse
  if (free.x() >= point.target_velocity && !point.grips) return Vec3::Zero();
  if (W(0, 0) == 0) return Vec3::Zero();
  if (point.friction == 0 && point.response >= 0) return {(point.target_velocity - free.x()) / W(0, 0), 0, 0};
  // Joints may leave fewer ways to move than W has rows.
  if (point.response >= 0) return impulse_in_turns(point, free);
  // Sticking, if the cone allows it.
  const Vec3 stick = sticking * (Vec3(point.target_velocity, 0, 0) - free);
  const double radius = disc(point.friction, stick.x());
  if (stick.x() > 0 && (point.grips || stick.tail<2>().squaredNorm() <= radius * radius)) return stick;
  if (point.grips) {
    const Eigen::Vector2d slip = free.tail<2>(), grip = W.bottomRightCorner<2, 2>().inverse() * -slip;
    return {0, grip.x(), grip.y()};
  }
  if (point.friction == 0) return {(point.target_velocity - free.x()) / W(0, 0), 0, 0};
  const std::optional<Vec3> sliding = sliding_impulse(point, free);
  return sliding ? *sliding : impulse_in_turns(point, free);
}

}  // namespace

int ConeSweeps::place_of(int body) {
  if (body == kWorld || system_.bodies[body].fixed) return -1;
  if (place_[body] < 0) {
    place_[body] = static_cast<int>(bodies_.size());
    bodies_.push_back(body);
  }
  return place_[body];
}

void ConeSweeps::set_up(BodyColumns state, const std::vector<ConeConstraint>& points) {
  for (const int body : bodies_) place_[body] = -1;
  bodies_.clear(), rows_.clear();
  rows_.reserve(points.size());
  change_.assign(points.size(), Vec3::Zero()), change_before_ = change_;
  for (const ConeConstraint& point : points) rows_.push_back(row_of(point));
  read(state);
}

ConeSweeps::Row ConeSweeps::row_of(const ConeConstraint& point) {
  Row row;
  row.given.head<3>() = point.offset;
  const auto add = [&](int body, int end, int& place, Side& by, Effect& to) {
    if (body == kWorld) return;
    place = place_of(body);
    if (place < 0) return;
    for (int axis = 0; axis < 3; ++axis) by.row(axis) = point.row(end, point.frame.col(axis));
    to << system_.bodies[body].inverse_mass * by.topLeftCorner<3, 3>().transpose(),
        inverse_inertia_W_[body] * by.topRightCorner<3, 3>().transpose();
  };
  add(point.a, 0, row.a, row.by_a, row.to_a);
  add(point.b, 1, row.b, row.by_b, row.to_b);
  if (point.response < 0) {
    row.sticking = point.inverse_mass.inverse();
    return row;
  }
  for (const ConeSolver::Change& change : responses_[static_cast<std::size_t>(point.response)]) place_of(change.body);
  return row;
}

void ConeSweeps::read(BodyColumns state) {
  speeds_.clear();
  for (const int body : bodies_) speeds_.push_back(joined(state.velocity(body), state.angular_velocity(body)));
}

void ConeSweeps::write(MutableBodyColumns state) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    state.set_velocity(bodies_[k], speeds_[k].head<3>());
    state.set_angular_velocity(bodies_[k], speeds_[k].tail<3>());
  }
}

Vec3 ConeSweeps::velocity_at(const Row& row) const {
  Eigen::Vector4d u = row.given;
  if (row.a >= 0) u.noalias() += row.by_a * speeds_[row.a];
  if (row.b >= 0) u.noalias() += row.by_b * speeds_[row.b];
  return u.head<3>();
}

void ConeSweeps::push(const ConeConstraint& point, const Row& row, const Vec3& impulse) {
  if (point.response >= 0) {
    for (const ConeSolver::Change& change : responses_[static_cast<std::size_t>(point.response)]) {
      const int place = place_[change.body];
      if (place >= 0) speeds_[place].noalias() += change.by * impulse;
    }
    return;
  }
  if (row.a >= 0) speeds_[row.a].noalias() += row.to_a * impulse;
  if (row.b >= 0) speeds_[row.b].noalias() += row.to_b * impulse;
}

double ConeSweeps::sweep(std::vector<ConeConstraint>& points) {
  double largest = 0;
  change_.swap(change_before_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ConeConstraint& point = points[i];
    const Row& row = rows_[i];
    const Vec3 change = impulse_at(point, row.sticking, velocity_at(row)) - point.impulse;
    change_[i] = change;
    if (change.isZero(0)) continue;
    push(point, row, change);
    point.impulse += change;
    largest = std::max(largest, (point.inverse_mass * change).squaredNorm());
  }
  return std::sqrt(largest);
}

bool ConeSweeps::leap(std::vector<ConeConstraint>& points) {
  constexpr double kAlong = 0.9;                       // the cosine between two changes of one way
  constexpr double kSlowest = 0.995, kQuickest = 0.6;  // ratios of theirs
  double both = 0, before = 0, now = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    both += change_[i].dot(change_before_[i]);
    before += change_before_[i].squaredNorm(), now += change_[i].squaredNorm();
  }
  const double ratio = std::min(both / before, kSlowest);
  if (!(ratio > kQuickest && both * both > kAlong * kAlong * before * now)) return false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 old = points[i].impulse;
    Vec3 p = old + ratio / (1 - ratio) * change_[i];
    p.x() = std::max(0.0, p.x());
    p.tail<2>() = onto_disc(p.tail<2>(), points[i].grips ? kInfiniteFriction : disc(points[i].friction, p.x()));
    push(points[i], rows_[i], p - old);
    points[i].impulse = p;
  }
  return true;
}

}  // namespace rigor::inline dynamics
