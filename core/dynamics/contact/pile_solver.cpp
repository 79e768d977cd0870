#include "core/dynamics/contact/pile_solver.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/dynamics/contact/cone_solver.h"

namespace rigor {
namespace {

constexpr double kDampingRatio = 10;  // of the spring that pushes overlapping bodies apart
constexpr double kSwingsPerSubStep = 0.25;
constexpr int kTurnsOfImpact = 30;  // over the points of an impact, of which few bodies have more than four
constexpr double kFastestPush = 3;  // m/s

// Rows with a colour come first, each colour in whole blocks; a row for which none of the sixty-four is left gets a
// block of its own.
constexpr std::size_t kColours = 64;

void empty(RowBlock& block, std::int32_t nobody) {
  for (auto& column : block.columns) std::fill(std::begin(column), std::end(column), 0.0);
  for (auto* bodies : {&block.a, &block.b, &block.to_a, &block.to_b})
    std::fill(std::begin(*bodies), std::end(*bodies), nobody);
}

double* at(RowBlock& block, int column, std::size_t k) { return &block.columns[column][k]; }
double& value(std::vector<RowBlock>& blocks, int column, std::size_t row) {
  return *at(blocks[row / kRowsPerBlock], column, row % kRowsPerBlock);
}
Vec3 vector(std::vector<RowBlock>& blocks, int column, std::size_t row) {
  return {value(blocks, column, row), value(blocks, column + 1, row), value(blocks, column + 2, row)};
}
void set_vector(std::vector<RowBlock>& blocks, int column, std::size_t row, const Vec3& x) {
  for (int k = 0; k < 3; ++k) value(blocks, column + k, row) = x[k];
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
      colours_of_body_(system.size()) {
  law_.share = share;
  law_.fastest_push = kFastestPush;
  for (AlignedDoubles* records : {&motions_, &changes_, &places_, &turning_})
    records->assign(kRecord * (static_cast<std::size_t>(nobody_) + 1), 0.0);
}

void PileSolver::set_law(double h) {
  const double swing = 2 * std::numbers::pi * kSwingsPerSubStep;  // rad in h
  const double a1 = 2 * kDampingRatio + swing, a2 = swing * a1;
  constexpr double kSubStepsOfFall = 4;
  law_.h = h;
  law_.push_rate = swing / (h * a1), law_.mass_share = a2 / (1 + a2), law_.impulse_share = 1 / (1 + a2);
  law_.rest_speed = kSubStepsOfFall * h * system_.scene_gravity.norm();
}

void PileSolver::begin_step(BodyColumns state, std::vector<PilePoint>& points, double h) {
  points_ = &points;
  const double scale = law_.h > 0 ? h / law_.h : 1;
  set_law(h);
  for (int c = 0; c < kVelocity; ++c) std::copy_n(state.column(c), state.size(), start_.column(c));
  const Bodies bodies = system_.constants.all();
  kernels().read_motions(bodies, state.column(0), motions_.data());
  kernels().read_places(bodies, state.column(0), places_.data(), turning_.data());
  colour_points();
  any_rebound_ = false;
  for (std::size_t i = 0; i < points.size(); ++i) fill_row(points[i], row_of_point_[i], scale);
  kernels().prepare_rows(blocks_.data(), blocks_.size(), records());
}

// Each point gets the first colour that neither of its bodies has yet. A body that does not move may have any.
void PileSolver::colour_points() {
  const std::vector<PilePoint>& points = *points_;
  std::fill(colours_of_body_.begin(), colours_of_body_.end(), 0);
  colour_of_point_.resize(points.size());
  row_of_point_.resize(points.size());
  std::array<std::size_t, kColours + 1> rows{};  // of each colour, and those of none
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint64_t &a = colours_of_body_[points[i].a], &b = colours_of_body_[points[i].b];
    const int colour = std::countr_one(a | b);
    const std::uint64_t bit = colour < 64 ? std::uint64_t{1} << colour : 0;
    if (!system_.bodies[points[i].a].fixed) a |= bit;
    if (!system_.bodies[points[i].b].fixed) b |= bit;
    colour_of_point_[i] = static_cast<std::uint8_t>(colour);
    ++rows[colour];
  }
  std::array<std::size_t, kColours + 1> next{};  // row
  std::size_t block = 0;
  for (std::size_t c = 0; c <= kColours; ++c) {
    next[c] = kRowsPerBlock * block;
    block += c < kColours ? (rows[c] + kRowsPerBlock - 1) / kRowsPerBlock : rows[c];
  }
  blocks_.resize(block);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t colour = colour_of_point_[i], row = next[colour];
    row_of_point_[i] = row;
    next[colour] += colour < kColours ? 1 : kRowsPerBlock;
    if (row % kRowsPerBlock == 0) empty(blocks_[row / kRowsPerBlock], nobody_);
  }
  hits_.resize(kRowsPerBlock * blocks_.size());
}

void PileSolver::fill_row(const PilePoint& point, std::size_t row, double scale) {
  RowBlock& block = blocks_[row / kRowsPerBlock];
  const std::size_t k = row % kRowsPerBlock;
  block.a[k] = point.a, block.b[k] = point.b;
  block.to_a[k] = system_.bodies[point.a].fixed ? nobody_ : point.a;
  block.to_b[k] = system_.bodies[point.b].fixed ? nobody_ : point.b;
  const Mat3 frame = contact_frame(point.normal);
  set_vector(blocks_, kNormal, row, frame.col(0));
  set_vector(blocks_, kTangent, row, frame.col(1));
  set_vector(blocks_, kArmA, row, point.point);
  const Vec3& along = point.friction_impulse;
  set_vector(blocks_, kImpulse, row,
             scale * Vec3(point.normal_impulse, frame.col(1).dot(along), frame.col(2).dot(along)));
  block.columns[kGap][k] = point.gap;
  block.columns[kFriction][k] = point.friction;
  block.columns[kRestitution][k] = point.restitution;
  any_rebound_ = any_rebound_ || point.restitution > 0;
}

void PileSolver::end_step() {
  for (std::size_t i = 0; i < points_->size(); ++i) {
    PilePoint& point = (*points_)[i];
    const Vec3 t = vector(blocks_, kTangent, row_of_point_[i]), p = vector(blocks_, kImpulse, row_of_point_[i]);
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
  for (int k = 0; k < kTurnsOfImpact && hit_count_ > 0; ++k)
    kernels().solve_hits_with_bias(blocks_.data(), hits_.data(), hit_count_, records(), law_);
  const double h = law_.share * law_.h;
  if (state.has_rotation()) turn_matrices(motions_, h, state);
  kernels().follow(bodies, motions_.data(), state.column(0), h);
}

void PileSolver::second_pass(MutableBodyColumns state) {
  kernels().solve_rows(blocks_.data(), blocks_.size(), records());
  for (int k = 0; k < kTurnsOfImpact && any_rebound_; ++k)
    kernels().rebound_hits(blocks_.data(), hits_.data(), hit_count_, records());
  kernels().write_motions(system_.constants.all(), motions_.data(), state.column(0));
}

}  // namespace rigor
