#include "core/dynamics/joints/joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/kernels/kernels.h"

namespace rigor {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kMostIterations = 50;
constexpr double kClosed = 16 * kEpsilon;  // of the extent: what rounding of poses leaves of a gap,
constexpr double kRounding = 1e-12;        // and where bodies are far from the origin
constexpr double kOpen = 1e-9;             // of the extent: a gap that no rounding explains
constexpr double kWellPosed = 1e-5;        // pivots above it leave eleven digits or more
// How far a repeated row's acceleration may be from what the others make it, relative to the terms of the row.
constexpr double kContradiction = 1e-6;

Vec6 wrench_at(const double* columns, std::size_t stride, int body) {
  Vec6 wrench;
  for (int c = 0; c < 6; ++c)
    wrench[c] = columns[static_cast<std::size_t>(c) * stride + static_cast<std::size_t>(body)];
  return wrench;
}

}  // namespace

Joints::Joints(const Scene& scene, const System& system)
    : system_(system),
      frames_(system.size()),
      multipliers_(scene.joints.size()),
      correction_(scene.joints.size()),
      free_(system.size()) {
  const auto moving = [&](int body) { return body != kWorld && !system.bodies[body].fixed ? body : kWorld; };
  std::vector<int> rows;
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    Held& held = joints_.emplace_back();
    held.constraint = make_constraint(scene, joint);
    held.rows = held.constraint->rows();
    held.end[0] = joint.a, held.end[1] = joint.b;
    held.body[0] = moving(joint.a), held.body[1] = moving(joint.b);
    rows.push_back(held.rows);
    rows_total_ += held.rows;
    for (const int body : held.end) {
      if (body != kWorld) moved_.push_back(body);
    }
    names_.push_back(scene.joint_name(k));
  }
  std::sort(moved_.begin(), moved_.end());
  moved_.erase(std::unique(moved_.begin(), moved_.end()), moved_.end());
  list_couplings();
  std::vector<std::pair<int, int>> coupled;
  for (const Coupling& c : couplings_) coupled.emplace_back(c.first, c.second);
  factor_ = std::make_unique<BlockCholesky>(rows, coupled);
  for (Coupling& c : couplings_) c.place = factor_->place(c.first, c.second);
  wrench_.resize(kWrenchColumns, system.size());
  total_.resize(kWrenchColumns, system.size());

  BodyTable start(system.size());
  set_initial_state(scene, start.columns());
  find_ranks(start.columns());
}

void Joints::list_couplings() {
  std::vector<std::vector<std::pair<int, int>>> on_body(system_.size());  // joints and their ends
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    for (int end = 0; end < 2; ++end) {
      if (joints_[k].body[end] != kWorld) on_body[joints_[k].body[end]].emplace_back(k, end);
    }
  }
  for (const auto& ends : on_body) {
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (std::size_t j = i + 1; j < ends.size(); ++j) {
        couplings_.push_back({ends[i].first,
                              ends[j].first,
                              static_cast<std::int8_t>(ends[i].second),
                              static_cast<std::int8_t>(ends[j].second),
                              {}});
      }
    }
  }
}

// A joint's longest arm is what turns a rotation into a gap: the torque of its rows over their force.
void Joints::find_ranks(BodyColumns state) {
  evaluate(state);
  extent_ = 0;
  for (const Held& joint : joints_) {
    for (int end = 0; end < 2; ++end) {
      for (int k = 0; k < joint.rows; ++k) {
        const double force = joint.J[end].row(k).head<3>().norm();
        if (force > 0) extent_ = std::max(extent_, joint.J[end].row(k).tail<3>().norm() / force);
      }
    }
  }
  if (extent_ == 0) extent_ = 1;
  assemble();
  factor_->find_ranks();
  rank_total_ = factor_->rank();
  if (factor_->has_redundant_rows()) look_for_contradictions();
}

