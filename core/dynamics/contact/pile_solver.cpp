#include "core/dynamics/contact/pile_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/dynamics/contact/cone_solver.h"

namespace rigor {
namespace {

constexpr double kDampingRatio = 10;  // of the spring that pushes overlapping bodies apart
constexpr double kSwingsPerSubStep = 0.25;
constexpr double kFastestPush = 3;  // m/s

Eigen::Vector2d onto_disc(const Eigen::Vector2d& p, double radius) {
  const double size2 = p.squaredNorm();
  return size2 <= radius * radius ? p : Eigen::Vector2d(p * (radius / std::sqrt(size2)));
}

}  // namespace

PileSolver::PileSolver(const System& system, const std::vector<Collider>& colliders, double share)
    : system_(system), colliders_(colliders), share_(share), motions_(system.size()) {
  for (std::size_t i = 0; i < motions_.size(); ++i) motions_[i].inverse_mass = system.bodies[i].inverse_mass;
}

void PileSolver::read(BodyColumns state) {
  for (const Collider& collider : colliders_) {
    if (collider.fixed) continue;
    Motion& motion = motions_[collider.body];
    motion.v = state.velocity(collider.body);
    motion.w = state.angular_velocity(collider.body);
  }
}

void PileSolver::write(MutableBodyColumns state) const {
  for (const Collider& collider : colliders_) {
    if (collider.fixed) continue;
    state.set_velocity(collider.body, motions_[collider.body].v);
    state.set_angular_velocity(collider.body, motions_[collider.body].w);
  }
}

void PileSolver::begin_step(BodyColumns state, std::vector<PilePoint>& points, double h) {
  points_ = &points;
  old_h_ = h_ > 0 ? h_ : h;
  h_ = h;
  const double swing = 2 * std::numbers::pi * kSwingsPerSubStep;  // rad in h
  const double a1 = 2 * kDampingRatio + swing, a2 = swing * a1;
  push_rate_ = swing / (h * a1), mass_share_ = a2 / (1 + a2), impulse_share_ = 1 / (1 + a2);
  constexpr double kSubStepsOfFall = 4;
  rest_speed_ = kSubStepsOfFall * h * system_.scene_gravity.norm();
  for (const Collider& collider : colliders_) {
    const int i = collider.body;
    Motion& motion = motions_[i];
    motion.start = state.position(i);
    motion.start_orientation = state.orientation(i);
    if (collider.fixed) continue;
    const Mat3 R = state.rotation(i);
    motion.inverse_inertia = R * system_.bodies[i].inverse_inertia_B * R.transpose();
  }
  rows_.clear();
  any_rebound_ = false;
  for (const PilePoint& point : points) add_row(point);
}

void PileSolver::add_row(const PilePoint& point) {
  const Motion &a = motions_[point.a], &b = motions_[point.b];
  const Mat3 frame = contact_frame(point.normal);
  rows_.emplace_back();
  Row& row = rows_.back();
  row.a = point.a, row.b = point.b;
  row.n = frame.col(0), row.t = frame.col(1), row.s = frame.col(2);
  row.arm_a = point.point - a.start, row.arm_b = point.point - b.start;
  row.gap = point.gap;
  const auto spin = [](const Motion& m, const Vec3& turn) { return Vec3(m.inverse_inertia * turn); };
  row.arm_a_n = row.arm_a.cross(row.n), row.arm_b_n = row.arm_b.cross(row.n);
  row.spin_a_n = spin(a, row.arm_a_n), row.spin_b_n = spin(b, row.arm_b_n);
  const double free = a.inverse_mass + b.inverse_mass;
  row.give_n = free + row.arm_a_n.dot(row.spin_a_n) + row.arm_b_n.dot(row.spin_b_n);
  const Vec3 at = row.arm_a.cross(row.t), bt = row.arm_b.cross(row.t), as = row.arm_a.cross(row.s),
             bs = row.arm_b.cross(row.s);
  const Vec3 spin_at = spin(a, at), spin_bt = spin(b, bt);
  const double tt = free + at.dot(spin_at) + bt.dot(spin_bt);
  const double ss = free + as.dot(spin(a, as)) + bs.dot(spin(b, bs)), ts = as.dot(spin_at) + bs.dot(spin_bt);
  row.inverse_t << ss, -ts, -ts, tt;
  row.inverse_t /= tt * ss - ts * ts;
  row.pace_t = 1 / (0.5 * (tt + ss) + std::hypot(0.5 * (tt - ss), ts));
  row.friction = point.friction, row.restitution = point.restitution;
  any_rebound_ = any_rebound_ || point.restitution > 0;
  const double scale = h_ / old_h_;
  row.p_n = scale * point.normal_impulse;
  row.p_t = scale * Eigen::Vector2d(row.t.dot(point.friction_impulse), row.s.dot(point.friction_impulse));
}

void PileSolver::end_step() {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    PilePoint& point = (*points_)[i];
    point.normal_impulse = row.p_n, point.friction_impulse = row.p_t.x() * row.t + row.p_t.y() * row.s;
  }
}

double PileSolver::normal_velocity(const Row& row) const {
  const Motion &a = motions_[row.a], &b = motions_[row.b];
  return row.n.dot(a.v - b.v) + row.arm_a_n.dot(a.w) - row.arm_b_n.dot(b.w);
}

