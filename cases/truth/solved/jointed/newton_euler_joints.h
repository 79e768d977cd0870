// The rows of joints on bodies with velocities v, w in W, for any number type. They use points p, arms r = p - centre
// and directions fixed in a or b, with their second derivatives (Haug, Computer Aided Kinematics and Dynamics of
// Mechanical Systems, 1989, chapter 9):
//   shared point    p_b - p_a = 0                   bias  w_b x (w_b x r_b) - w_a x (w_a x r_a)
//   right angle     u_a . u_b = c                   bias  (w_a x (w_a x u_a)) . u_b + 2 (w_a x u_a) . (w_b x u_b) + ..
//   no way across   n_a . (p_b - x_a) = c           bias  (w_a x (w_a x n)) . d + 2 (w_a x n) . d' + n . (w_b x (w_b x
//   r_b)) distance        (d . d - L^2) / 2 = 0           bias  d' . d' + d . (centripetal accelerations)
// and, where a limit or a motor keeps the coordinate of a joint (axis_modes.h),
//   an angle        n . (w_b - w_a) = speed         bias  (w_a x n) . w_b
//   a way           as no way across, with the slider's axis
#pragma once

#include <array>
#include <utility>
#include <variant>
#include <vector>

#include "cases/truth/solved/equations_of_motion.h"
#include "cases/truth/solved/jointed/constraint_rows.h"
#include "cases/truth/solved/jointed/joint_axis.h"
#include "cases/truth/solved/jointed/newton_euler_series.h"
#include "cases/truth/solved/jointed/transmissions.h"

namespace rigor::inline truth {

template <typename Real>
class NewtonEulerJoints {
 public:
  using Pose = typename EquationsOfMotion<Real>::Pose;
  using Vector = typename EquationsOfMotion<Real>::Vector;
  using Row = ReferenceRow<Real, 6>;

  // `order`: of each body, its place among those that move; -1 if it is fixed. The bodies are as in `start`.
  NewtonEulerJoints(const Scene& scene, std::vector<int> order, const std::vector<Pose>& start)
      : axes_(axes_in_use<Real>(scene)),
        order_(std::move(order)),
        transmissions_(scene, axes_),
        series_(scene, axes_, [&](int body) -> const Pose& { return pose(start, body); }) {
    for (const Joint& joint : scene.joints) {
      std::visit([&](const auto& type) { add(joint, type, pose(start, joint.a), pose(start, joint.b)); }, joint.type);
    }
  }

  const std::vector<JointAxis<Real>>& axes() const { return axes_; }

  // Adds the rows of the joints, and of their axes. `turned`: of each axis in use, its coordinate: of a hinge to within
  // half a turn, of an axis of a compound joint nearly.
  void add_rows(const std::vector<Pose>& poses, const Real* turned, JointRows<Real, 6>& rows) const {
    std::vector<Row>& all = rows.constraints;
    for (const SharedPoint& point : points_) add_rows(point, poses, all);
    for (const RightAngle& angle : angles_) add_row(angle, poses, all);
    for (const Across& offset : offsets_) add_row(offset, poses, all);
    for (const Distance& distance : distances_) add_row(distance, poses, all);
    for (std::size_t k = 0; k < axes_.size(); ++k)
      rows.axes.push_back(axes_[k].is_in_series ? Row() : axis_row(axes_[k], poses, turned[k]));
    series_.add_rows([&](int body) -> const Pose& { return pose(poses, body); }, order_, turned, rows);
    transmissions_.add_rows([&](const JointAxis<Real>& axis, Real by) { return axis_row(axis, poses, by); }, rows);
  }

 private:
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
    Vector of_a, at_b;  // in the bodies' frames
    Real offset;
  };
  struct Distance {
    int a, b;
    Vector at_a, at_b;
    Real length;
  };

  // The row of an axis's rate; its gap is the coordinate, which equals `turned` up to less than half a turn.
  Row axis_row(const JointAxis<Real>& axis, const std::vector<Pose>& poses, Real turned) const {
    const Pose &a = pose(poses, axis.a), &b = pose(poses, axis.b);
    if (!axis.is_hinge) {
      std::vector<Row> rows;
      add_row(Across{axis.a, axis.b, axis.direction_a, Vector::Zero(), axis.way_start}, poses, rows);
      return rows.front();
    }
    const Vector n = a.R * axis.direction_a;
    Row row;
    set(row, 0, axis.a, Vector::Zero(), -n);
    set(row, 1, axis.b, Vector::Zero(), n);
    row.gap = axis.coordinate(a.position, a.R, b.position, b.R, turned);
    row.bias = a.w.cross(n).dot(b.w);
    return row;
  }

