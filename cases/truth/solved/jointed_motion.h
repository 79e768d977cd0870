// The motion of jointed bodies as a differential equation, for any number type: Newton and Euler's accelerations (body
// rates, equations_of_motion.h), and the joints' forces that keep the constraints' second derivatives zero,
//   M a = f + J^T lambda,  J a + bias = 0.
// What a step leaves of the constraints themselves is projected away, weighed by mass. The rows, with their second
// derivatives, for points p, arms r = p - centre, directions fixed in a or b (Haug, Computer Aided Kinematics and
// Dynamics of Mechanical Systems, 1989, chapter 9):
//   shared point    p_b - p_a = 0                   bias  w_b x (w_b x r_b) - w_a x (w_a x r_a)
//   right angle     u_a . u_b = c                   bias  (w_a x (w_a x u_a)) . u_b + 2 (w_a x u_a) . (w_b x u_b) + ..
//   no way across   n_a . (x_b - x_a) = c           bias  (w_a x (w_a x n)) . d + 2 (w_a x n) . d'
//   distance        (d . d - L^2) / 2 = 0           bias  d' . d' + d . (centripetal accelerations)
// and, where a limit or a motor keeps the coordinate of a joint (axis_modes.h),
//   an angle        n . (w_b - w_a) = speed         bias  (w_a x n) . w_b
//   a way           as no way across, with the slider's axis
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "cases/truth/solved/axis_rows.h"
#include "cases/truth/solved/equations_of_motion.h"

namespace rigor {

template <typename Real>
class JointedMotion {
 public:
  using Free = EquationsOfMotion<Real>;
  using State = typename Free::State;
  using Vector = typename Free::Vector;
  using Matrix = typename Free::Matrix;
  using Pose = typename Free::Pose;
  using Rows = ConstraintRows<Real, 6>;  // velocities: v, w in W
  using Row = typename Rows::Row;

  explicit JointedMotion(const Scene& scene) : free_(scene, Formulation::body_rates) {
    order_.assign(scene.bodies.size(), -1);
    for (std::size_t k = 0; k < free_.moving().size(); ++k) order_[free_.moving()[k]] = static_cast<int>(k);
    const std::vector<Pose> start = poses_of(free_.start());
    for (const Joint& joint : scene.joints) add(joint, start);
    choice_ = choose_rows<Rows>(rows_at(start), inverse_masses(start));
  }

  State start() const {
    State state = free_.start();
    during(0).project(state);
    return state;
  }

  class Interval;
  // The right-hand side while the loads are those that act at t [s], and limits and motors do what `modes` say.
  Interval during(double t) const { return {*this, t, {}, choice_}; }
  Interval during(double t, const AxisModes& modes, RowChoice choice) const {
    return {*this, t, modes, std::move(choice)};
  }
  // Of the rows in these modes, at a state of them.
  RowChoice choice_at(const State& state, const AxisModes& modes) const {
    const std::vector<Pose> poses = poses_of(state);
    std::vector<Row> rows = rows_at(poses);
    const std::size_t of_joints = rows.size();
    add_mode_rows(modes, state, poses, rows);
    return rows.size() == of_joints ? choice_ : choose_rows<Rows>(rows, inverse_masses(poses));
  }
  const std::vector<JointAxis<Real>>& axes() const { return free_.axes(); }
  const Scene& scene() const { return free_.scene(); }

  template <typename Number>
  void write(const Number* state, MutableBodyColumns out) const {
    free_.write(state, out);
  }

 private:
  using Block = typename Row::Block;
  using InverseMass = typename Rows::InverseMass;

  struct SharedPoint {
    int a, b;
    Vector at_a, at_b;  // in the bodies' frames
  };
  struct RightAngle {
    int a, b;
    Vector of_a, of_b;  // in the bodies' frames
    Real product;       // kept
  };
  struct Across {
    int a, b;
    Vector of_a;
    Real offset;
  };
  struct Distance {
    int a, b;
    Vector at_a, at_b;
    Real length;
  };

