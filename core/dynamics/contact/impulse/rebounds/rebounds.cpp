#include "core/dynamics/contact/impulse/rebounds/rebounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/contact/impulse/contact_row_layout.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kSameInstant = 1e-6;  // of a sub-step
// As a share of the fastest approach: without gravity as a scale, a slower impact is invisible.
constexpr double kLeastImpact = 1e-7;

}  // namespace

Rebounds::Rebounds(const System& system, bool simultaneous)
    : system_(system), simultaneous_(simultaneous), start_(system.size()) {}

void Rebounds::load(BodyColumns state, std::vector<BodyTwist>& out) const {
  out.resize(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) out[i] = {state.velocity(i), state.angular_velocity(i)};
}

void Rebounds::begin(BodyColumns state) { load(state, start_); }

double Rebounds::closing_acceleration(const Row& row) const { return (along(row, start_) - along(row, free_)) / h_; }

double Rebounds::approach_at(const Row& row, double t) const {
  return closing_acceleration(row) * (t - motion_time_) - along(row, now_);
}

double Rebounds::gap_at(const Row& row, double t) const {
  return row.get(kGap) - along(row, delay_) - t * (approach_at(row, 0) + 0.5 * closing_acceleration(row) * t);
}

// Not before the last impact of its bodies.
double Rebounds::hit_of(const Row& row) const {
  const double from =
      std::max(last_[static_cast<std::size_t>(row.a.body)], last_[static_cast<std::size_t>(row.b.body)]);
  const double gap = gap_at(row, from), approach = approach_at(row, from);
  if (gap <= 0) return approach > threshold_ ? from : kNever;
  const double at_hit2 = approach * approach + 2 * closing_acceleration(row) * gap;
  if (!(at_hit2 > threshold_ * threshold_)) return kNever;
  const double twice_mean = approach + std::sqrt(at_hit2);
  // To just beyond the sub-step: a row of balls met at its very end must not stop half-way for roundings.
  if (!(2 * gap <= ((1 + kSameInstant) * h_ - from) * twice_mean)) return kNever;
  return from + 2 * gap / twice_mean;
}

void Rebounds::find_rows(const std::vector<RowGroup>& groups) {
  rows_.clear();
  double fastest = 0;
  for (const RowGroup& group : groups) {
    for (std::size_t k = 0; k < kRowsPerBlock; ++k) {
      for (std::size_t point = 0; point < static_cast<std::size_t>(group.points); ++point) {
        if (group.block(point)[kInitialGap * kRowsPerBlock + k] >= ContactRowLayout::kNoPoint) continue;
        rows_.push_back(row_of(group, point, k));
        fastest = std::max(fastest, rows_.back().get(kApproachSpeed));
      }
    }
  }
  threshold_ = std::max(threshold_, kLeastImpact * fastest);
}

Rebounds::Row Rebounds::row_of(const RowGroup& group, std::size_t point, std::size_t k) const {
  Row row{group.block(point) + k,
          {group.a[k], 0, Vec3::Zero(), {}},
          {group.b[k], 0, Vec3::Zero(), {}},
          Vec3::Zero(),
          kNever};
  for (ImpactEnd* end : {&row.a, &row.b})
    end->inverse_mass = system_.bodies[static_cast<std::size_t>(end->body)].inverse_mass;
  row.normal = row.get3(kNormal);
  row.a.arm = group.of_balls ? Vec3(-row.get(kLengthA) * row.normal) : row.get3(kArmA);
  row.b.arm = group.of_balls ? Vec3(row.get(kLengthB) * row.normal) : row.get3(kArmB);
  return row;
}

// For the rows whose bodies the last round has changed, or for all rows; and the next of each body.
void Rebounds::find_hits(bool all) {
  std::fill(next_.begin(), next_.end(), kNever);
  for (Row& row : rows_) {
    const auto a = static_cast<std::size_t>(row.a.body), b = static_cast<std::size_t>(row.b.body);
    if (all || is_new_[a] || is_new_[b]) row.hit = hit_of(row);
    if (row.hit == kNever) continue;
    for (const std::size_t body : {a, b}) next_[body] = std::min(next_[body], row.hit);
  }
}

