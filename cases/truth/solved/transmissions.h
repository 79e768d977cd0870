// Rows that tie coordinates of joints (joint_axis.h) to each other or to rotors, for any number type and coordinates of
// bodies:
//   a coupling   x - ratio y - offset = 0
//   a screw      way - pitch angle / 2 pi = 0, beside the rows of a cylindrical joint
//   an armature  I x'' = -l: the row of x'', in which the multiplier l gives way by 1/I
#pragma once

#include <boost/math/constants/constants.hpp>
#include <vector>

#include "cases/truth/solved/constraint_rows.h"
#include "cases/truth/solved/joint_axis.h"

namespace rigor {

template <typename Real>
class Transmissions {
 public:
  Transmissions(const Scene& scene, const std::vector<JointAxis<Real>>& axes) {
    const auto place = [&](int joint) {
      std::size_t k = 0;
      while (axes[k].joint != static_cast<std::size_t>(joint)) ++k;
      return k;
    };
    for (const Coupling& coupling : scene.couplings)
      pairs_.push_back({place(coupling.joint), place(coupling.to), static_cast<Real>(coupling.ratio),
                        static_cast<Real>(coupling.offset)});
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

  // `row_of(axis, turned)`: the row of an axis's rate, as of joints. `row_of_use(k)`: that of an axis in use, at its
  // state.
  template <typename Row, typename RowOf, typename RowOfUse>
  void add_rows(const RowOf& row_of, const RowOfUse& row_of_use, std::vector<Row>& rows) const {
    for (const Thread& thread : threads_) {
      Row row = row_of(thread.way, Real(0));
      add(-thread.per_radian, row_of(thread.turn, row.gap / thread.per_radian), 0, row);
      rows.push_back(row);
    }
    for (const Pair& pair : pairs_) {
      Row row = row_of_use(pair.x);
      add(-pair.ratio, row_of_use(pair.y), 2, row);
      row.gap -= pair.offset;
      rows.push_back(row);
    }
    for (const Rotor& rotor : rotors_) {
      Row row = row_of_use(rotor.axis);
      row.gap = 0, row.compliance = rotor.compliance;
      rows.push_back(row);
    }
  }

 private:
  struct Pair {
    std::size_t x, y;  // of the axes in use
    Real ratio, offset;
  };
  struct Rotor {
    std::size_t axis;
    Real compliance;  // 1/(kg m²), 1/kg
  };
  struct Thread {
    JointAxis<Real> way, turn;
    Real per_radian;  // m
  };

  // Adds a multiple of another row, whose blocks come to the ends from `first` on.
  template <typename Row>
  static void add(Real factor, const Row& other, int first, Row& row) {
    for (int k = 0; k < 2; ++k) {
      row.body[first + k] = other.body[k];
      row.block[first + k] += factor * other.block[k];
    }
    row.gap += factor * other.gap, row.bias += factor * other.bias;
  }

  std::vector<Pair> pairs_;
  std::vector<Rotor> rotors_;
  std::vector<Thread> threads_;
};

}  // namespace rigor