  std::vector<Pose> poses_of(const State& state) const {
    std::vector<Pose> poses = free_.standing_poses();
    free_.read_poses(state, poses);
    return poses;
  }

  static const Pose& pose(const std::vector<Pose>& poses, int body) {
    static const Pose world;
    return body == kWorld ? world : poses[body];
  }

  static std::array<Vector, 2> across(const Vector& axis) {
    int smallest = 0;
    axis.cwiseAbs().minCoeff(&smallest);
    const Vector first = axis.cross(Vector(Vector::Unit(smallest))).normalized();
    return {first, axis.cross(first)};
  }

  void add(const Joint& joint, const std::vector<Pose>& start) {
    const Pose &a = pose(start, joint.a), &b = pose(start, joint.b);
    const auto in = [](const Pose& body, const Vector& point) {
      return Vector(body.R.transpose() * (point - body.position));
    };
    const auto share = [&](const Vec3& anchor) {
      const Vector point = anchor.template cast<Real>();
      points_.push_back({joint.a, joint.b, in(a, point), in(b, point)});
    };
    const auto keep_angle = [&](const Vector& u, const Vector& v) {
      angles_.push_back({joint.a, joint.b, a.R.transpose() * u, b.R.transpose() * v, u.dot(v)});
    };
    const auto keep_turn = [&] {  // of b against a: each of three axes of one at right angles to one of the other
      for (int k = 0; k < 3; ++k) keep_angle(Vector::Unit(k), Vector::Unit((k + 1) % 3));
    };
    if (const auto* ball = std::get_if<BallJoint>(&joint.type)) {
      share(ball->anchor);
    } else if (const auto* hinge = std::get_if<HingeJoint>(&joint.type)) {
      share(hinge->anchor);
      const Vector axis = hinge->axis.template cast<Real>().normalized();
      for (const Vector& u : across(axis)) keep_angle(u, axis);
    } else if (const auto* universal = std::get_if<UniversalJoint>(&joint.type)) {
      share(universal->anchor);
      keep_angle(universal->axis.template cast<Real>(), universal->axis2.template cast<Real>());
    } else if (const auto* slider = std::get_if<SliderJoint>(&joint.type)) {
      keep_turn();
      for (const Vector& u : across(slider->axis.template cast<Real>().normalized())) {
        offsets_.push_back({joint.a, joint.b, a.R.transpose() * u, u.dot(b.position - a.position)});
      }
    } else if (std::holds_alternative<FixedJoint>(joint.type)) {
      keep_turn();
      points_.push_back({joint.a, joint.b, in(a, b.position), Vector::Zero()});
    } else {
      const auto& distance = std::get<DistanceJoint>(joint.type);
      const Vector at_a = distance.point_a.template cast<Real>(), at_b = distance.point_b.template cast<Real>();
      const Real length = (b.position + b.R * at_b - a.position - a.R * at_a).norm();
      distances_.push_back({joint.a, joint.b, at_a, at_b, length});
    }
  }

  void set(Row& row, int end, int body, const Vector& linear, const Vector& angular) const {
    if (body == kWorld || order_[body] < 0) return;
    row.body[end] = order_[body];
    row.block[end] << linear, angular;
  }

  std::vector<Row> rows_at(const std::vector<Pose>& poses) const {
    std::vector<Row> rows;
    rows.reserve(3 * points_.size() + angles_.size() + offsets_.size() + distances_.size() + axes().size());
    for (const SharedPoint& point : points_) add_rows(point, poses, rows);
    for (const RightAngle& angle : angles_) add_row(angle, poses, rows);
    for (const Across& offset : offsets_) add_row(offset, poses, rows);
    for (const Distance& distance : distances_) add_row(distance, poses, rows);
    return rows;
  }

