// The motion of jointed bodies as a differential equation, for any number type. It combines the accelerations of Newton
// and Euler (body rates, equations_of_motion.h) with joint forces that keep the second derivatives of the constraints
// at zero,
//   M a = f + J^T lambda,  J a + bias = 0.
// What a step leaves of the constraints themselves is projected away, weighed by mass. The rows are those of
// newton_euler_joints.h.
#pragma once

#include <optional>
#include <utility>

#include "cases/truth/solved/equations_of_motion.h"
#include "cases/truth/solved/jointed/axis_efforts.h"
#include "cases/truth/solved/jointed/axis_rows.h"
#include "cases/truth/solved/jointed/newton_euler_joints.h"

namespace rigor::inline truth {

template <typename Real>
class JointedMotion {
 public:
  using Free = EquationsOfMotion<Real>;
  using State = typename Free::State;
  using Vector = typename Free::Vector;
  using Matrix = typename Free::Matrix;
  using Pose = typename Free::Pose;
  using Rows = ConstraintRows<Real, 6>;
  using Row = typename Rows::Row;

  explicit JointedMotion(const Scene& scene) : free_(scene, Formulation::body_rates) {
    order_.assign(scene.bodies.size(), -1);
    for (std::size_t k = 0; k < free_.moving().size(); ++k) order_[free_.moving()[k]] = static_cast<int>(k);
    const std::vector<Pose> start = poses_of(free_.start());
    joints_.emplace(scene, order_, start);
    choice_ = choose_rows<Rows>(rows_at(start_as_read(), start, {}).constraints, inverse_masses(start));
  }

  State start() const {
    State state = start_as_read();
    during(0).project(state);
    return state;
  }

  class Interval;
  // The right-hand side while the loads are those that act at t [s], and limits and motors do what `modes` say.
  Interval during(double t) const { return {*this, t, {}, choice_}; }
  Interval during(double t, const AxisModes& modes, RowChoice choice) const {
    return {*this, t, modes, std::move(choice)};
  }
  // The rows in these modes, at a state.
  RowChoice choice_at(const State& state, const AxisModes& modes) const {
    if (std::none_of(modes.begin(), modes.end(), [](const AxisMode& mode) { return mode.has_row(); })) return choice_;
    const std::vector<Pose> poses = poses_of(state);
    return choose_rows<Rows>(rows_at(state, poses, modes).constraints, inverse_masses(poses));
  }
  const std::vector<JointAxis<Real>>& axes() const { return joints_->axes(); }
  std::size_t clock_place() const { return axis_place() + axes().size(); }
  const Scene& scene() const { return free_.scene(); }

  template <typename Number>
  void write(const Number* state, MutableBodyColumns out) const {
    free_.write(state, out);
  }

 private:
  using Block = typename Row::Block;
  using InverseMass = typename Rows::InverseMass;

  State start_as_read() const {
    State state = free_.start();
    state.resize(clock_place() + clock_numbers(scene(), axes().size()));
    return state;
  }

  std::vector<Pose> poses_of(const State& state) const {
    std::vector<Pose> poses = free_.standing_poses();
    free_.read_poses(state, poses);
    return poses;
  }

  JointRows<Real, 6> rows_at(const State& state, const std::vector<Pose>& poses, const AxisModes& modes) const {
    JointRows<Real, 6> rows;
    joints_->add_rows(poses, state.data() + axis_place(), rows);
    add_mode_rows(modes, axes(), scene().joints, rows);
    return rows;
  }

  std::size_t axis_place() const { return Free::kNumbersPerBody * free_.moving().size(); }

  std::vector<InverseMass> inverse_masses(const std::vector<Pose>& poses) const {
    std::vector<InverseMass> inverse(free_.moving().size(), InverseMass::Zero());
    for (const int i : free_.moving()) {
      InverseMass& out = inverse[order_[i]];
      out.template topLeftCorner<3, 3>() = Matrix::Identity() / static_cast<Real>(free_.scene().bodies[i].mass);
      out.template bottomRightCorner<3, 3>() = poses[i].R * free_.inverse_inertia(i) * poses[i].R.transpose();
    }
    return inverse;
  }

  std::vector<Block> velocities_of(const std::vector<Pose>& poses) const {
    std::vector<Block> velocities(free_.moving().size());
    for (const int i : free_.moving()) velocities[order_[i]] << poses[i].velocity, poses[i].w;
    return velocities;
  }

  // By a small shift and turn, in W.
  void move(const Pose& pose, const Block& by, Real* s) const {
    Free::put(s, pose.position + by.template head<3>());
    const Vector half = by.template tail<3>() / 2, u = Free::get(s + 4);
    const Real w = s[3];
    s[3] = w - half.dot(u);
    Free::put(s + 4, u + w * half + half.cross(u));
    Eigen::Map<Eigen::Matrix<Real, 4, 1>>(s + 3).normalize();
  }