// Where rows repeat others, their accelerations must follow from the others' too: if they do not, the mechanism is
// locked, or is at a position from which it cannot go on as its velocities say.
void Joints::look_for_contradictions() {
  assemble();
  factor_->factorise(true);
  solve_for([](const Held& joint) -> Vec6 { return -joint.bias; });
  const double* const wrench = as_wrench(multipliers_);
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const Held& joint = joints_[k];
    Vec6 rest = joint.bias, size = joint.bias.cwiseAbs();
    for (int end = 0; end < 2; ++end) {
      if (joint.body[end] == kWorld) continue;
      const Vec6 part = joint.Y[end] * wrench_at(wrench, wrench_.stride(), joint.body[end]);
      rest += part, size += part.cwiseAbs();
    }
    for (int row = 0; row < joint.rows; ++row) {
      if (std::abs(rest[row]) > kContradiction * size[row] && std::abs(rest[row]) > kContradiction) {
        contradiction_ =
            fmt::format("the joints contradict each other: {} cannot follow the others at t = 0", names_[k]);
        return;
      }
    }
  }
}

void Joints::evaluate(BodyColumns state) {
  for (const int body : moved_) {
    Frame& frame = frames_[body];
    const Inertia& inertia = system_.bodies[body];
    frame.motion = {state.position(body), state.rotation(body), state.velocity(body), state.angular_velocity(body)};
    frame.inverse_inertia_W = frame.motion.R * inertia.inverse_inertia_B * frame.motion.R.transpose();
  }
  static const EndMotion kStill;
  for (Held& joint : joints_) {
    const EndMotion& a = joint.end[0] == kWorld ? kStill : frames_[joint.end[0]].motion;
    const EndMotion& b = joint.end[1] == kWorld ? kStill : frames_[joint.end[1]].motion;
    ConstraintRow rows[kMostRows];
    joint.constraint->evaluate(a, b, rows);
    joint.J[0].setZero(), joint.J[1].setZero(), joint.gap.setZero(), joint.bias.setZero();
    for (int k = 0; k < joint.rows; ++k) {
      joint.J[0].row(k) = rows[k].on_a, joint.J[1].row(k) = rows[k].on_b;
      joint.gap[k] = rows[k].gap, joint.bias[k] = rows[k].bias;
    }
  }
}

void Joints::assemble() {
  factor_->clear();
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    Held& joint = joints_[k];
    Block6& D = factor_->diagonal(k);
    for (int end = 0; end < 2; ++end) {
      if (joint.body[end] == kWorld) continue;
      joint.Y[end].leftCols<3>() = system_.bodies[joint.body[end]].inverse_mass * joint.J[end].leftCols<3>();
      joint.Y[end].rightCols<3>().noalias() =
          joint.J[end].rightCols<3>().lazyProduct(frames_[joint.body[end]].inverse_inertia_W);
      D.noalias() += joint.Y[end].lazyProduct(joint.J[end].transpose());
    }
  }
  for (const Coupling& c : couplings_) {
    const Held &first = joints_[c.first], &second = joints_[c.second];
    Block6& to = factor_->block(c.place.index);
    if (c.place.transposed) {
      to.noalias() += second.Y[c.second_end].lazyProduct(first.J[c.first_end].transpose());
    } else {
      to.noalias() += first.Y[c.first_end].lazyProduct(second.J[c.second_end].transpose());
    }
  }
}

void Joints::factorise(BodyColumns state, Rows rows) {
  evaluate(state);
  assemble();
  factor_->factorise(rows == Rows::chosen_anew);
  warn_if_singular();
}

void Joints::warn_if_singular() {
  if (factor_->smallest_pivot() > BlockCholesky::kLost || !warning_.empty()) return;
  warning_ = fmt::format("the joints are in a singular position, at {}", names_[factor_->joint_of_smallest_pivot()]);
}

double Joints::measure_gaps(BodyColumns state) {
  const auto pose = [&](int body) {
    EndMotion end;
    if (body != kWorld) end.position = state.position(body), end.R = state.rotation(body);
    return end;
  };
  for (Held& joint : joints_) {
    ConstraintRow rows[kMostRows];
    joint.constraint->evaluate(pose(joint.end[0]), pose(joint.end[1]), rows);
    for (int k = 0; k < joint.rows; ++k) joint.gap[k] = rows[k].gap;
  }
  return largest_gap();
}

