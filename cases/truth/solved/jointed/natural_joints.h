// The joints of a scene in natural coordinates (natural_coordinates.h). Each is a set of polynomials of degree two in
// its bodies' coordinates, kept at their values at t = 0:
//   shared point   p_b - p_a                  dot product   u_a . u_b
//   dot offset     u_a . (p_b - x_a)          squared       (p_b - p_a)^2 / 2
// and the rate of a joint's own coordinate, of a hinge n . (w_b - w_a) with w = 1/2 sum d_i x d_i'.
#pragma once

#include <array>
#include <utility>
#include <variant>
#include <vector>

#include "cases/truth/solved/jointed/constraint_rows.h"
#include "cases/truth/solved/jointed/joint_axis.h"
#include "cases/truth/solved/jointed/natural_frame.h"
#include "cases/truth/solved/jointed/natural_series.h"
#include "cases/truth/solved/jointed/transmissions.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

template <typename Real>
class NaturalJoints {
 public:
  using Frame = NaturalFrame<Real>;
  using Row = ReferenceRow<Real, 12>;
  using Vector = typename Frame::Vector;

  // `order`: of each body, its place among those that move; -1 if it is fixed. The bodies are as in `start`.
  NaturalJoints(const Scene& scene, std::vector<int> order, const std::vector<Frame>& start)
      : axes_(axes_in_use<Real>(scene)),
        order_(std::move(order)),
        transmissions_(scene, axes_),
        series_(scene, axes_, [&](int body) -> const Frame& { return frame(start, body); }) {
    for (const Joint& joint : scene.joints) {
      std::visit([&](const auto& type) { add(joint, type, frame(start, joint.a), frame(start, joint.b)); }, joint.type);
    }
  }

  const std::vector<JointAxis<Real>>& axes() const { return axes_; }

  // Adds the rows of the joints, and of their axes. `turned`: of each axis in use, its coordinate: of a hinge to within
  // half a turn, of an axis of a compound joint nearly.
  void add_rows(const std::vector<Frame>& frames, const Real* turned, JointRows<Real, 12>& rows) const {
    std::vector<Row>& all = rows.constraints;
    for (const SharedPoint& point : points_) add_rows(point, frames, all);
    for (const DotProduct& dot : dots_) add_row(dot, frames, all);
    for (const DotOffset& offset : offsets_) add_row(offset, frames, all);
    for (const Squared& squared : squares_) add_row(squared, frames, all);
    for (std::size_t k = 0; k < axes_.size(); ++k)
      rows.axes.push_back(axes_[k].is_in_series ? Row() : axis_row(axes_[k], frames, turned[k]));
    series_.add_rows([&](int body) -> const Frame& { return frame(frames, body); }, order_, turned, rows);
    transmissions_.add_rows([&](const JointAxis<Real>& axis, Real by) { return axis_row(axis, frames, by); }, rows);
  }

 private:
  struct SharedPoint {
    int a, b;
    Vector at_a, at_b;
  };
  struct DotProduct {  // of a direction of a with one of b
    int a, b;
    Vector of_a, of_b;
    Real kept;
  };
  struct DotOffset {  // of a direction of a with the way from a's centre to a point of b
    int a, b;
    Vector of_a, at_b;
    Real kept;
  };
  struct Squared {  // of the way between two points
    int a, b;
    Vector at_a, at_b;
    Real kept;
  };

  static const Frame& frame(const std::vector<Frame>& frames, int body) {
    static const Frame world;
    return body == kWorld ? world : frames[body];
  }

