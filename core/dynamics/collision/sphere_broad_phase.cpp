#include "core/dynamics/collision/sphere_broad_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rigor {
namespace {

// Twenty-one bits an axis, the last the lowest, so that the order of the numbers is that of the cells.
constexpr std::int64_t kMiddle = 1 << 20, kFarthest = kMiddle - 2;
constexpr int kBitsOfAxis = 21;

constexpr double kLeast = 1.0 / 16;  // slack, of the largest radius: what was at rest so far may begin to move

// What lies farther out shares the outermost cells, which costs looks and loses no pair. Where a centre is not a number
// its cell does not matter.
std::uint64_t cell_index(double coordinate, double cells_per_metre) {
  const double index = std::floor(coordinate * cells_per_metre);
  constexpr auto kMost = static_cast<double>(kFarthest);
  return static_cast<std::uint64_t>(kMiddle +
                                    static_cast<std::int64_t>(std::clamp(index == index ? index : 0, -kMost, kMost)));
}

constexpr std::uint64_t cells_away(std::int64_t x, std::int64_t y, std::int64_t z) {
  return static_cast<std::uint64_t>(((x << kBitsOfAxis) + y) * (1 << kBitsOfAxis) + z);
}

}  // namespace

SphereBroadPhase::SphereBroadPhase(std::vector<Ball> balls) : balls_(std::move(balls)) {
  for (const Ball& ball : balls_) largest_radius_ = std::max(largest_radius_, ball.radius);
}

const std::vector<std::pair<int, int>>& SphereBroadPhase::overlaps(const Bodies& bodies, BodyColumns state,
                                                                   Columns& spheres) {
  if (steps_held_ == 0 || !kernels().have_stayed(bodies, state.column(0), spheres.data(), slack_.data())) {
    choose_slack(state, spheres);
    search(state);
    for (int axis = 0; axis < 3; ++axis)
      std::copy_n(state.column(kPosition + axis), state.size(), spheres.column(kFoundAt + axis));
    steps_held_ = 0;
  }
  ++steps_held_;
  pairs_.clear();
  for (const auto& [a, b] : near_) {
    if (overlap(a, b, state)) pairs_.emplace_back(a, b);
  }
  return pairs_;
}

bool SphereBroadPhase::overlap(int a, int b, BodyColumns state) const {
  const double distance = balls_[a].radius + balls_[b].radius;
  return (state.position(balls_[a].body) - state.position(balls_[b].body)).squaredNorm() < distance * distance;
}

// From what the balls moved in a step since the last search; the first knows nothing but how large they are. Fewer
// steps if a search found many pairs, for each costs a look in every step.
void SphereBroadPhase::choose_slack(BodyColumns state, const Columns& spheres) {
  constexpr double kMostSteps = 256;
  constexpr std::size_t kMostPairsOfBall = 4;
  if (steps_held_ == 0) {
    slack_.setConstant(largest_radius_);
    return;
  }
  steps_to_hold_ = near_.size() > kMostPairsOfBall * balls_.size() ? std::max(1.0, steps_to_hold_ / 2)
                                                                   : std::min(kMostSteps, steps_to_hold_ * 2);
  for (int axis = 0; axis < 3; ++axis) {
    const double *now = state.column(kPosition + axis), *then = spheres.column(kFoundAt + axis);
    double moved = 0;
    for (const Ball& ball : balls_) moved = std::max(moved, std::abs(now[ball.body] - then[ball.body]));
    slack_[axis] = std::max(kLeast * largest_radius_, steps_to_hold_ / steps_held_ * moved);
  }
  if (!slack_.allFinite()) slack_.setZero();
}

// Cells are as wide as the largest ball and twice the slack, so that balls that may meet lie in the same cell or in
// neighbouring ones.
void SphereBroadPhase::sort_by_cell(BodyColumns state) {
  constexpr double kRounding = 1 + 1e-9;  // of an index
  const Vec3 per_metre = (kRounding * 2 * (Vec3::Constant(largest_radius_) + slack_)).cwiseInverse();
  entries_.clear();
  for (int i = 0; i < static_cast<int>(balls_.size()); ++i) {
    const Vec3 centre = state.position(balls_[i].body);
    const auto index = [&](int axis) { return cell_index(centre[axis], per_metre[axis]); };
    entries_.push_back({(index(0) << kBitsOfAxis | index(1)) << kBitsOfAxis | index(2), i});
  }
  const auto is_before = [](const Entry& a, const Entry& b) {
    return a.cell < b.cell || (a.cell == b.cell && a.ball < b.ball);
  };
  if (!std::is_sorted(entries_.begin(), entries_.end(), is_before))
    std::sort(entries_.begin(), entries_.end(), is_before);
}

// Of the twenty-six cells round a ball's, thirteen come after it: one in its own row along z, three in each of four
// other rows. The other thirteen are searched from the other balls. Where a slack, which the fastest ball makes, brings
// too many pairs, half of it has to do.
void SphereBroadPhase::search(BodyColumns state) {
  constexpr std::size_t kMostPairsOfBall = 16;
  for (;; slack_ *= 0.5, steps_to_hold_ = std::max(1.0, steps_to_hold_ / 2)) {
    const bool is_least = slack_.maxCoeff() <= kLeast * largest_radius_;
    const std::size_t most = is_least ? std::numeric_limits<std::size_t>::max() : kMostPairsOfBall * balls_.size();
    sort_by_cell(state);
    near_.clear();
    bool few = search_cells(state, 0, cells_away(0, 0, 1), true, most);
    for (const auto& [x, y] : {std::pair(0, 1), std::pair(1, -1), std::pair(1, 0), std::pair(1, 1)})
      few = few && search_cells(state, cells_away(x, y, -1), cells_away(x, y, 1), false, most);
    if (few) break;
  }
  std::sort(near_.begin(), near_.end());
}

// The cells from `to_low` to `to_high` away from each ball's own; as the balls are in order, so are these. False if
// there are more than so many pairs.
bool SphereBroadPhase::search_cells(BodyColumns state, std::uint64_t to_low, std::uint64_t to_high, bool own,
                                    std::size_t most) {
  const std::size_t count = entries_.size();
  for (std::size_t i = 0, first = 0; i < count && near_.size() <= most; ++i) {
    const auto [cell, ball] = entries_[i];
    while (first < count && entries_[first].cell < cell + to_low) ++first;
    for (std::size_t j = own ? i + 1 : first; j < count && entries_[j].cell <= cell + to_high; ++j) {
      const int other = entries_[j].ball;
      if (may_meet(ball, other, state)) near_.push_back(std::minmax(ball, other));
    }
  }
  return near_.size() <= most;
}

bool SphereBroadPhase::may_meet(int a, int b, BodyColumns state) const {
  const Vec3 apart = (state.position(balls_[a].body) - state.position(balls_[b].body)).cwiseAbs() - 2 * slack_;
  const double distance = balls_[a].radius + balls_[b].radius;
  // Not "<": where a centre is not a number the pair is looked at again, and found not to overlap.
  return !(apart.x() > distance || apart.y() > distance || apart.z() > distance);
}

}  // namespace rigor