double Joints::largest_gap() const {
  double largest = 0;
  for (const Held& joint : joints_) {
    for (int k = 0; k < joint.rows; ++k) {
      if (!(std::abs(joint.gap[k]) <= largest)) largest = std::abs(joint.gap[k]);  // also what is not a number
    }
  }
  return largest;
}

template <typename RightSide>
void Joints::solve_for(const RightSide& right_side) {
  for (std::size_t k = 0; k < joints_.size(); ++k) multipliers_[k] = right_side(joints_[k]);
  if (factor_->smallest_pivot() > kWellPosed) return factor_->solve(multipliers_);
  right_side_ = multipliers_;
  factor_->solve(multipliers_);
  for (int pass = 0; pass < 2; ++pass) refine();
}

// Near a singular position, at a distance of d rad, S has lost d^-2 roundings. What J itself says of the solution has
// lost d^-1, and corrects it (the corrected semi-normal equations; Å. Björck, 1987).
void Joints::refine() {
  const double* const wrench = as_wrench(multipliers_);
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    correction_[k] = right_side_[k];
    for (int end = 0; end < 2; ++end) {
      const int body = joints_[k].body[end];
      if (body != kWorld)
        correction_[k].noalias() -= joints_[k].Y[end].lazyProduct(wrench_at(wrench, wrench_.stride(), body));
    }
  }
  factor_->solve(correction_);
  for (std::size_t k = 0; k < joints_.size(); ++k) multipliers_[k] += correction_[k];
}

// Jᵀ l, in wrench_.
const double* Joints::as_wrench(const std::vector<Vec6>& multipliers) {
  for (const int body : moved_) {
    for (std::size_t c = 0; c < kWrenchColumns; ++c) wrench_.column(c)[body] = 0;
  }
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    for (int end = 0; end < 2; ++end) {
      const int body = joints_[k].body[end];
      if (body == kWorld) continue;
      const Vec6 wrench = joints_[k].J[end].transpose().lazyProduct(multipliers[k]);
      for (int c = 0; c < 6; ++c) wrench_.column(static_cast<std::size_t>(c))[body] += wrench[c];
    }
  }
  return wrench_.data();
}

const double* Joints::hold(BodyColumns state, const double* wrench, Rows rows) {
  factorise(state, rows);
  for (const int body : moved_) free_[body] = free_acceleration(body, wrench);
  solve_for([&](const Held& joint) {
    Vec6 b = -joint.bias;
    for (int end = 0; end < 2; ++end) {
      if (joint.body[end] != kWorld) b.noalias() -= joint.J[end].lazyProduct(free_[joint.body[end]]);
    }
    return b;
  });
  as_wrench(multipliers_);
  if (!wrench) return wrench_.data();
  for (std::size_t c = 0; c < kWrenchColumns; ++c) {
    double* const to = total_.column(c);
    std::copy_n(wrench + c * total_.stride(), system_.size(), to);
    for (const int body : moved_) to[body] += wrench_.column(c)[body];
  }
  return total_.data();
}

Vec6 Joints::free_acceleration(int body, const double* wrench) const {
  const Inertia& inertia = system_.bodies[body];
  Vec6 acceleration = Vec6::Zero();
  if (inertia.fixed) return acceleration;
  const Frame& frame = frames_[body];
  const Vec6 acting = wrench ? wrench_at(wrench, wrench_.stride(), body) : Vec6::Zero().eval();
  acceleration.head<3>() = system_.scene_gravity + inertia.inverse_mass * acting.head<3>();
  acceleration.tail<3>() =
      angular_acceleration(inertia, frame.motion.R, frame.motion.angular_velocity, acting.tail<3>());
  return acceleration;
}

const double* Joints::velocity_impulse(BodyColumns state) {
  factorise(state, Rows::chosen_anew);
  return impulse_against_velocities();
}