  static Vector centripetal(const Pose& body, const Vector& arm) { return body.w.cross(body.w.cross(arm)); }

  void add_rows(const SharedPoint& point, const std::vector<Pose>& poses, std::vector<Row>& rows) const {
    const Pose &a = pose(poses, point.a), &b = pose(poses, point.b);
    const Vector arm_a = a.R * point.at_a, arm_b = b.R * point.at_b, gap = b.position + arm_b - a.position - arm_a,
                 bias = centripetal(b, arm_b) - centripetal(a, arm_a);
    for (int k = 0; k < 3; ++k) {
      const Vector axis = Vector::Unit(k);
      Row& row = rows.emplace_back();
      set(row, 0, point.a, -axis, -arm_a.cross(axis));
      set(row, 1, point.b, axis, arm_b.cross(axis));
      row.gap = gap[k], row.bias = bias[k];
    }
  }

  void add_row(const RightAngle& angle, const std::vector<Pose>& poses, std::vector<Row>& rows) const {
    const Pose &a = pose(poses, angle.a), &b = pose(poses, angle.b);
    const Vector u = a.R * angle.of_a, v = b.R * angle.of_b, turn = u.cross(v);
    Row& row = rows.emplace_back();
    set(row, 0, angle.a, Vector::Zero(), turn);
    set(row, 1, angle.b, Vector::Zero(), -turn);
    row.gap = u.dot(v) - angle.product;
    row.bias = centripetal(a, u).dot(v) + 2 * a.w.cross(u).dot(b.w.cross(v)) + u.dot(centripetal(b, v));
  }

  void add_row(const Across& offset, const std::vector<Pose>& poses, std::vector<Row>& rows) const {
    const Pose &a = pose(poses, offset.a), &b = pose(poses, offset.b);
    const Vector n = a.R * offset.of_a, apart = b.position - a.position;
    Row& row = rows.emplace_back();
    set(row, 0, offset.a, -n, n.cross(apart));
    set(row, 1, offset.b, n, Vector::Zero());
    row.gap = n.dot(apart) - offset.offset;
    row.bias = centripetal(a, n).dot(apart) + 2 * a.w.cross(n).dot(b.velocity - a.velocity);
  }

  void add_row(const Distance& distance, const std::vector<Pose>& poses, std::vector<Row>& rows) const {
    const Pose &a = pose(poses, distance.a), &b = pose(poses, distance.b);
    const Vector arm_a = a.R * distance.at_a, arm_b = b.R * distance.at_b, d = b.position + arm_b - a.position - arm_a,
                 rate = b.velocity + b.w.cross(arm_b) - a.velocity - a.w.cross(arm_a);
    Row& row = rows.emplace_back();
    set(row, 0, distance.a, -d, -arm_a.cross(d));
    set(row, 1, distance.b, d, arm_b.cross(d));
    row.gap = (d.dot(d) - distance.length * distance.length) / 2;
    row.bias = rate.dot(rate) + d.dot(centripetal(b, arm_b) - centripetal(a, arm_a));
  }

  // Of its rate; its gap is the coordinate.
  Row axis_row(std::size_t k, const State& state, const std::vector<Pose>& poses) const {
    const JointAxis<Real>& axis = axes()[k];
    const Joint& joint = scene().joints[axis.joint];
    const Pose &a = pose(poses, joint.a), &b = pose(poses, joint.b);
    if (!axis.is_hinge) {
      std::vector<Row> rows;
      add_row(Across{joint.a, joint.b, axis.direction_a, axis.way_start}, poses, rows);
      return rows.front();
    }
    const Vector n = a.R * axis.direction_a;
    Row row;
    set(row, 0, joint.a, Vector::Zero(), -n);
    set(row, 1, joint.b, Vector::Zero(), n);
    row.gap = axis.coordinate(a.position, a.R, b.position, b.R, free_.turned(state, k));
    row.bias = a.w.cross(n).dot(b.w);
    return row;
  }

