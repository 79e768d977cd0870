// The rows of a compound joint (core/scene/joints/compound_joint.h) on bodies with velocities v, w in W, for any number
// type. Twists (linear, angular) are about the point of W where b's centre is now. With the unit twists s_i of the axes
// and V_i of the frame before each of them,
//   V_b = V_a + sum s_i x_i',   s_i' = V_i x s_i    (Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 2)
// The directions at right angles to all s_i are locked. The coordinates' rates are least squares of the others.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <vector>

#include "cases/truth/solved/equations_of_motion.h"
#include "cases/truth/solved/jointed/series_rows.h"

namespace rigor::inline truth {

template <typename Real>
class NewtonEulerSeries {
 public:
  using Pose = typename EquationsOfMotion<Real>::Pose;
  using Vector = typename EquationsOfMotion<Real>::Vector;
  using Matrix = typename EquationsOfMotion<Real>::Matrix;
  using Row = ReferenceRow<Real, 6>;

  // `length`: series_length().
  NewtonEulerSeries(const std::vector<SeriesAxis>& axes, const Pose& a, const Pose& b, double length)
      : length_(length), centre_(a.R.transpose() * (b.position - a.position)), turn_(a.R.transpose() * b.R) {
    for (const SeriesAxis& axis : axes) {
      axes_.push_back({axis.turns, a.R.transpose() * axis.axis.template cast<Real>().normalized(),
                       a.R.transpose() * (axis.anchor.template cast<Real>() - a.position)});
    }
  }

  // As NaturalSeries::at().
  SeriesRows<Row> at(const Pose& a, const Pose& b, const Real* near) const {
    const auto chain_at_x = [&](const Coordinates& x) { return chain_at(a, b, x); };
    const Coordinates x = coordinates_near<Real>(near, axes_.size(), chain_at_x);
    const Chain chain = chain_at_x(x);
    const Vector line = b.position - a.position;
    const Twist change = change_of_twist(a, b, line, chain);
    const auto row = [&](const Twist& along) {
      Row out;
      const Vector force = along.template head<3>(), torque = along.template tail<3>();
      out.block[0] << -force, -torque - line.cross(force);
      out.block[1] = along;
      out.bias = -along.dot(change);
      return out;
    };
    return chain.basis.template rows<Row>(x, chain.gap, row);
  }

 private:
  using Twist = Eigen::Matrix<Real, 6, 1>;
  using Twists = typename SeriesBasis<Real, 6>::Columns;
  using Coordinates = SeriesCoordinates<Real>;
  struct Axis {
    bool turns;
    Vector direction, anchor;  // in a's frame, as at t = 0
  };
  struct Chain {
    SeriesBasis<Real, 6> basis;  // of the s_i
    Twist gap;                   // of b from where the axes put it, to first order
    Twists twists;               // s_i, in W
  };

  Chain chain_at(const Pose& a, const Pose& b, const Coordinates& x) const {
    Twists twists(6, x.size());
    Matrix turned = Matrix::Identity();  // of the frames so far against a's
    Vector moved = Vector::Zero();
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const Axis& axis = axes_[static_cast<std::size_t>(i)];
      const Vector direction = turned * axis.direction, in_W = a.R * direction;
      if (!axis.turns) {
        twists.col(i) << in_W, Vector::Zero();
        moved += x[i] * direction;
        continue;
      }
      const Vector anchor = turned * axis.anchor + moved;
      twists.col(i) << in_W.cross(Vector(b.position - a.position - a.R * anchor)), in_W;
      const Matrix turn = Eigen::AngleAxis<Real>(x[i], direction).toRotationMatrix();
      moved = anchor + turn * (moved - anchor), turned = turn * turned;
    }
    const Matrix apart = b.R * (a.R * turned * turn_).transpose();
    const Vector twice_sine(apart(2, 1) - apart(1, 2), apart(0, 2) - apart(2, 0), apart(1, 0) - apart(0, 1));
    Twist gap;
    gap << b.position - a.position - a.R * (turned * centre_ + moved), twice_sine / 2;
    return {SeriesBasis<Real, 6>(twists, twists.cols(), length_), gap, twists};
  }

  // The change of b's twist beside a's while no coordinate accelerates. A twist's change is that of the velocity at a
  // point of W, so w x v of the centres is added.
  static Twist change_of_twist(const Pose& a, const Pose& b, const Vector& line, const Chain& chain) {
    Twist carried, own, change;
    carried << a.velocity + a.w.cross(line), a.w;
    own << b.velocity, b.w;
    const Coordinates rates = chain.basis.coordinates_of(own - carried);
    change << b.w.cross(b.velocity) - a.w.cross(a.velocity), Vector::Zero();
    for (Eigen::Index i = 0; i < rates.size(); ++i) {
      const Twist twist = chain.twists.col(i);
      change += rates[i] * cross(carried, twist);
      carried += rates[i] * twist;
    }
    return change;
  }

  static Twist cross(const Twist& one, const Twist& other) {
    const Vector v = one.template head<3>(), w = one.template tail<3>(), linear = other.template head<3>(),
                 angular = other.template tail<3>();
    Twist result;
    result << w.cross(linear) + v.cross(angular), w.cross(angular);
    return result;
  }

  double length_;  // m
  std::vector<Axis> axes_;
  Vector centre_;  // of b in a's frame at t = 0
  Matrix turn_;    // of b against a at t = 0
};

}  // namespace rigor::inline truth