const double* Joints::impulse_against_velocities() {
  solve_for([&](const Held& joint) {
    Vec6 b = Vec6::Zero();
    for (int end = 0; end < 2; ++end) {
      if (joint.body[end] == kWorld) continue;
      const EndMotion& motion = frames_[joint.body[end]].motion;
      b.noalias() -= joint.J[end].leftCols<3>().lazyProduct(motion.velocity);
      b.noalias() -= joint.J[end].rightCols<3>().lazyProduct(motion.angular_velocity);
    }
    return b;
  });
  return as_wrench(multipliers_);
}

void Joints::push(const double* impulse, MutableBodyColumns state) const {
  for (const int body : moved_) {
    if (system_.bodies[body].fixed) continue;
    const Vec6 p = wrench_at(impulse, wrench_.stride(), body);
    state.set_velocity(body, state.velocity(body) + system_.bodies[body].inverse_mass * p.head<3>());
    state.set_angular_velocity(body, state.angular_velocity(body) + frames_[body].inverse_inertia_W * p.tail<3>());
  }
}

// Velocities twice: the second pass takes away what rounding left of the first.
void Joints::project(MutableBodyColumns state) {
  close_pose(state);
  factorise(state, Rows::chosen_anew);
  for (int pass = 0; pass < 2; ++pass) {
    push(impulse_against_velocities(), state);
    for (const int body : moved_) {
      frames_[body].motion.velocity = state.velocity(body);
      frames_[body].motion.angular_velocity = state.angular_velocity(body);
    }
  }
}

// Newton's method, with J and S of its first iteration until they no longer serve.
void Joints::close_pose(MutableBodyColumns state) {
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    evaluate(state);
    const double gap = largest_gap();
    if (is_closed(gap, last)) break;
    assemble();
    factor_->factorise(iteration == 0);
    solve_for([](const Held& joint) -> Vec6 { return -joint.gap; });
    move(as_wrench(multipliers_), state);
    last = gap;
  }
  warn_of_gap(largest_gap());
}

// By M⁻¹ times what is a wrench of the multipliers: a displacement and a rotation vector.
void Joints::move(const double* wrench, MutableBodyColumns state) const {
  for (const int body : moved_) {
    if (system_.bodies[body].fixed) continue;
    const Vec6 p = wrench_at(wrench, wrench_.stride(), body);
    state.set_position(body, state.position(body) + system_.bodies[body].inverse_mass * p.head<3>());
    const Quat turn = rotation_by(frames_[body].inverse_inertia_W * p.tail<3>());
    if (state.has_rotation()) state.set_rotation(body, matrix_of(turn) * state.rotation(body));
    state.set_orientation(body, (turn * state.orientation(body)).normalized());
  }
}

// Also if it falls no further, or is not a number.
bool Joints::is_closed(double gap, double last) const {
  return gap <= kClosed * extent_ || (gap <= kRounding * extent_ && gap > 0.5 * last) || !std::isfinite(gap);
}

void Joints::warn_of_gap(double gap) {
  if (!(gap > kOpen * extent_) || !warning_.empty()) return;
  warning_ = fmt::format("the joints could not be closed: a gap of {:.3g} (m, or sine of an angle) is left{}", gap,
                         factor_->has_redundant_rows()
                             ? "; rows that repeat others at t = 0 no longer do, as where it is a singular position"
                             : "");
}

// A chord method: the impulse's effect on the end is taken to be h S, that of the start's J at both.
void Joints::close(BodyColumns start, double h, const std::function<BodyColumns(const double* impulse)>& attempt) {
  factorise(start, Rows::chosen_anew);
  total_multipliers_.assign(joints_.size(), Vec6::Zero());
  double gap = 0, last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    gap = measure_gaps(attempt(as_wrench(total_multipliers_)));
    if (is_closed(gap, last)) break;
    solve_for([h](const Held& joint) -> Vec6 { return -joint.gap / h; });
    for (std::size_t k = 0; k < joints_.size(); ++k) total_multipliers_[k] += multipliers_[k];
    last = gap;
  }
  warn_of_gap(gap);
}

}  // namespace rigor