void Rebounds::choose() {
  impacts_.clear(), rows_of_impacts_.clear();
  std::fill(is_new_.begin(), is_new_.end(), 0);
  const auto is_next = [&](const Row& row, int body) {
    return !moves(body) || row.hit <= next_[static_cast<std::size_t>(body)] + kSameInstant * h_;
  };
  for (const Row& row : rows_) {
    if (row.hit == kNever || !is_next(row, row.a.body) || !is_next(row, row.b.body)) continue;
    add(row, row.hit, row.get(kRestitution) * approach_at(row, row.hit), 0);
  }
  if (!impacts_.empty()) add_resting();
}

// Contacts of a round's bodies, and their contacts in turn, must not be pushed into each other.
void Rebounds::add_resting() {
  std::vector<char> is_taken(rows_.size(), 0);
  for (bool is_more = true; is_more;) {
    is_more = false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Row& row = rows_[i];
      const auto a = static_cast<std::size_t>(row.a.body), b = static_cast<std::size_t>(row.b.body);
      const bool is_reached = is_new_[a] || is_new_[b];
      if (is_taken[i] || row.hit != kNever || row.get(kGap) > touching_ || !is_reached) continue;
      if (row.get(kRestitution) > 0 && !simultaneous_) continue;
      const double instant = std::max(last_[a], last_[b]), wanted = std::min(0.0, -approach_at(row, instant));
      add(row, instant, wanted, wanted);
      is_taken[i] = 1, is_more = true;
    }
  }
}

// `wanted`, at the instant: with restitution and without.
void Rebounds::add(const Row& row, double instant, double wanted, double wanted_without) {
  Impact impact{
      row.a,          row.b,       {row.normal, row.normal.unitOrthogonal(), {}}, instant, row.get(kFriction), wanted,
      wanted_without, Vec3::Zero()};
  impact.directions[2] = impact.directions[0].cross(impact.directions[1]);
  impact.shift = (instant - motion_time_) / h_ *
                 (relative_velocity(row.a, row.b, free_) - relative_velocity(row.a, row.b, start_));
  for (ImpactEnd* end : {&impact.a, &impact.b}) {
    set_response(*end, impact);
    if (!moves(end->body)) continue;
    const auto i = static_cast<std::size_t>(end->body);
    is_new_[i] = 1, last_[i] = std::max(last_[i], instant);
  }
  prepare(impact);
  impacts_.push_back(impact);
  rows_of_impacts_.push_back(row.first);
}

// Uses the inertia in the body's orientation at the instant.
void Rebounds::set_response(ImpactEnd& end, const Impact& impact) const {
  const auto i = static_cast<std::size_t>(end.body);
  const Inertia& body = system_.bodies[i];
  if (body.fixed) return;
  const Mat3 R = matrix_of(rotation_by((impact.instant - h_) * free_[i].w)) * state_.rotation(i);
  for (int d = 0; d < 3; ++d) {
    const Vec3 torque_B = R.transpose() * end.arm.cross(impact.directions[d]);
    end.angular[d] = R * (body.inverse_inertia_B * torque_B);
  }
}

void Rebounds::commit_round() {
  for (std::size_t n = 0; n < impacts_.size(); ++n) {
    const Impact& impact = impacts_[n];
    const Vec3* d = impact.directions;
    const Vec3 impulse = impact.impulse.x() * d[0] + impact.impulse.y() * d[1] + impact.impulse.z() * d[2];
    impulses_.push_back({rows_of_impacts_[n], impulse});
    for (const double sign : {1.0, -1.0}) {
      const ImpactEnd& end = sign > 0 ? impact.a : impact.b;
      const auto i = static_cast<std::size_t>(end.body);
      if (!moves(end.body)) continue;
      is_changed_[i] = 1;
      angular_impulse_[i] += sign * end.arm.cross(impulse);
      delay_[i].v += sign * impact.instant * end.inverse_mass * impulse;
      for (int k = 0; k < 3; ++k) delay_[i].w += sign * impact.instant * impact.impulse[k] * end.angular[k];
    }
  }
}

