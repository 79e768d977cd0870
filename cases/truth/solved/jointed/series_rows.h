// The rows of a compound joint, for any coordinates of its bodies. The directions in which its axes move b are columns.
// Motions at right angles to them are locked. The least squares of a motion by them are the axes' own motions.
#pragma once

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <vector>

#include "cases/truth/solved/jointed/axis_rows.h"
#include "cases/truth/solved/jointed/constraint_rows.h"
#include "cases/truth/solved/jointed/joint_axis.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

// Of bodies, on a (end 0) and b (end 1), without these.
template <typename Row>
struct SeriesRows {
  std::vector<Row> locked, coordinates;
};

template <typename Real>
using SeriesCoordinates = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, static_cast<int>(kMostSeriesAxes), 1>;

// m: the radius of gyration of b, or of a if b is fixed. It is as far as a radian, so that rows of metres and of
// radians weigh alike.
inline double series_length(const Joint& joint, const std::vector<Body>& bodies) {
  for (const int end : {joint.b, joint.a}) {
    if (end == kWorld || bodies[static_cast<std::size_t>(end)].fixed) continue;
    const Body& body = bodies[static_cast<std::size_t>(end)];
    return std::sqrt(body.inertia.trace() / body.mass);
  }
  return 1;
}

// In M numbers per body, of which the first three are metres. The first columns are those of the axes; others are
// locked, too, by rows elsewhere.
template <typename Real, int M>
class SeriesBasis {
 public:
  using Columns = Eigen::Matrix<Real, M, Eigen::Dynamic, 0, M, M>;
  using Block = Eigen::Matrix<Real, M, 1>;

  SeriesBasis(const Columns& columns, Eigen::Index axes, double length) : axes_(axes), rank_(columns.cols()) {
    weights_.setOnes();
    weights_.template head<3>() /= static_cast<Real>(length);
    const Columns weighed = weights_.asDiagonal() * columns;
    qr_.compute(weighed);
    for (Eigen::Index i = 0; i < rank_; ++i) {
      using std::abs;
      constexpr double kSingular = 1e-7;  // sine of its angle to those before it; seven digits are lost
      if (!(abs(qr_.matrixQR()(i, i)) > static_cast<Real>(kSingular) * weighed.col(i).norm())) is_singular_ = true;
    }
  }

  bool is_singular() const { return is_singular_; }

  // The least squares of b's motion against a by the axes.
  SeriesCoordinates<Real> coordinates_of(const Block& motion) const {
    const Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, M, 1> all = qr_.solve(Block(weights_.cwiseProduct(motion)));
    return all.head(axes_);
  }

  // The size of such a move, in radians.
  Real size_of(const SeriesCoordinates<Real>& move) const {
    return (qr_.matrixQR().topLeftCorner(axes_, axes_).template triangularView<Eigen::Upper>() * move).norm();
  }

  // `row(along)`: the row of what b's motion has along it.
  template <typename Row, typename RowOf>
  SeriesRows<Row> rows(const SeriesCoordinates<Real>& x, const Block& gap, const RowOf& row) const {
    const Eigen::Matrix<Real, M, M> Q = qr_.householderQ();
    const Columns of_all = Columns(Q.leftCols(rank_));
    const Columns inverse =
        qr_.matrixQR().topRows(rank_).template triangularView<Eigen::Upper>().solve(of_all.transpose()).transpose();
    SeriesRows<Row> rows;
    for (Eigen::Index i = 0; i < axes_; ++i) {
      rows.coordinates.push_back(row(Block(weights_.cwiseProduct(inverse.col(i)))));
      rows.coordinates.back().gap = x[i];
    }
    for (Eigen::Index i = rank_; i < M; ++i) {
      rows.locked.push_back(row(Block(weights_.cwiseProduct(Q.col(i)))));
      rows.locked.back().gap = Q.col(i).dot(weights_.cwiseProduct(gap));
    }
    return rows;
  }

 private:
  Eigen::Index axes_, rank_;
  Block weights_;
  Eigen::HouseholderQR<Columns> qr_;
  bool is_singular_ = false;
};

// The coordinates at which the axes put b nearest to where it is, by Newton's method. `step_at(x)`: a basis, and b's
// gap there, to first order. All are NaN if none are near, or if an axis there repeats the others.
template <typename Real, typename StepAt>
SeriesCoordinates<Real> coordinates_near(const Real* near, std::size_t axes, const StepAt& step_at) {
  constexpr int kMostRounds = 12;
  constexpr double kEnough = 1e-2 * std::numeric_limits<Real>::epsilon();  // of a step's square: each squares the rest
  SeriesCoordinates<Real> x =
      Eigen::Map<const Eigen::Matrix<Real, Eigen::Dynamic, 1>>(near, static_cast<Eigen::Index>(axes));
  for (int round = 0; round < kMostRounds; ++round) {
    const auto at = step_at(x);
    if (at.basis.is_singular()) break;
    const SeriesCoordinates<Real> step = at.basis.coordinates_of(at.gap);
    x += step;
    const Real size = at.basis.size_of(step);
    if (size * size < static_cast<Real>(kEnough)) return x;
  }
  return x.setConstant(std::numeric_limits<Real>::quiet_NaN());
}

// The compound joints of a scene. `Series`: the rows of one, in the coordinates of its bodies.
template <typename Series, typename Real>
class CompoundJoints {
 public:
  // `body_of(k)`: body k, or the world, at t = 0.
  template <typename BodyOf>
  CompoundJoints(const Scene& scene, const std::vector<JointAxis<Real>>& axes, const BodyOf& body_of) {
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
      const Joint& joint = scene.joints[k];
      const auto* compound = std::get_if<CompoundJoint>(&joint.type);
      if (!compound) continue;
      const std::size_t first = place_of(static_cast<int>(k) + 1, axes);
      all_.push_back({joint.a, joint.b, first,
                      Series(compound->axes, body_of(joint.a), body_of(joint.b), series_length(joint, scene.bodies))});
    }
  }

  // `order`: of each body, its place among those that move. `turned`: of each axis in use, nearly its coordinate.
  template <typename BodyOf, int N>
  void add_rows(const BodyOf& body_of, const std::vector<int>& order, const Real* turned,
                JointRows<Real, N>& rows) const {
    for (const One& one : all_) {
      const auto found = one.series.at(body_of(one.a), body_of(one.b), turned + one.first);
      const auto placed = [&](auto row) {
        int end = 0;
        for (const int body : {one.a, one.b}) row.body[end++] = body == kWorld ? -1 : order[body];
        return row;
      };
      for (const auto& row : found.locked) rows.constraints.push_back(placed(row));
      for (std::size_t k = 0; k < found.coordinates.size(); ++k)
        rows.axes[one.first + k] = placed(found.coordinates[k]);
    }
  }

 private:
  struct One {
    int a, b;
    std::size_t first;  // of its axes, among those in use
    Series series;
  };
  std::vector<One> all_;
};

}  // namespace rigor::inline truth
