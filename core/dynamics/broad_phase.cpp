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

// Cells are as wide as the largest ball, so that overlapping balls lie in the same cell or in neighbouring ones. Where
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
  double width = 0;
  for (const Ball& ball : balls) width = std::max(width, 2 * ball.radius);
  const auto index = [&](const Ball& ball, int axis) { return cell_index(ball.centre[axis], width); };

  entries_.clear();
  for (int i = 0; i < static_cast<int>(balls.size()); ++i) {
    entries_.push_back({cell_number(index(balls[i], 0), index(balls[i], 1), index(balls[i], 2)), i});
  }
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return std::pair(a.cell, a.ball) < std::pair(b.cell, b.ball); });

  pairs_.clear();
  for (int i = 0; i < static_cast<int>(balls.size()); ++i) {
    const std::int64_t x = index(balls[i], 0), y = index(balls[i], 1), z = index(balls[i], 2);
    for (int k = 0; k < 27; ++k) search_cell(balls, i, cell_number(x + k / 9 - 1, y + k / 3 % 3 - 1, z + k % 3 - 1));
  }
  std::sort(pairs_.begin(), pairs_.end());
  return pairs_;
}

void BroadPhase::search_cell(const std::vector<Ball>& balls, int ball, std::uint64_t cell) {
  auto entry = std::upper_bound(entries_.begin(), entries_.end(), std::pair(cell, ball),
                                [](const auto& key, const Entry& e) { return key < std::pair(e.cell, e.ball); });
  for (; entry != entries_.end() && entry->cell == cell; ++entry) {
    if (overlap(balls[ball], balls[entry->ball])) pairs_.emplace_back(ball, entry->ball);
  }
}

}  // namespace rigor