  void add_mode_rows(const AxisModes& modes, const State& state, const std::vector<Pose>& poses,
                     std::vector<Row>& rows) const {
    for (std::size_t k = 0; k < modes.size(); ++k) {
      if (modes[k].has_row())
        rows.push_back(kept(axis_row(k, state, poses), modes[k], scene().joints[axes()[k].joint]));
    }
  }

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
  std::vector<SharedPoint> points_;
  std::vector<RightAngle> angles_;
  std::vector<Across> offsets_;
  std::vector<Distance> distances_;
  RowChoice choice_;  // where the motion begins
};

template <typename Real>
class JointedMotion<Real>::Interval {
 public:
  Interval(const JointedMotion& motion, double t, AxisModes modes, RowChoice choice)
      : motion_(&motion),
        modes_(std::move(modes)),
        free_(motion.free_.during(t, modes_)),
        first_choice_(std::move(choice)),
        solver_(first_choice_) {}

  // As if it were made anew: what a state leads to does not depend on those asked for before.
  void restart() { solver_.restart(first_choice_); }

  void operator()(const State& state, State& change, Real t) {
    free_(state, change, t);
    const std::vector<Pose>& poses = free_.poses();
    const std::vector<Row> rows = rows_at(state, poses);
    const auto mass = motion_->inverse_masses(poses);
    if (!solver_.factorise(rows, mass))
      return std::fill(change.begin(), change.end(), std::numeric_limits<Real>::quiet_NaN());
    const auto& moving = motion_->free_.moving();
    accelerations_.resize(moving.size());
    for (const int i : moving) {
      const Real* c = &change[motion_->free_.slot(i)];
      accelerations_[motion_->order_[i]] << Free::get(c + 7), poses[i].R * Free::get(c + 10);
    }
    const auto added =
        solver_.correction(rows, mass, [&](const Row& row) { return Real(row.rate(accelerations_) + row.bias); });
    for (const int i : moving) {
      Real* c = &change[motion_->free_.slot(i)];
      const Block& block = added[motion_->order_[i]];
      accelerations_[motion_->order_[i]] += block;
      Free::put(c + 7, Free::get(c + 7) + block.template head<3>());
      Free::put(c + 10, Free::get(c + 10) + poses[i].R.transpose() * block.template tail<3>());
    }
  }

  // Moves the state to the nearest, weighed by mass, that its joints allow. False if there is none near.
  bool project(State& state) {
    return project_by<Real>([&](Residual what) { return correct(state, what); });
  }
  // The velocities alone: an impact.
  bool project_rates(State& state) { return correct(state, Residual::rate).has_value(); }

  // The coordinates of all axes at a state; accelerations and efforts (or impulses) as operator() or project_rates()
  // left them.
  std::vector<AxisMotion<Real>> axes_at(const State& state) const {
    const std::vector<Pose> poses = motion_->poses_of(state);
    const auto velocities = motion_->velocities_of(poses);
    return axis_motions<Real>(modes_, motion_->axes().size(), solver_.multipliers(), velocities, accelerations_,
                              [&](std::size_t k) { return motion_->axis_row(k, state, poses); });
  }

 private:
  std::vector<Row> rows_at(const State& state, const std::vector<Pose>& poses) const {
    std::vector<Row> rows = motion_->rows_at(poses);
    motion_->add_mode_rows(modes_, state, poses, rows);
    return rows;
  }

  // Returns by how much [m, rad; m/s, rad/s] at most.
  std::optional<double> correct(State& state, Residual what) {
    const JointedMotion& m = *motion_;
    const std::vector<Pose> poses = m.poses_of(state);
    const std::vector<Row> rows = rows_at(state, poses);
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
  RowChoice first_choice_;
  Rows solver_;
  std::vector<Block> accelerations_;
};

}  // namespace rigor
