// The rows of a compound joint (core/scene/joints/compound_joint.h) in natural coordinates. A body's placement is the
// matrix B = (x, d_1, d_2, d_3). The axes put b at A T, where T has four rows and columns and is a product over the
// axes:
//   T = F_1(x_1) F_2(x_2) .. T_0,   F_i' = Z_i F_i x_i'
// with a constant Z_i of each axis: B = A T is linear in the numbers of both bodies. Its derivatives are those of a
// product; there is no angular velocity.
#pragma once

#include <vector>

#include "cases/truth/solved/jointed/natural_frame.h"
#include "cases/truth/solved/jointed/series_rows.h"

namespace rigor::inline truth {

template <typename Real>
class NaturalSeries {
 public:
  using Frame = NaturalFrame<Real>;
  using Vector = typename Frame::Vector;
  using Matrix = typename Frame::Matrix;
  using Row = ReferenceRow<Real, 12>;

  // `length`: series_length().
  NaturalSeries(const std::vector<SeriesAxis>& axes, const Frame& a, const Frame& b, double length) : length_(length) {
    start_.setZero();
    start_(0, 0) = 1;
    start_.template bottomLeftCorner<3, 1>() = a.R.transpose() * (b.x - a.x);
    start_.template bottomRightCorner<3, 3>() = a.R.transpose() * b.R;
    for (const SeriesAxis& axis : axes) {
      const Vector direction = a.R.transpose() * axis.axis.template cast<Real>().normalized(),
                   anchor = a.R.transpose() * (axis.anchor.template cast<Real>() - a.x);
      axes_.push_back({axis.turns, axis.turns ? turning(direction, anchor) : shifting(direction)});
    }
  }

  // Rows on a (end 0) and b (end 1), without these bodies. `near`: the coordinates, near enough for Newton's method.
  // All numbers are NaN if none are near, or if an axis repeats the others.
  SeriesRows<Row> at(const Frame& a, const Frame& b, const Real* near) const {
    const auto place_at_x = [&](const Coordinates& x) { return place_at(a, b, x); };
    const Coordinates x = coordinates_near<Real>(near, axes_.size(), place_at_x);
    const Place place = place_at_x(x);
    const Placement A = placement(a.x, a.R), dA = placement(a.dx, a.dR), dB = placement(b.dx, b.dR);
    const InMotion moving = in_motion(x, place.basis.coordinates_of(block(dB - dA * place.T)));
    const Block left_over = block(2 * dA * moving.dT + A * moving.ddT);
    const auto row = [&](const Block& along) {
      Row out;
      out.block[0] = -block(Eigen::Map<const Placement>(along.data()) * place.T.transpose());
      out.block[1] = along;
      out.bias = -along.dot(left_over);
      return out;
    };
    return place.basis.template rows<Row>(x, place.gap, row);
  }

 private:
  using Block = typename Frame::Block;
  using Placement = Eigen::Matrix<Real, 3, 4>;
  using Map4 = Eigen::Matrix<Real, 4, 4>;  // of (1, a point of b) to (1, that point in a)
  using Columns = typename SeriesBasis<Real, 12>::Columns;
  using Coordinates = SeriesCoordinates<Real>;
  struct Axis {
    bool turns;
    Map4 rate;  // Z_i, in a's frame
  };
  struct Place {
    SeriesBasis<Real, 12> basis;
    Block gap;  // of b from where the axes put it
    Map4 T;
  };

  static Map4 turning(const Vector& n, const Vector& anchor) {
    Map4 Z = Map4::Zero();
    for (int k = 0; k < 3; ++k) Z.template block<3, 1>(1, 1 + k) = n.cross(Vector(Vector::Unit(k)));
    Z.template block<3, 1>(1, 0) = -n.cross(anchor);
    return Z;
  }
  static Map4 shifting(const Vector& n) {
    Map4 Z = Map4::Zero();
    Z.template block<3, 1>(1, 0) = n;
    return Z;
  }
  // exp(Z x): Z³ = -Z about a line, and Z² = 0 along one.
  static Map4 moved(const Axis& axis, const Real& x) {
    using std::sin;
    if (!axis.turns) return Map4::Identity() + x * axis.rate;
    const Real half = sin(x / 2);
    return Map4::Identity() + sin(x) * axis.rate + 2 * half * half * axis.rate * axis.rate;
  }

  static Placement placement(const Vector& x, const Matrix& d) {
    Placement all;
    all << x, d;
    return all;
  }
  static Block block(const Placement& placement) { return Eigen::Map<const Block>(placement.data()); }

  Place place_at(const Frame& a, const Frame& b, const Coordinates& x) const {
    const Eigen::Index n = x.size();
    const Placement A = placement(a.x, a.R);
    Columns columns(12, n + 6);
    std::vector<Map4> by_axis(axes_.size());
    Map4 T = start_;
    for (std::size_t i = axes_.size(); i-- > 0;) {
      const Map4 F = moved(axes_[i], x[static_cast<Eigen::Index>(i)]);
      T = F * T;
      for (std::size_t j = i + 1; j < axes_.size(); ++j) by_axis[j] = F * by_axis[j];
      by_axis[i] = axes_[i].rate * T;
    }
    for (Eigen::Index i = 0; i < n; ++i) columns.col(i) = block(A * by_axis[static_cast<std::size_t>(i)]);
    columns.rightCols(6) = b.gradients();  // b keeps these by itself
    return {SeriesBasis<Real, 12>(columns, n, length_), block(placement(b.x, b.R) - A * T), T};
  }

  // T with its first and second derivatives, while the rates are constant.
  struct InMotion {
    Map4 T, dT, ddT;
  };
  InMotion in_motion(const Coordinates& x, const Coordinates& rates) const {
    InMotion all = {start_, Map4::Zero(), Map4::Zero()};
    for (std::size_t i = axes_.size(); i-- > 0;) {
      const auto k = static_cast<Eigen::Index>(i);
      const Map4 F = moved(axes_[i], x[k]), dF = rates[k] * axes_[i].rate * F, ddF = rates[k] * axes_[i].rate * dF;
      all.ddT = ddF * all.T + 2 * dF * all.dT + F * all.ddT;
      all.dT = dF * all.T + F * all.dT;
      all.T = F * all.T;
    }
    return all;
  }

  double length_;  // m
  std::vector<Axis> axes_;
  Map4 start_;  // T_0
};

}  // namespace rigor::inline truth