  // The row of an axis's rate; its gap is the coordinate, which equals `turned` up to less than half a turn.
  Row axis_row(const JointAxis<Real>& axis, const std::vector<Frame>& frames, Real turned) const {
    const Frame &a = frame(frames, axis.a), &b = frame(frames, axis.b);
    if (!axis.is_hinge) {
      std::vector<Row> rows;
      add_row(DotOffset{axis.a, axis.b, axis.direction_a, Vector::Zero(), axis.way_start}, frames, rows);
      return rows.front();
    }
    const Vector n = a.R * axis.direction_a;
    Row row;
    const auto turn = [&](int end, int body, const Frame& of, const Vector& by) {
      if (body == kWorld || order_[body] < 0) return;
      row.body[end] = order_[body];
      for (int i = 0; i < 3; ++i) row.block[end].template segment<3>(3 + 3 * i) = by.cross(Vector(of.R.col(i))) / 2;
    };
    turn(0, axis.a, a, -n), turn(1, axis.b, b, n);
    row.gap = axis.coordinate(a.x, a.R, b.x, b.R, turned);
    row.bias = Vector(a.dR * axis.direction_a).dot(b.w() - a.w());
    return row;
  }

  // A joint that a mask of locked motions describes. Without an anchor a shared point is halfway between the centres.
  template <typename Type>
  void add(const Joint& joint, const Type&, const Frame& a, const Frame& b) {
    constexpr unsigned locks = Type::descriptor().locks.value();
    const Vec3 *anchor = anchor_of(joint), *axis = axis_of(joint);
    const Vector along = axis ? Vector(axis->template cast<Real>().normalized()) : Vector(Vector::Unit(2));
    if constexpr ((locks & Lock::shifts) == Lock::shifts) {
      share(joint, anchor ? Vector(anchor->template cast<Real>()) : Vector((a.x + b.x) / 2), a, b);
    } else if constexpr ((locks & Lock::shifts) == Lock::across) {
      const Vector point = anchor ? Vector(anchor->template cast<Real>()) : b.x;
      for (const Vector& u : beside(along))
        offsets_.push_back(
            {joint.a, joint.b, a.R.transpose() * u, b.R.transpose() * (point - b.x), u.dot(point - a.x)});
    }
    if constexpr ((locks & Lock::shifts) == Lock::shift_z) {
      const Vector point = anchor->template cast<Real>();
      offsets_.push_back(
          {joint.a, joint.b, a.R.transpose() * along, b.R.transpose() * (point - b.x), along.dot(point - a.x)});
    }
    if constexpr ((locks & Lock::turns) == Lock::turns) {  // d_i of a against d_j of b, as at the start
      for (int k = 0; k < 3; ++k) keep_dot(joint, Vector::Unit((k + 1) % 3), b.R.transpose() * a.R.col(k), a, b);
    } else if constexpr ((locks & Lock::turns) == Lock::tilt) {
      for (const Vector& u : beside(along)) keep_dot(joint, a.R.transpose() * along, b.R.transpose() * u, a, b);
    }
  }

  // Its thread is a row of transmissions.h.
  void add(const Joint& joint, const ScrewJoint& type, const Frame& a, const Frame& b) {
    add(joint, CylindricalJoint{type.anchor, type.axis}, a, b);
  }
  // CompoundJoints has its rows.
  void add(const Joint&, const CompoundJoint&, const Frame&, const Frame&) {}
  void add(const Joint&, const CompoundAxis&, const Frame&, const Frame&) {}

  void add(const Joint& joint, const UniversalJoint& type, const Frame& a, const Frame& b) {
    share(joint, type.anchor.template cast<Real>(), a, b);
    keep_dot(joint, a.R.transpose() * type.axis.template cast<Real>(),
             b.R.transpose() * type.axis2.template cast<Real>(), a, b);
  }

  void add(const Joint& joint, const DistanceJoint& type, const Frame& a, const Frame& b) {
    const Vector at_a = type.point_a.template cast<Real>(), at_b = type.point_b.template cast<Real>();
    squares_.push_back({joint.a, joint.b, at_a, at_b, (b.point(at_b) - a.point(at_a)).squaredNorm()});
  }

  void share(const Joint& joint, const Vector& point, const Frame& a, const Frame& b) {
    points_.push_back({joint.a, joint.b, a.R.transpose() * (point - a.x), b.R.transpose() * (point - b.x)});
  }

  void keep_dot(const Joint& joint, const Vector& of_a, const Vector& of_b, const Frame& a, const Frame& b) {
    const Vector u = a.R * of_a, v = b.R * of_b;
    dots_.push_back({joint.a, joint.b, of_a, of_b, u.dot(v)});
  }

