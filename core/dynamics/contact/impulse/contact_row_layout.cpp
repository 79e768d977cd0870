#include "core/dynamics/contact/impulse/contact_row_layout.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rigor {
namespace {

void set_vector(RowBlock& block, int column, std::size_t k, const Vec3& x) {
  for (int c = 0; c < 3; ++c) block.columns[column + c][k] = x[c];
}
Vec3 vector(const RowBlock& block, int column, std::size_t k) {
  return {block.columns[column][k], block.columns[column + 1][k], block.columns[column + 2][k]};
}

// With rows that nothing acts on.
void clear(RowBlock& block, std::int32_t idle) {
  for (auto& column : block.columns) std::fill(std::begin(column), std::end(column), 0.0);
  std::fill(std::begin(block.columns[kNormal]), std::end(block.columns[kNormal]), 1.0);
  for (auto* bodies : {&block.a, &block.b}) std::fill(std::begin(*bodies), std::end(*bodies), idle);
  for (auto* bodies : {&block.to_a, &block.to_b}) std::fill(std::begin(*bodies), std::end(*bodies), idle + 1);
}

}  // namespace

ContactRowLayout::ContactRowLayout(const System& system)
    : system_(system), idle_(static_cast<std::int32_t>(column_stride(system.size()))), next_level_(system.size()) {}

void ContactRowLayout::assign(const std::vector<ContactConstraint>& constraints, double impulse_scale) {
  sort_pairs_in_levels(constraints);
  place_rows(constraints.size());
  has_restitution_ = false;
  deep_rows_.clear();
  for (std::size_t i = 0; i < constraints.size(); ++i) fill_row(constraints[i], row_of_constraint_[i], impulse_scale);
}

void ContactRowLayout::sort_pairs_in_levels(const std::vector<ContactConstraint>& constraints) {
  std::fill(next_level_.begin(), next_level_.end(), 0);
  pairs_.clear();
  pairs_of_level_.clear();
  for (std::size_t first = 0; first < constraints.size(); first += pairs_.back().points) {
    const auto [a, b] = std::pair(constraints[first].a, constraints[first].b);
    std::size_t last = first + 1;
    while (last < constraints.size() && constraints[last].a == a && constraints[last].b == b) ++last;
    const std::size_t level = std::max(next_level_[a], next_level_[b]);
    if (level == pairs_of_level_.size()) pairs_of_level_.push_back(0);
    for (const int body : {a, b}) next_level_[body] = system_.bodies[body].fixed ? 0 : level + 1;
    pairs_.push_back({first, last - first, level, pairs_of_level_[level]++});
  }
}

// Up to eight pairs of one level lie side by side, the constraints of each one after another in as many blocks as the
// pair of most constraints needs.
void ContactRowLayout::place_rows(std::size_t constraints) {
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
  for (RowBlock& block : blocks_) clear(block, idle_);
  row_of_constraint_.resize(constraints);
  for (const Pair& pair : pairs_) {
    const std::size_t row = kRowsPerBlock * first_block_[group_of(pair)] + pair.of_level % kRowsPerBlock;
    for (std::size_t k = 0; k < pair.points; ++k) row_of_constraint_[pair.first + k] = row + kRowsPerBlock * k;
  }
}

void ContactRowLayout::fill_row(const ContactConstraint& constraint, std::size_t row, double impulse_scale) {
  RowBlock& block = blocks_[row / kRowsPerBlock];
  const std::size_t k = row % kRowsPerBlock;
  block.a[k] = constraint.a, block.b[k] = constraint.b;
  block.to_a[k] = system_.bodies[constraint.a].fixed ? idle_ + 1 : constraint.a;
  block.to_b[k] = system_.bodies[constraint.b].fixed ? idle_ + 1 : constraint.b;
  set_vector(block, kNormal, k, constraint.normal);
  set_vector(block, kArmA, k, constraint.arm_a), set_vector(block, kArmB, k, constraint.arm_b);
  set_vector(block, kAngularA, k, impulse_scale * constraint.friction_impulse);  // see kAngularA
  block.columns[kImpulse][k] = impulse_scale * constraint.normal_impulse;
  block.columns[kInitialGap][k] = constraint.gap;
  block.columns[kFriction][k] = constraint.friction;
  block.columns[kRestitution][k] = constraint.restitution;
  has_restitution_ = has_restitution_ || constraint.restitution > 0;
  if (constraint.is_deep) deep_rows_.push_back(static_cast<std::int32_t>(row));
}

void ContactRowLayout::store_impulses(std::vector<ContactConstraint>& constraints) const {
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    ContactConstraint& constraint = constraints[i];
    const RowBlock& block = blocks_[row_of_constraint_[i] / kRowsPerBlock];
    const std::size_t k = row_of_constraint_[i] % kRowsPerBlock;
    const Vec3 t = vector(block, kTangent, k), p = vector(block, kImpulse, k);
    constraint.normal_impulse = p.x();
    constraint.friction_impulse = p.y() * t + p.z() * constraint.normal.cross(t);
  }
}

}  // namespace rigor
