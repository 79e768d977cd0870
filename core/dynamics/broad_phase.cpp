#include "core/dynamics/broad_phase.h"

#include <algorithm>

namespace rigor {
namespace {

// Twenty-one bits an axis. Cells far apart may share a number, which costs a look and loses no pair.
std::uint64_t cell_number(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  return (static_cast<std::uint64_t>(x) & kMask) << 42 | (static_cast<std::uint64_t>(y) & kMask) << 21 |
         (static_cast<std::uint64_t>(z) & kMask);
}

// Cells are as wide as the largest ball and twice the slack, so that balls that may meet lie in the same cell or in
// neighbouring ones. Where
// a centre is not finite or out of all bounds, its cell does not matter.
std::int64_t cell_index(double coordinate, double width) {
  constexpr double kFar = 1e15;
  const double index = std::floor(coordinate / width);
  return std::abs(index) < kFar ? static_cast<std::int64_t>(index) : 0;
}

bool overlap(const Ball& a, const Ball& b) {
  const double reach = a.radius + b.radius;
  return (a.centre - b.centre).squaredNorm() < reach * reach;
}

}  // namespace

const std::vector<std::pair<int, int>>& BroadPhase::overlaps(const std::vector<Ball>& balls) {
  if (!still_holds(balls)) {
    choose_slack(balls);
    search(balls);
  }
  ++steps_held_;
  pairs_.clear();
  for (const auto& [a, b] : near_) {
    if (overlap(balls[a], balls[b])) pairs_.emplace_back(a, b);
  }
  return pairs_;
}

bool BroadPhase::still_holds(const std::vector<Ball>& balls) const {
  if (balls.size() != found_at_.size()) return false;
  bool holds = true;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vec3 moved = (balls[i].centre - found_at_[i].centre).cwiseAbs();
    holds &= moved.x() <= slack_.x() && moved.y() <= slack_.y() && moved.z() <= slack_.z() &&
             balls[i].radius == found_at_[i].radius;
  }
  return holds;
}

// From what the balls moved in a step since the last search. Fewer steps if that search found many pairs, for each
// costs a look in every step.
void BroadPhase::choose_slack(const std::vector<Ball>& balls) {
  constexpr double kMostSteps = 64;
  constexpr std::size_t kMostPairsOfBall = 4;
  steps_to_hold_ = near_.size() > kMostPairsOfBall * balls.size() ? std::max(1.0, steps_to_hold_ / 2)
                                                                  : std::min(kMostSteps, steps_to_hold_ * 2);
  Vec3 moved = Vec3::Zero();
  if (balls.size() == found_at_.size()) {
    for (std::size_t i = 0; i < balls.size(); ++i)
      moved = moved.cwiseMax((balls[i].centre - found_at_[i].centre).cwiseAbs());
  }
  slack_ = steps_to_hold_ / std::max(1, steps_held_) * moved;
  if (!slack_.allFinite()) slack_.setZero();
  steps_held_ = 0;
}

void BroadPhase::search(const std::vector<Ball>& balls) {
  found_at_ = balls;
  double widest = 0;
  for (const Ball& ball : balls) widest = std::max(widest, 2 * ball.radius);
  const Vec3 width = Vec3::Constant(widest) + 2 * slack_;
  const auto index = [&](const Ball& ball, int axis) { return cell_index(ball.centre[axis], width[axis]); };

  entries_.clear();
  for (int i = 0; i < static_cast<int>(balls.size()); ++i) {
    entries_.push_back({cell_number(index(balls[i], 0), index(balls[i], 1), index(balls[i], 2)), i});
  }
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return std::pair(a.cell, a.ball) < std::pair(b.cell, b.ball); });

  near_.clear();
  for (int i = 0; i < static_cast<int>(balls.size()); ++i) {
    const std::int64_t x = index(balls[i], 0), y = index(balls[i], 1), z = index(balls[i], 2);
    for (int k = 0; k < 27; ++k) search_cell(balls, i, cell_number(x + k / 9 - 1, y + k / 3 % 3 - 1, z + k % 3 - 1));
  }
  std::sort(near_.begin(), near_.end());
}

bool BroadPhase::may_meet(const Ball& a, const Ball& b) const {
  const Vec3 apart = (a.centre - b.centre).cwiseAbs() - 2 * slack_;
  const double reach = a.radius + b.radius;
  // Not "<": where a centre is not a number the pair is looked at again, and found not to overlap.
  return !(apart.x() > reach || apart.y() > reach || apart.z() > reach);
}

void BroadPhase::search_cell(const std::vector<Ball>& balls, int ball, std::uint64_t cell) {
  auto entry = std::upper_bound(entries_.begin(), entries_.end(), std::pair(cell, ball),
                                [](const auto& key, const Entry& e) { return key < std::pair(e.cell, e.ball); });
  for (; entry != entries_.end() && entry->cell == cell; ++entry) {
    if (may_meet(balls[ball], balls[entry->ball])) near_.emplace_back(ball, entry->ball);
  }
}

}  // namespace rigor