  static Real abs_of(const Real& number) { return number < 0 ? Real(-number) : number; }

  // Two directions across the axis: two of W's axes without their parts along it, made orthonormal.
  static std::array<Vector, 2> beside(const Vector& axis) {
    Vector first = Vector::Unit(0), second = Vector::Unit(1);
    if (abs_of(axis[0]) > abs_of(axis[2])) first = Vector::Unit(2);
    if (abs_of(axis[1]) > abs_of(axis[0]) && abs_of(axis[1]) > abs_of(axis[2]))
      first = Vector::Unit(0), second = Vector::Unit(2);
    first = (first - axis.dot(first) * axis).normalized();
    second = (second - axis.dot(second) * axis - first.dot(second) * first).normalized();
    return {first, second};
  }

  // d/dx = linear, d/d(d_i) = weights_i linear.
  void set(Row& row, int end, int body, const Vector& on_centre, const Vector& weights, const Vector& on_axes) const {
    if (body == kWorld || order_[body] < 0) return;
    row.body[end] = order_[body];
    row.block[end].template head<3>() = on_centre;
    for (int i = 0; i < 3; ++i) row.block[end].template segment<3>(3 + 3 * i) = weights[i] * on_axes;
  }

  void add_rows(const SharedPoint& point, const std::vector<Frame>& frames, std::vector<Row>& rows) const {
    const Frame &a = frame(frames, point.a), &b = frame(frames, point.b);
    const Vector gap = b.point(point.at_b) - a.point(point.at_a);
    for (int k = 0; k < 3; ++k) {
      Row& row = rows.emplace_back();
      const Vector axis = Vector::Unit(k);
      set(row, 0, point.a, -axis, point.at_a, -axis), set(row, 1, point.b, axis, point.at_b, axis);
      row.gap = gap[k];
    }
  }

  void add_row(const DotProduct& dot, const std::vector<Frame>& frames, std::vector<Row>& rows) const {
    const Frame &a = frame(frames, dot.a), &b = frame(frames, dot.b);
    const Vector u = a.R * dot.of_a, v = b.R * dot.of_b;
    Row& row = rows.emplace_back();
    set(row, 0, dot.a, Vector::Zero(), dot.of_a, v), set(row, 1, dot.b, Vector::Zero(), dot.of_b, u);
    row.gap = u.dot(v) - dot.kept;
    row.bias = 2 * (a.dR * dot.of_a).dot(b.dR * dot.of_b);
  }

  void add_row(const DotOffset& offset, const std::vector<Frame>& frames, std::vector<Row>& rows) const {
    const Frame &a = frame(frames, offset.a), &b = frame(frames, offset.b);
    const Vector n = a.R * offset.of_a;
    Row& row = rows.emplace_back();
    const Vector apart = b.point(offset.at_b) - a.x;
    set(row, 0, offset.a, -n, offset.of_a, apart), set(row, 1, offset.b, n, offset.at_b, n);
    row.gap = n.dot(apart) - offset.kept;
    row.bias = 2 * (a.dR * offset.of_a).dot(b.rate_of(offset.at_b) - a.dx);
  }

  void add_row(const Squared& squared, const std::vector<Frame>& frames, std::vector<Row>& rows) const {
    const Frame &a = frame(frames, squared.a), &b = frame(frames, squared.b);
    const Vector d = b.point(squared.at_b) - a.point(squared.at_a);
    Row& row = rows.emplace_back();
    set(row, 0, squared.a, -d, squared.at_a, -d), set(row, 1, squared.b, d, squared.at_b, d);
    row.gap = (d.squaredNorm() - squared.kept) / 2;
    row.bias = (b.rate_of(squared.at_b) - a.rate_of(squared.at_a)).squaredNorm();
  }

  std::vector<JointAxis<Real>> axes_;
  std::vector<int> order_;
  Transmissions<Real> transmissions_;
  CompoundJoints<NaturalSeries<Real>, Real> series_;
  std::vector<SharedPoint> points_;
  std::vector<DotProduct> dots_;
  std::vector<DotOffset> offsets_;
  std::vector<Squared> squares_;
};

}  // namespace rigor::inline truth
