// The motion of jointed bodies in other coordinates and other equations. A body is its centre x and the directions d_1,
// d_2, d_3 of its own axes: twelve numbers, in which the mass is constant and every joint is a polynomial of degree two
// (García de Jalón & Bayo, Kinematic and Dynamic Simulation of Multibody Systems, 1994, chapter 2). There is no angular
// velocity, no gyroscopic torque and no quaternion:
//   T = m x'.x'/2 + sum E_ij d_i'.d_j' / 2,   E = (tr I)/2 - I,
// with d_i.d_j = 0 or 1 as six constraints per body. A torque t about the centre becomes the forces t x d_i / 2. If E
// is singular or nearly so (a rod, a plate), the six constraints make the mass regular:
//   (M + c P^T P) a + J^T lambda = Q - c P^T bias_P.
// After the numbers of all bodies stand those of the axes (axis_efforts.h).
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "cases/truth/solved/acting_forces.h"
#include "cases/truth/solved/jointed/axis_efforts.h"
#include "cases/truth/solved/jointed/axis_rows.h"
#include "cases/truth/solved/jointed/joint_axis.h"
#include "cases/truth/solved/jointed/natural_joints.h"
#include "core/base/eigen_of.h"
#include "core/engine/body_table.h"

namespace rigor::inline truth {

template <typename Real>
class NaturalCoordinates {
 public:
  using State = std::vector<Real>;
  using Frame = NaturalFrame<Real>;
  using Vector = typename Frame::Vector;
  using Matrix = typename Frame::Matrix;
  using Rows = ConstraintRows<Real, 12>;
  using Row = typename Rows::Row;
  using Block = typename Row::Block;
  using InverseMass = typename Rows::InverseMass;

  explicit NaturalCoordinates(const Scene& scene) : scene_(scene) {
    for (const Body& body : scene.bodies) {
      order_.push_back(body.fixed ? -1 : static_cast<int>(moving_.size()));
      if (!body.fixed) moving_.push_back(static_cast<int>(order_.size()) - 1);
      const Matrix inertia = body.inertia.template cast<Real>();
      second_moment_.push_back(inertia.trace() / 2 * Matrix::Identity() - inertia);
      if (!body.fixed) masses_.push_back(constant_inverse_mass(body, second_moment_.back()));
      if (!body.fixed && !is_regular(second_moment_.back())) singular_.push_back(static_cast<int>(order_.size()) - 1);
    }
    joints_.emplace(scene, order_, frames_of(bodies_at_start()));
    const State state = start_as_read();
    const std::vector<Frame> start = frames_of(state);
    choice_ = choose_rows<Rows>(rows_at(state, start, {}).constraints, inverse_masses(start));
  }

  State start() const {
    State state = start_as_read();
    during(0).project(state);
    return state;
  }

  // All as of JointedMotion.
  class Interval;
  Interval during(double t) const { return {*this, t, {}, choice_}; }
  Interval during(double t, const AxisModes& modes, RowChoice choice) const {
    return {*this, t, modes, std::move(choice)};
  }
  RowChoice choice_at(const State& state, const AxisModes& modes) const {
    if (std::none_of(modes.begin(), modes.end(), [](const AxisMode& mode) { return mode.has_row(); })) return choice_;
    const std::vector<Frame> frames = frames_of(state);
    return choose_rows<Rows>(rows_at(state, frames, modes).constraints, inverse_masses(frames));
  }
  const std::vector<JointAxis<Real>>& axes() const { return joints_->axes(); }
  const Scene& scene() const { return scene_; }
  std::size_t clock_place() const { return axis_place() + axes().size(); }

  template <typename Number>
  void write(const Number* state, MutableBodyColumns out) const {
    for (std::size_t i = 0; i < order_.size(); ++i) {
      if (order_[i] < 0) {
        out.set_body(i, {scene_.bodies[i].position, scene_.bodies[i].orientation, Vec3::Zero(), Vec3::Zero()});
        continue;
      }
      Real s[kNumbersPerBody];
      for (int k = 0; k < kNumbersPerBody; ++k) s[k] = static_cast<Real>(state[kNumbersPerBody * order_[i] + k]);
      const Frame frame = Frame::read(s);
      Mat3 R = frame.R.template cast<double>();
      out.set_body(i, {frame.x.template cast<double>(), Quat(R).normalized(), frame.dx.template cast<double>(),
                       frame.w().template cast<double>()});
    }
  }

 private:
  static constexpr int kNumbersPerBody = Frame::kNumbers;

  State start_as_read() const {
    State state = bodies_at_start();
    state.resize(clock_place() + clock_numbers(scene_, axes().size()));
    return state;
  }