// To where the changed motions lead; angular momenta are kept on the way.
void Rebounds::move(MutableBodyColumns state) {
  std::vector<Vec3> momentum(state.size(), Vec3::Zero());
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!is_changed_[i]) continue;
    momentum[i] = angular_momentum_of(system_.bodies[i], state.rotation(i), free_[i].w);
    state.set_position(i, state.position(i) + h_ * (now_[i].v - free_[i].v) - delay_[i].v);
    const Quat turn = rotation_by(h_ * (now_[i].w - free_[i].w) - delay_[i].w);
    if (state.has_rotation()) state.set_rotation(i, matrix_of(turn) * state.rotation(i));
    state.set_orientation(i, (turn * state.orientation(i)).normalized());
  }
  const double share = share_without_gain(state, momentum);
  for (RowImpulse& given : impulses_) given.impulse *= share;
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!is_changed_[i]) continue;
    const Vec3 L = momentum[i] + share * angular_impulse_[i];
    now_[i] = {free_[i].v + share * (now_[i].v - free_[i].v),
               angular_velocity_of(system_.bodies[i], state.rotation(i), L)};
    state.set_velocity(i, now_[i].v), state.set_angular_velocity(i, now_[i].w);
  }
}

// The rotation within the sub-step after an impact is known only to second order, and may add energy of that order. s
// is the share of the changes of motion at which it does not: c + 2 b s + a s² = 0, twice the added energy.
double Rebounds::share_without_gain(BodyColumns moved, const std::vector<Vec3>& momentum) const {
  double a = 0, b = 0, c = 0, scale = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!is_changed_[i]) continue;
    const Inertia& body = system_.bodies[i];
    const Vec3 acceleration = (free_[i].v - start_[i].v) / h_, change = now_[i].v - free_[i].v,
               v = free_[i].v + (h_ - motion_time_) * acceleration, farther = h_ * change - delay_[i].v;
    const Vec3 &w = free_[i].w, &impulse = angular_impulse_[i];
    const Vec3& L = momentum[i];
    const Vec3 response = angular_velocity_of(body, moved.rotation(i), impulse);
    a += body.mass * change.squaredNorm() + impulse.dot(response);
    b += body.mass * (v.dot(change) - acceleration.dot(farther)) + L.dot(response);
    c += L.dot(angular_velocity_of(body, moved.rotation(i), L)) - L.dot(w);
    scale += body.mass * v.squaredNorm() + L.dot(w);
  }
  constexpr double kRounding = 1e-15;
  if (!(c + 2 * b + a > kRounding * scale) || a == 0) return 1;
  return std::clamp((std::sqrt(std::max(0.0, b * b - a * c)) - b) / a, 0.0, 1.0);
}

// As prepare_bias(), but from the gap and the velocity at the sub-step's end.
void Rebounds::update_biases(const SolverParameters& parameters) {
  for (Row& row : rows_) {
    const bool is_changed =
        is_changed_[static_cast<std::size_t>(row.a.body)] || is_changed_[static_cast<std::size_t>(row.b.body)];
    if (!is_changed || row.get(kGap) <= parameters.touching) continue;
    row.at(kBias) = gap_at(row, h_) / (parameters.h * parameters.theta) - along(row, now_);
  }
}

void Rebounds::resolve(const std::vector<RowGroup>& groups, const SolverParameters& parameters,
                       MutableBodyColumns state) {
  h_ = parameters.h, motion_time_ = (1.5 - parameters.theta) * h_, threshold_ = parameters.restitution_threshold;
  touching_ = parameters.touching;
  state_ = state;
  load(state, free_);
  now_ = free_;
  delay_.assign(state.size(), BodyTwist());
  angular_impulse_.assign(state.size(), Vec3::Zero());
  last_.assign(state.size(), 0.0), next_.assign(state.size(), kNever);
  is_changed_.assign(state.size(), 0), is_new_.assign(state.size(), 0);
  impulses_.clear();
  find_rows(groups);
  find_hits(true);
  int rounds = 0;
  for (; rounds < kMostRounds; ++rounds) {
    choose();
    if (impacts_.empty()) break;
    solve_round(impacts_, now_);
    commit_round();
    find_hits(false);
  }
  if (rounds == 0) return;
  move(state);
  update_biases(parameters);
}

}  // namespace rigor::inline dynamics