  // A joint that a mask of locked motions describes.
  template <typename Type>
  void add(const Joint& joint, const Type&, const Pose& a, const Pose& b) {
    constexpr unsigned locks = Type::descriptor().locks.value();
    const Vec3 *anchor = anchor_of(joint), *axis = axis_of(joint);
    const Vector point = anchor ? Vector(anchor->template cast<Real>()) : b.position;
    const Vector along = axis ? Vector(axis->template cast<Real>().normalized()) : Vector(Vector::Unit(2));
    if constexpr ((locks & Lock::shifts) == Lock::shifts)
      share(joint, point, a, b);
    else if constexpr ((locks & Lock::shifts) == Lock::across)
      for (const Vector& u : across(along))
        offsets_.push_back({joint.a, joint.b, a.R.transpose() * u, in(b, point), u.dot(point - a.position)});
    else if constexpr ((locks & Lock::shifts) == Lock::shift_z)
      offsets_.push_back({joint.a, joint.b, a.R.transpose() * along, in(b, point), along.dot(point - a.position)});
    if constexpr ((locks & Lock::turns) ==
                  Lock::turns)  // each of three axes of one at right angles to one of the other
      for (int k = 0; k < 3; ++k) keep_angle(joint, Vector::Unit(k), Vector::Unit((k + 1) % 3), a, b);
    else if constexpr ((locks & Lock::turns) == Lock::tilt)
      for (const Vector& u : across(along)) keep_angle(joint, u, along, a, b);
  }

  // Its thread is a row of transmissions.h.
  void add(const Joint& joint, const ScrewJoint& type, const Pose& a, const Pose& b) {
    add(joint, CylindricalJoint{type.anchor, type.axis}, a, b);
  }
  // CompoundJoints has its rows.
  void add(const Joint&, const CompoundJoint&, const Pose&, const Pose&) {}
  void add(const Joint&, const CompoundAxis&, const Pose&, const Pose&) {}

  void add(const Joint& joint, const UniversalJoint& type, const Pose& a, const Pose& b) {
    share(joint, type.anchor.template cast<Real>(), a, b);
    keep_angle(joint, type.axis.template cast<Real>(), type.axis2.template cast<Real>(), a, b);
  }

  void add(const Joint& joint, const DistanceJoint& type, const Pose& a, const Pose& b) {
    const Vector at_a = type.point_a.template cast<Real>(), at_b = type.point_b.template cast<Real>();
    const Real length = (b.position + b.R * at_b - a.position - a.R * at_a).norm();
    distances_.push_back({joint.a, joint.b, at_a, at_b, length});
  }

  static Vector in(const Pose& body, const Vector& point) { return body.R.transpose() * (point - body.position); }

  void share(const Joint& joint, const Vector& point, const Pose& a, const Pose& b) {
    points_.push_back({joint.a, joint.b, in(a, point), in(b, point)});
  }

  void keep_angle(const Joint& joint, const Vector& u, const Vector& v, const Pose& a, const Pose& b) {
    angles_.push_back({joint.a, joint.b, a.R.transpose() * u, b.R.transpose() * v, u.dot(v)});
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

  void set(Row& row, int end, int body, const Vector& linear, const Vector& angular) const {
    if (body == kWorld || order_[body] < 0) return;
    row.body[end] = order_[body];
    row.block[end] << linear, angular;
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
    const Vector n = a.R * offset.of_a, arm_b = b.R * offset.at_b, apart = b.position + arm_b - a.position,
                 rate = b.velocity + b.w.cross(arm_b) - a.velocity;
    Row& row = rows.emplace_back();
    set(row, 0, offset.a, -n, n.cross(apart));
    set(row, 1, offset.b, n, arm_b.cross(n));
    row.gap = n.dot(apart) - offset.offset;
    row.bias = centripetal(a, n).dot(apart) + 2 * a.w.cross(n).dot(rate) + n.dot(centripetal(b, arm_b));
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

  std::vector<JointAxis<Real>> axes_;
  std::vector<int> order_;
  Transmissions<Real> transmissions_;
  CompoundJoints<NewtonEulerSeries<Real>, Real> series_;
  std::vector<SharedPoint> points_;
  std::vector<RightAngle> angles_;
  std::vector<Across> offsets_;
  std::vector<Distance> distances_;
};

}  // namespace rigor::inline truth