void PileSolver::push_normal(const Row& row, double n) {
  Motion &a = motions_[row.a], &b = motions_[row.b];
  a.v += a.inverse_mass * n * row.n, a.w += n * row.spin_a_n;
  b.v -= b.inverse_mass * n * row.n, b.w -= n * row.spin_b_n;
}

void PileSolver::push(const Row& row, double n, const Eigen::Vector2d& t) {
  Motion &a = motions_[row.a], &b = motions_[row.b];
  const Vec3 impulse = n * row.n + t.x() * row.t + t.y() * row.s;
  a.v += a.inverse_mass * impulse, a.w += a.inverse_inertia * row.arm_a.cross(impulse);
  b.v -= b.inverse_mass * impulse, b.w -= b.inverse_inertia * row.arm_b.cross(impulse);
}

// The gaps and the speeds at which they close, before the bodies move.
void PileSolver::begin_sub_step(BodyColumns state) {
  read(state);
  for (const Collider& collider : colliders_) {
    if (collider.fixed) continue;
    Motion& motion = motions_[collider.body];
    motion.way = state.position(collider.body) - motion.start;
    const Quat turn = state.orientation(collider.body) * motion.start_orientation.conjugate();
    motion.turn = (turn.w() < 0 ? -2.0 : 2.0) * turn.vec();
  }
  for (Row& row : rows_) {
    const Motion &a = motions_[row.a], &b = motions_[row.b];
    row.gap_now = row.gap + row.n.dot(a.way - b.way) + row.arm_a_n.dot(a.turn) - row.arm_b_n.dot(b.turn);
    row.approach = -normal_velocity(row);
  }
}

// After the bodies have moved freely: impulses first, with what the sub-step before needed; then each point in turn,
// with its bias; and the way that follows from them.
void PileSolver::first_pass(MutableBodyColumns state) {
  read(state);
  for (Motion& motion : motions_) motion.free_v = motion.v, motion.free_w = motion.w;
  for (Row& row : rows_) {
    if (row.p_n != 0) push(row, row.p_n, row.p_t);
  }
  for (Row& row : rows_) {
    double bias, mass_share = 1, impulse_share = 0;
    if (row.gap_now < 0) {
      bias = std::max(push_rate_ * row.gap_now, -kFastestPush);
      mass_share = mass_share_, impulse_share = impulse_share_;
    } else {
      // The gap closes by h (share u' + (1 - share) u), of which only the velocity after, u', can be chosen.
      bias = (row.gap_now / h_ - (1 - share_) * row.approach) / share_;
    }
    const double wanted = -mass_share * (normal_velocity(row) + bias) / row.give_n - impulse_share * row.p_n;
    const double p_n = std::max(0.0, row.p_n + wanted);
    if (p_n != row.p_n) push_normal(row, p_n - row.p_n);
    row.p_n = p_n;
    solve_friction(row);
  }
  write(state);
  follow(state);
}

void PileSolver::solve_friction(Row& row) {
  if (row.friction == 0 || (row.p_n == 0 && row.p_t.isZero(0))) return;
  const Motion &a = motions_[row.a], &b = motions_[row.b];
  const Vec3 u = a.v + a.w.cross(row.arm_a) - b.v - b.w.cross(row.arm_b);
  const Eigen::Vector2d slip(row.t.dot(u), row.s.dot(u));
  const double radius = row.p_n > 0 ? row.friction * row.p_n : 0;  // may be infinite
  Eigen::Vector2d p_t = row.p_t - row.inverse_t * slip;            // what would stop it
  // On the rim the impulse must look straight against the slip, which only a step of one pace for all directions ends
  // in.
  if (p_t.squaredNorm() > radius * radius) p_t = onto_disc(row.p_t - row.pace_t * slip, radius);
  push(row, 0, p_t - row.p_t);
  row.p_t = p_t;
}

// Positions follow the change of the velocities since read(), which the free sub-step knew nothing of.
void PileSolver::follow(MutableBodyColumns state) const {
  for (const Collider& collider : colliders_) {
    if (collider.fixed) continue;
    const int i = collider.body;
    const Motion& motion = motions_[i];
    const Vec3 way = share_ * h_ * (motion.v - motion.free_v), turn = share_ * h_ * (motion.w - motion.free_w);
    if (way.isZero(0) && turn.isZero(0)) continue;
    state.set_position(i, state.position(i) + way);
    const Quat rotation = rotation_by(turn);
    state.set_orientation(i, (rotation * state.orientation(i)).normalized());
    if (state.has_rotation()) state.set_rotation(i, rotation.toRotationMatrix() * state.rotation(i));
  }
}

void PileSolver::second_pass(MutableBodyColumns state) {
  for (Row& row : rows_) {
    if (row.p_n == 0) continue;
    const double p_n = std::max(0.0, row.p_n - normal_velocity(row) / row.give_n);
    if (p_n != row.p_n) push_normal(row, p_n - row.p_n);
    row.p_n = p_n;
    solve_friction(row);
  }
  if (any_rebound_) rebound();
  write(state);
}

void PileSolver::rebound() {
  for (Row& row : rows_) {
    if (row.restitution == 0 || row.approach <= rest_speed_ || row.p_n == 0) continue;
    const double wanted = (row.restitution * row.approach - normal_velocity(row)) / row.give_n;
    const double p_n = std::max(0.0, row.p_n + wanted);
    push_normal(row, p_n - row.p_n);
    row.p_n = p_n;
  }
}

}  // namespace rigor
