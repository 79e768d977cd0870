#include "core/dynamics/collision/neighbour_list.h"

#include <algorithm>
#include <cmath>

#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

// Bounds of the slack, relative to the largest radius. The lower bound is needed because resting balls may begin to
// move. The upper bound keeps one fast ball from making all balls neighbours.
constexpr double kLeast = 1.0 / 16, kMost = 4;

}  // namespace

NeighbourList::NeighbourList(std::vector<Ball> balls) : balls_(std::move(balls)), boxes_(balls_.size()) {
  for (const Ball& ball : balls_) largest_radius_ = std::max(largest_radius_, ball.radius);
}

const std::vector<std::pair<int, int>>& NeighbourList::overlaps(const Bodies& bodies, BodyColumns state,
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
  for (const auto& [a, b] : *near_) {
    if (overlap(a, b, state)) pairs_.emplace_back(a, b);
  }
  return pairs_;
}

void NeighbourList::archive_state(StateArchive& archive, Columns& spheres) {
  archive(slack_, steps_to_hold_, steps_held_);
  if (steps_held_ == 0) return;  // nothing has been searched for
  archive.each(boxes_, [&](Aabb& box) { archive(box.low, box.high); });
  for (int axis = 0; axis < 3; ++axis) archive.numbers(spheres.column(kFoundAt + axis), spheres.stride());
  if (archive.restores()) near_ = &broad_phase_.overlaps(boxes_);
}

bool NeighbourList::overlap(int a, int b, BodyColumns state) const {
  const double distance = balls_[a].radius + balls_[b].radius;
  return (state.position(balls_[a].body) - state.position(balls_[b].body)).squaredNorm() < distance * distance;
}

// Chooses the slack from the balls' motion per step since the last search. The first choice knows only their sizes.
// Fewer steps are allowed if a search found many pairs, because each pair is checked in every step.
void NeighbourList::choose_slack(BodyColumns state, const Columns& spheres) {
  constexpr double kMostSteps = 256;
  constexpr std::size_t kMostPairsOfBall = 4;
  if (steps_held_ == 0) {
    slack_.setConstant(largest_radius_);
    return;
  }
  steps_to_hold_ = near_->size() > kMostPairsOfBall * balls_.size() ? std::max(1.0, steps_to_hold_ / 2)
                                                                    : std::min(kMostSteps, steps_to_hold_ * 2);
  for (int axis = 0; axis < 3; ++axis) {
    const double *now = state.column(kPosition + axis), *then = spheres.column(kFoundAt + axis);
    double moved = 0;
    for (const Ball& ball : balls_) moved = std::max(moved, std::abs(now[ball.body] - then[ball.body]));
    slack_[axis] = std::clamp(steps_to_hold_ / steps_held_ * moved, kLeast * largest_radius_, kMost * largest_radius_);
  }
  if (!slack_.allFinite()) slack_.setZero();
}

// Where a slack, which the fastest ball makes, brings too many pairs, half of it has to do.
void NeighbourList::search(BodyColumns state) {
  constexpr std::size_t kMostPairsOfBall = 16;
  for (;; slack_ *= 0.5, steps_to_hold_ = std::max(1.0, steps_to_hold_ / 2)) {
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const Vec3 centre = state.position(balls_[i].body), half = Vec3::Constant(balls_[i].radius) + slack_;
      boxes_[i] = {centre - half, centre + half};
    }
    near_ = &broad_phase_.overlaps(boxes_);
    if (near_->size() <= kMostPairsOfBall * balls_.size() || slack_.maxCoeff() <= kLeast * largest_radius_) return;
  }
}

}  // namespace rigor::inline dynamics
