#include "core/dynamics/contact/impulse/sequential_impulses.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace rigor {
namespace {

constexpr double kDampingRatio = 10;  // of the spring that pushes overlapping bodies apart
constexpr double kSwingsPerSubStep = 0.25;
constexpr int kTurnsOfImpact = 30;  // over the points of an impact, of which few bodies have more than four,
constexpr double kSettled = 1e-3;   // of the speed from which on it is one: what a turn may change and be the last
constexpr double kFastestPush = 3;  // m/s

void set_vector(RowBlock& block, int column, std::size_t k, const Vec3& x) {
  for (int c = 0; c < 3; ++c) block.columns[column + c][k] = x[c];
}
Vec3 vector(const RowBlock& block, int column, std::size_t k) {
  return {block.columns[column][k], block.columns[column + 1][k], block.columns[column + 2][k]};
}

// With rows that nothing acts on.
void empty(RowBlock& block, std::int32_t nobody) {
  for (auto& column : block.columns) std::fill(std::begin(column), std::end(column), 0.0);
  std::fill(std::begin(block.columns[kNormal]), std::end(block.columns[kNormal]), 1.0);
  for (auto* bodies : {&block.a, &block.b}) std::fill(std::begin(*bodies), std::end(*bodies), nobody);
  for (auto* bodies : {&block.to_a, &block.to_b}) std::fill(std::begin(*bodies), std::end(*bodies), nobody + 1);
}

// What follow() does to the orientations of a method that keeps matrices.
void turn_matrices(const AlignedDoubles& motions, double h, MutableBodyColumns state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vec3 w = Eigen::Map<const Vec3>(motions.data() + kRecord * i + 3);
    const Vec3 turn = h * (w - state.angular_velocity(i));
    if (!turn.isZero(0)) state.set_rotation(i, rotation_by(turn).toRotationMatrix() * state.rotation(i));
  }
}

}  // namespace

PileSolver::PileSolver(const System& system, double share)
    : system_(system),
      nobody_(static_cast<std::int32_t>(column_stride(system.size()))),
      start_(kVelocity, system.size()),
      next_level_(system.size()) {
  law_.share = share;
  law_.fastest_push = kFastestPush;
  law_.most_turns = kTurnsOfImpact;
  for (AlignedDoubles* records : {&motions_, &changes_, &inertias_})
    records->assign(kRecord * (static_cast<std::size_t>(nobody_) + 2), 0.0);
  stirred_.assign(static_cast<std::size_t>(nobody_) + 2, 0);
  inertias_[kRecord * static_cast<std::size_t>(nobody_) + 6] = 1;  // 1/kg, of which rows divide by the sum
}

void PileSolver::set_law(double h) {
  const double swing = 2 * std::numbers::pi * kSwingsPerSubStep;  // rad in h
  const double a1 = 2 * kDampingRatio + swing, a2 = swing * a1;
  constexpr double kSubStepsOfFall = 4;
  law_.h = h;
  law_.push_rate = swing / (h * a1), law_.mass_share = a2 / (1 + a2), law_.impulse_share = 1 / (1 + a2);
  law_.rest_speed = kSubStepsOfFall * h * system_.scene_gravity.norm();
  law_.settled = kSettled * law_.rest_speed;
}

void PileSolver::begin_stretch(BodyColumns state, std::vector<PilePoint>& points, double h) {
  points_ = &points;
  const double scale = law_.h > 0 ? h / law_.h : 1;
  set_law(h);
  for (int c = 0; c < kVelocity; ++c) std::copy_n(state.column(c), state.size(), start_.column(c));
  const Bodies bodies = system_.constants.all();
  kernels().read_motions(bodies, state.column(0), motions_.data());
  kernels().read_inertias(bodies, state.column(0), inertias_.data());
  sort_pairs_in_levels();
  place_points();
  any_rebound_ = false;
  for (std::size_t i = 0; i < points.size(); ++i) fill_row(points[i], row_of_point_[i], scale);
  kernels().prepare_rows(blocks_.data(), blocks_.size(), records());
}

// A pair comes one level after the last that shares with it a body that moves, so that going through the levels is
// going through the pairs.
void PileSolver::sort_pairs_in_levels() {
  const std::vector<PilePoint>& points = *points_;
  std::fill(next_level_.begin(), next_level_.end(), 0);
  pairs_.clear();
  pairs_of_level_.clear();
  for (std::size_t first = 0; first < points.size(); first += pairs_.back().points) {
    const auto [a, b] = std::pair(points[first].a, points[first].b);
    std::size_t last = first + 1;
    while (last < points.size() && points[last].a == a && points[last].b == b) ++last;
    const std::size_t level = std::max(next_level_[a], next_level_[b]);
    if (level == pairs_of_level_.size()) pairs_of_level_.push_back(0);
    for (const int body : {a, b}) next_level_[body] = system_.bodies[body].fixed ? 0 : level + 1;
    pairs_.push_back({first, last - first, level, pairs_of_level_[level]++});
  }
}