  State bodies_at_start() const {
    State state(axis_place());
    for (const int i : moving_) {
      const Body& body = scene_.bodies[i];
      const Matrix R = body.orientation.template cast<Real>().normalized().toRotationMatrix();
      const Vector x = body.position.template cast<Real>(), v = body.velocity.template cast<Real>(),
                   w = body.angular_velocity.template cast<Real>();
      Real* s = &state[kNumbersPerBody * order_[i]];
      for (int k = 0; k < 3; ++k) {
        s[k] = x[k], s[12 + k] = v[k];
        const Vector d = R.col(k), rate = w.cross(d);
        for (int j = 0; j < 3; ++j) s[3 + 3 * k + j] = d[j], s[15 + 3 * k + j] = rate[j];
      }
    }
    return state;
  }

  std::vector<Frame> frames_of(const State& state) const {
    std::vector<Frame> frames(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      if (order_[i] >= 0) {
        frames[i] = Frame::read(&state[kNumbersPerBody * order_[i]]);
      } else {
        frames[i].x = scene_.bodies[i].position.template cast<Real>();
        frames[i].R = scene_.bodies[i].orientation.template cast<Real>().normalized().toRotationMatrix();
      }
    }
    return frames;
  }

  JointRows<Real, 12> rows_at(const State& state, const std::vector<Frame>& frames, const AxisModes& modes) const {
    JointRows<Real, 12> rows;
    for (const int i : moving_) add_own_rows(order_[i], frames[i], rows.constraints);
    joints_->add_rows(frames, state.data() + axis_place(), rows);
    add_mode_rows(modes, axes(), scene_.joints, rows);
    return rows;
  }

  std::size_t axis_place() const { return kNumbersPerBody * moving_.size(); }

  // d_i.d_j as of a rotation.
  static void add_own_rows(int body, const Frame& frame, std::vector<Row>& rows) {
    const auto gradients = frame.gradients();
    for (int i = 0, k = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j, ++k) {
        Row& row = rows.emplace_back();
        row.body[0] = body;
        row.block[0] = gradients.col(k);
        row.gap = frame.R.col(i).dot(frame.R.col(j)) - (i == j ? 1 : 0);
        row.bias = 2 * frame.dR.col(i).dot(frame.dR.col(j));
      }
    }
  }

  // c of the head comment: of the inertia's size; none where E is far from singular.
  static bool is_regular(const Matrix& second_moment) {
    const Vec3 moments = eigen_of(second_moment.template cast<double>()).values;
    constexpr double kFar = 1e-2;  // at which two digits are lost
    return moments.minCoeff() > kFar * moments.maxCoeff();
  }
  Real regulariser(int i) const { return second_moment_[i].trace() / 3; }

  using Mass9 = Eigen::Matrix<Real, 9, 9>;
  static Mass9 mass_of(const Matrix& second_moment) {
    Mass9 mass = Mass9::Zero();
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) mass.template block<3, 3>(3 * j, 3 * k) = second_moment(j, k) * Matrix::Identity();
    }
    return mass;
  }
  static InverseMass inverse_of(const Body& body, const Mass9& mass) {
    InverseMass inverse = InverseMass::Zero();
    inverse.template topLeftCorner<3, 3>() = Matrix::Identity() / static_cast<Real>(body.mass);
    inverse.template bottomRightCorner<9, 9>() = mass.llt().solve(Mass9::Identity());
    return inverse;
  }
  static InverseMass constant_inverse_mass(const Body& body, const Matrix& second_moment) {
    return is_regular(second_moment) ? inverse_of(body, mass_of(second_moment)) : InverseMass(InverseMass::Zero());
  }

  std::vector<InverseMass> inverse_masses(const std::vector<Frame>& frames) const {
    std::vector<InverseMass> inverse = masses_;
    for (const int i : singular_) {
      Mass9 mass = mass_of(second_moment_[i]);
      std::vector<Row> own;
      add_own_rows(order_[i], frames[i], own);
      for (const Row& row : own) {
        const Eigen::Matrix<Real, 9, 1> p = row.block[0].template tail<9>();
        mass += regulariser(i) * p * p.transpose();
      }
      inverse[order_[i]] = inverse_of(scene_.bodies[i], mass);
    }
    return inverse;
  }

  void add_loads(const std::vector<const TimedForce*>& acting, std::vector<Frame>& frames) const {
    for (const int i : moving_) {
      const Real mass = static_cast<Real>(scene_.bodies[i].mass);
      frames[i].push(mass * scene_.gravity.template cast<Real>(), Vector::Zero());
    }
    Frame world;
    const auto at = [&](int body) -> Frame& { return body == kWorld ? world : frames[body]; };
    for (const Spring& spring : scene_.springs) {
      const Vector point_a = spring.point_a.template cast<Real>(), point_b = spring.point_b.template cast<Real>();
      Frame &a = at(spring.a), &b = at(spring.b);
      const Vector line = b.point(point_b) - a.point(point_a);
      const Real length = line.norm();
      if (length == 0) continue;
      const Vector n = line / length;
      const Real stretch = length - static_cast<Real>(spring.rest_length),
                 rate = n.dot(b.rate_of(point_b) - a.rate_of(point_a)),
                 tension = elastic_effort(spring, stretch) + static_cast<Real>(spring.damping) * rate;
      a.push(tension * n, point_a), b.push(-tension * n, point_b);
    }
    for (const TimedForce* timed : acting) {
      at(timed->body).push(timed->force.template cast<Real>(), timed->point.template cast<Real>());
      at(timed->body).turn(timed->torque.template cast<Real>());
    }
  }

  Scene scene_;
  std::vector<int> moving_, order_;    // as in JointedMotion
  std::vector<Matrix> second_moment_;  // E, of all bodies
  std::vector<InverseMass> masses_;    // of the moving bodies, if they are constant
  std::vector<int> singular_;          // bodies of which they are not
  std::optional<NaturalJoints<Real>> joints_;
  RowChoice choice_;
};