  Free free_;
  std::vector<int> order_;  // of each body: its place among those that move; -1 if fixed
  std::optional<NewtonEulerJoints<Real>> joints_;
  RowChoice choice_;  // where the motion begins
};

template <typename Real>
class JointedMotion<Real>::Interval {
 public:
  Interval(const JointedMotion& motion, double t, AxisModes modes, RowChoice choice)
      : motion_(&motion),
        modes_(std::move(modes)),
        free_(motion.free_.during(t)),
        efforts_(motion.scene(), motion.axes(), t, modes_),
        first_choice_(std::move(choice)),
        solver_(first_choice_) {}

  // Resets to a new object: the result for a state does not depend on earlier calls.
  void restart() { solver_.restart(first_choice_); }

  void operator()(const State& state, State& change, Real t) {
    free_(state, change, t);
    const std::vector<Pose>& poses = free_.poses();
    const JointRows<Real, 6> rows = motion_->rows_at(state, poses, modes_);
    const auto mass = motion_->inverse_masses(poses);
    if (!solver_.factorise(rows.constraints, mass))
      return std::fill(change.begin(), change.end(), std::numeric_limits<Real>::quiet_NaN());
    const std::vector<Block> efforts =
        efforts_.on_bodies(rows.axes, motion_->velocities_of(poses), state, motion_->axis_place(), change);
    const auto& moving = motion_->free_.moving();
    accelerations_.resize(moving.size());
    for (const int i : moving) {
      const int b = motion_->order_[i];
      const Real* c = &change[motion_->free_.slot(i)];
      accelerations_[b] << Free::get(c + 7), poses[i].R * Free::get(c + 10);
      accelerations_[b] += mass[b] * efforts[b];
    }
    const auto added = solver_.correction(rows.constraints, mass,
                                          [&](const Row& row) { return Real(row.rate(accelerations_) + row.bias); });
    for (const int i : moving) {
      Real* c = &change[motion_->free_.slot(i)];
      Block& acceleration = accelerations_[motion_->order_[i]];
      acceleration += added[motion_->order_[i]];
      Free::put(c + 7, acceleration.template head<3>());
      Free::put(c + 10, poses[i].R.transpose() * acceleration.template tail<3>());
    }
  }

  // Moves the state to the nearest one, weighted by mass, that its joints allow. Returns false if there is none near.
  bool project(State& state) {
    return project_by<Real>([&](Residual what) { return correct(state, what); });
  }
  // The velocities alone: an impact.
  bool project_rates(State& state) { return correct(state, Residual::rate).has_value(); }

  // The coordinates of all axes at a state; accelerations and efforts (or impulses) as operator() or project_rates()
  // left them.
  std::vector<AxisMotion<Real>> axes_at(const State& state) const {
    const std::vector<Pose> poses = motion_->poses_of(state);
    return axis_motions(modes_, motion_->rows_at(state, poses, {}).axes, solver_.multipliers(),
                        motion_->velocities_of(poses), accelerations_);
  }

 private:
  // Returns by how much [m, rad; m/s, rad/s] at most.
  std::optional<double> correct(State& state, Residual what) {
    const JointedMotion& m = *motion_;
    const std::vector<Pose> poses = m.poses_of(state);
    const std::vector<Row> rows = m.rows_at(state, poses, modes_).constraints;
    const auto mass = m.inverse_masses(poses);
    if (!solver_.factorise(rows, mass)) return std::nullopt;
    const auto velocities = m.velocities_of(poses);
    const auto changes = solver_.correction(rows, mass, [&](const Row& row) { return row.residual(what, velocities); });
    double largest = 0;
    for (const int i : m.free_.moving()) {
      Real* s = &state[m.free_.slot(i)];
      const auto& change = changes[m.order_[i]];
      largest = std::max(largest, static_cast<double>(change.template lpNorm<Eigen::Infinity>()));
      if (what == Residual::gap) {
        m.move(poses[i], change, s);
      } else {
        Free::put(s + 7, Free::get(s + 7) + change.template head<3>());
        Free::put(s + 10, Free::get(s + 10) + poses[i].R.transpose() * change.template tail<3>());
      }
    }
    return largest;
  }

  const JointedMotion* motion_;
  AxisModes modes_;
  typename Free::Interval free_;
  AxisEfforts<Real> efforts_;
  RowChoice first_choice_;
  Rows solver_;
  std::vector<Block> accelerations_;
};

}  // namespace rigor::inline truth