// Up to eight pairs of one level lie side by side, the points of each one after another in as many blocks as the one of
// most points needs.
void PileSolver::place_points() {
  std::vector<std::size_t>& first_group = pairs_of_level_;
  std::size_t groups = 0;
  for (std::size_t& level : first_group) groups += (std::exchange(level, groups) + kRowsPerBlock - 1) / kRowsPerBlock;
  const auto group_of = [&](const Pair& pair) { return first_group[pair.level] + pair.of_level / kRowsPerBlock; };
  first_block_.assign(groups + 1, 0);
  for (const Pair& pair : pairs_) {
    std::size_t& height = first_block_[group_of(pair) + 1];
    height = std::max(height, pair.points);
  }
  std::partial_sum(first_block_.begin(), first_block_.end(), first_block_.begin());
  blocks_.resize(first_block_.back());
  hits_.resize(kRowsPerBlock * blocks_.size());
  for (RowBlock& block : blocks_) empty(block, nobody_);
  row_of_point_.resize(points_->size());
  for (const Pair& pair : pairs_) {
    const std::size_t row = kRowsPerBlock * first_block_[group_of(pair)] + pair.of_level % kRowsPerBlock;
    for (std::size_t k = 0; k < pair.points; ++k) row_of_point_[pair.first + k] = row + kRowsPerBlock * k;
  }
}

void PileSolver::fill_row(const PilePoint& point, std::size_t row, double scale) {
  RowBlock& block = blocks_[row / kRowsPerBlock];
  const std::size_t k = row % kRowsPerBlock;
  block.a[k] = point.a, block.b[k] = point.b;
  block.to_a[k] = system_.bodies[point.a].fixed ? nobody_ + 1 : point.a;
  block.to_b[k] = system_.bodies[point.b].fixed ? nobody_ + 1 : point.b;
  set_vector(block, kNormal, k, point.normal);
  set_vector(block, kArmA, k, point.arm_a), set_vector(block, kArmB, k, point.arm_b);
  set_vector(block, kSpinA, k, scale * point.friction_impulse);
  block.columns[kImpulse][k] = scale * point.normal_impulse;
  block.columns[kGap][k] = point.gap;
  block.columns[kFriction][k] = point.friction;
  block.columns[kRestitution][k] = point.restitution;
  any_rebound_ = any_rebound_ || point.restitution > 0;
}

void PileSolver::end_stretch() {
  for (std::size_t i = 0; i < points_->size(); ++i) {
    PilePoint& point = (*points_)[i];
    const RowBlock& block = blocks_[row_of_point_[i] / kRowsPerBlock];
    const std::size_t k = row_of_point_[i] % kRowsPerBlock;
    const Vec3 t = vector(block, kTangent, k), p = vector(block, kImpulse, k);
    point.normal_impulse = p.x();
    point.friction_impulse = p.y() * t + p.z() * point.normal.cross(t);
  }
}

// The gaps and the speeds at which they close, before the bodies move. The motions are those the last pass has left.
void PileSolver::begin_sub_step(BodyColumns state) {
  kernels().measure_changes(system_.constants.all(), state.column(0), start_.data(), changes_.data());
  hit_count_ = kernels().measure_gaps(blocks_.data(), blocks_.size(), records(), law_, hits_.data());
}

// After the bodies have moved freely: impulses first, with what the sub-step before needed; then each point in turn,
// with its bias; and the way that follows from them, of which the free sub-step knew nothing.
void PileSolver::first_pass(MutableBodyColumns state) {
  const Bodies bodies = system_.constants.all();
  kernels().read_motions(bodies, state.column(0), motions_.data());
  kernels().push_rows(blocks_.data(), blocks_.size(), records());
  kernels().solve_rows_with_bias(blocks_.data(), blocks_.size(), records(), law_);
  // What comes down flat must not be set turning by which of its corners is taken first.
  kernels().settle_hits_with_bias(blocks_.data(), hits_.data(), hit_count_, records(), law_);
  const double h = law_.share * law_.h;
  if (state.has_rotation()) turn_matrices(motions_, h, state);
  kernels().follow(bodies, motions_.data(), state.column(0), h);
}

void PileSolver::second_pass(MutableBodyColumns state) {
  kernels().solve_rows(blocks_.data(), blocks_.size(), records());
  if (any_rebound_) kernels().settle_rebounds(blocks_.data(), hits_.data(), hit_count_, records(), law_);
  kernels().write_motions(system_.constants.all(), motions_.data(), state.column(0));
}

}  // namespace rigor