template <typename Real>
class NaturalCoordinates<Real>::Interval {
 public:
  Interval(const NaturalCoordinates& motion, double t, AxisModes modes, RowChoice choice)
      : motion_(&motion),
        modes_(std::move(modes)),
        acting_(acting_at(motion.scene_, t)),
        efforts_(motion.scene_, motion.axes(), t, modes_),
        solver_(std::move(choice)) {}

  void operator()(const State& state, State& change, Real) {
    change.assign(state.size(), std::numeric_limits<Real>::quiet_NaN());
    std::vector<Frame> frames = motion_->frames_of(state);
    const JointRows<Real, 12> rows = motion_->rows_at(state, frames, modes_);
    const auto mass = motion_->inverse_masses(frames);
    if (!solver_.factorise(rows.constraints, mass)) return;
    motion_->add_loads(acting_, frames);
    std::vector<Block> efforts = efforts_.on_bodies(rows.axes, rates_of(state), state, motion_->axis_place(), change);
    accelerations_.resize(mass.size());
    for (const int i : motion_->moving_) {
      const int b = motion_->order_[i];
      accelerations_[b].noalias() = mass[b] * (frames[i].force + efforts[b]);
    }
    for (const int i : motion_->singular_) {
      const int b = motion_->order_[i];
      accelerations_[b].noalias() = mass[b] * (regularised_load(i, frames[i]) + efforts[b]);
    }
    const auto added = solver_.correction(rows.constraints, mass,
                                          [&](const Row& row) { return Real(row.rate(accelerations_) + row.bias); });
    for (std::size_t b = 0; b < mass.size(); ++b) {
      accelerations_[b] += added[b];
      for (int k = 0; k < 12; ++k) {
        change[kNumbersPerBody * b + k] = state[kNumbersPerBody * b + 12 + k];
        change[kNumbersPerBody * b + 12 + k] = accelerations_[b][k];
      }
    }
  }

  // As JointedMotion's.
  bool project(State& state) {
    return project_by<Real>([&](Residual what) { return correct(state, what); });
  }
  bool project_rates(State& state) { return correct(state, Residual::rate).has_value(); }
  std::vector<AxisMotion<Real>> axes_at(const State& state) const {
    return axis_motions(modes_, motion_->rows_at(state, motion_->frames_of(state), {}).axes, solver_.multipliers(),
                        rates_of(state), accelerations_);
  }

 private:
  Block regularised_load(int i, const Frame& frame) const {
    Block load = frame.force;
    std::vector<Row> own;
    add_own_rows(motion_->order_[i], frame, own);
    for (const Row& row : own) load -= motion_->regulariser(i) * row.bias * row.block[0];
    return load;
  }

  std::vector<Block> rates_of(const State& state) const {
    std::vector<Block> rates(motion_->moving_.size());
    for (std::size_t b = 0; b < rates.size(); ++b) rates[b] = Eigen::Map<const Block>(&state[kNumbersPerBody * b + 12]);
    return rates;
  }

  std::optional<double> correct(State& state, Residual what) {
    const std::vector<Frame> frames = motion_->frames_of(state);
    const std::vector<Row> rows = motion_->rows_at(state, frames, modes_).constraints;
    const auto mass = motion_->inverse_masses(frames);
    if (!solver_.factorise(rows, mass)) return std::nullopt;
    const std::vector<Block> rates = rates_of(state);
    const auto moves = solver_.correction(rows, mass, [&](const Row& row) { return row.residual(what, rates); });
    const int first = what == Residual::gap ? 0 : 12;  // of the numbers of a body that are moved
    double largest = 0;
    for (std::size_t b = 0; b < mass.size(); ++b) {
      largest = std::max(largest, static_cast<double>(moves[b].template lpNorm<Eigen::Infinity>()));
      for (int k = 0; k < 12; ++k) state[kNumbersPerBody * b + first + k] += moves[b][k];
    }
    return largest;
  }

  const NaturalCoordinates* motion_;
  AxisModes modes_;
  std::vector<const TimedForce*> acting_;
  AxisEfforts<Real> efforts_;
  Rows solver_;
  std::vector<Block> accelerations_;
};

}  // namespace rigor::inline truth
