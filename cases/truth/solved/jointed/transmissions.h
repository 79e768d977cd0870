// Rows that tie coordinates of joints (joint_axis.h) to each other or to rotors, for any number type and coordinates of
// bodies:
//   a coupling   x - sum of ratio y - offset = 0
//   a screw      way - pitch angle / 2 pi = 0, beside the rows of a cylindrical joint
//   an armature  I x'' = -l: the row of x'', in which the multiplier l gives way by 1/I
#pragma once

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <utility>
#include <vector>

#include "cases/truth/solved/jointed/axis_rows.h"
#include "cases/truth/solved/jointed/constraint_rows.h"
#include "cases/truth/solved/jointed/joint_axis.h"

namespace rigor::inline truth {

template <typename Real>
class Transmissions {
 public:
  Transmissions(const Scene& scene, const std::vector<JointAxis<Real>>& axes) {
    const auto place = [&](int joint) { return place_of(joint, axes); };
    for (const Coupling& coupling : scene.couplings) {
      Sum& sum = sums_.emplace_back(Sum{place(coupling.joint), {}, static_cast<Real>(coupling.offset)});
      for (const JointTerm& term : coupling.to)
        sum.others.emplace_back(place(term.joint), static_cast<Real>(term.ratio));
    }
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const double armature = scene.joints[axes[k].joint].armature;
      if (armature > 0) rotors_.push_back({k, 1 / static_cast<Real>(armature)});
    }
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
      const auto* screw = std::get_if<ScrewJoint>(&scene.joints[k].type);
      if (!screw) continue;
      threads_.push_back({JointAxis<Real>(scene, k, screw->axis, false), JointAxis<Real>(scene, k, screw->axis, true),
                          static_cast<Real>(screw->pitch) / (2 * boost::math::constants::pi<Real>())});
    }
  }

  // `row_of(axis, turned)`: the row of an axis's rate, as of joints.
  template <int N, typename RowOf>
  void add_rows(const RowOf& row_of, JointRows<Real, N>& joints) const {
    using Row = ReferenceRow<Real, N>;
    std::vector<Row>& rows = joints.constraints;
    for (const Thread& thread : threads_) {
      Row row = row_of(thread.way, Real(0));
      add(-thread.per_radian, row_of(thread.turn, row.gap / thread.per_radian), row);
      rows.push_back(row);
    }
    for (const Sum& sum : sums_) {
      Row row = joints.axes[sum.x];
      for (const auto& [y, ratio] : sum.others) add(-ratio, joints.axes[y], row);
      row.gap -= sum.offset;
      rows.push_back(row);
    }
    for (const Rotor& rotor : rotors_) {
      Row row = joints.axes[rotor.axis];
      row.gap = 0, row.compliance = rotor.compliance;
      rows.push_back(row);
    }
  }

 private:
  struct Sum {
    std::size_t x;                                     // of the axes in use
    std::vector<std::pair<std::size_t, Real>> others;  // and their ratios
    Real offset;
  };
  struct Rotor {
    std::size_t axis;
    Real compliance;  // 1/(kg m²), 1/kg
  };
  struct Thread {
    JointAxis<Real> way, turn;
    Real per_radian;  // m
  };

  // Adds a multiple of the row of an axis. A body that the sum has already keeps its place.
  template <typename Row>
  static void add(Real factor, const Row& other, Row& row) {
    for (int k = 0; k < 2; ++k) {
      if (other.body[k] < 0) continue;
      int place = static_cast<int>(std::find(row.body, row.body + Row::kEnds, other.body[k]) - row.body);
      if (place == Row::kEnds) {
        place = static_cast<int>(std::find(row.body, row.body + Row::kEnds, -1) - row.body);
        row.body[place] = other.body[k], row.block[place].setZero();
      }
      row.block[place] += factor * other.block[k];
    }
    row.gap += factor * other.gap, row.bias += factor * other.bias;
  }

  std::vector<Sum> sums_;
  std::vector<Rotor> rotors_;
  std::vector<Thread> threads_;
};

}  // namespace rigor::inline truth
