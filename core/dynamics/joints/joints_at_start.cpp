// Checks of the joints at t = 0: which rows repeat others, whether they contradict each other, and whether the position
// is singular.
#include <fmt/format.h>

#include <cmath>

#include "core/dynamics/joints/joints.h"

namespace rigor::inline dynamics {
namespace {

// The allowed difference between a repeated row's acceleration and the one that follows from the others, relative to
// the terms of the row.
constexpr double kContradiction = 1e-6;
// As a share of the extent. At this distance from a singular position pivots are 1e-4, and so is the gap that Newton's
// method does not close.
constexpr double kBeside = 1e-2;
constexpr double kOpenAtStart = 1e-9;  // of the extent: a gap that no rounding explains

}  // namespace

void Joints::find_ranks(BodyColumns state) {
  count_rows(state);
  extent_ = rows_.longest_arm(), size_ = rows_.longest_moving_arm();
  rows_.set_lever(extent_);
  if (!factor_.has_redundant_rows()) return;
  look_for_contradictions();
  if (at_start_.empty()) look_for_singularity(state);
}

// If rows repeat others, their accelerations must follow from the others', too. Otherwise the mechanism is locked, or
// its velocities cannot continue from this position.
void Joints::look_for_contradictions() {
  rows_.assemble(factor_);
  factor_.factorise(true);
  solve_for([](const JointRow& joint) -> Vec6 { return -joint.bias; });
  const double* const wrench = rows_.wrench_of(multipliers_);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const JointRow& joint = rows_.joint(k);
    const Vec6 rest = joint.bias + rows_.response(joint, wrench);
    const double size = rows_.response_size(joint, wrench) + joint.bias.cwiseAbs().maxCoeff();
    for (int row = 0; row < joint.rows; ++row) {
      if (std::abs(rest[row]) > kContradiction * size && std::abs(rest[row]) > kContradiction) {
        at_start_ = fmt::format("the joints contradict each other: {} cannot follow the others at t = 0", names_[k]);
        return;
      }
    }
  }
}

// Rows that repeat others must go on to do so a little further on any way that the joints allow; where they do not, it
// is only at this position that they did. The way is one that no symmetry prefers.
void Joints::look_for_singularity(BodyColumns start) {
  BodyTable beside(start);
  const MutableBodyColumns state = beside.columns();
  double angle = 0;
  for (const int body : rows_.moved()) {
    if (system_.bodies[body].fixed) continue;
    const auto next = [&] { return portable::sin(angle += 2.4); };  // radians: never the same twice
    const double x = next(), y = next(), z = next(), turn_x = next(), turn_y = next(), turn_z = next();
    state.set_velocity(body, extent_ * Vec3(x, y, z)), state.set_angular_velocity(body, {turn_x, turn_y, turn_z});
  }
  push(velocity_impulse(state), state);
  double fastest = 0;
  for (const int body : rows_.moved())
    fastest = std::max({fastest, state.velocity(body).norm() / extent_, state.angular_velocity(body).norm()});
  if (!(fastest > kBeside)) return;  // nothing can move
  for (const int body : rows_.moved()) {
    if (system_.bodies[body].fixed) continue;
    const double h = kBeside / fastest;
    state.set_position(body, state.position(body) + h * state.velocity(body));
    state.set_orientation(body, (rotation_by(h * state.angular_velocity(body)) * state.orientation(body)).normalized());
  }
  const int rank_at_start = rank();
  close_pose(state);
  warning_.clear();
  const bool is_open = !(rows_.largest_gap() <= kOpenAtStart * extent_);
  if (!is_open) count_rows(state);
  if (is_open || rank() != rank_at_start) {
    at_start_ =
        fmt::format("the joints are in a singular position at t = 0: {} of their {} rows repeat others only there",
                    rows() - rank_at_start, rows());
  }
  count_rows(start);
}

}  // namespace rigor::inline dynamics
