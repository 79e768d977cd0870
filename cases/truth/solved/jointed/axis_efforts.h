// The efforts that springs, dampers, motors and servos exert along the free axes of joints, as forces on bodies in any
// coordinates. An effort on a coordinate x does the work of its power, effort x': its force on a body is a multiple of
// the body's block in the row of x'.
// A state of jointed bodies has, behind the numbers of all bodies, one of each axis in use: the integral of its rate,
// for its whole turns. Then come the clock and the held efforts of axis_drive.h, where the scene needs them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cases/truth/solved/jointed/axis_drive.h"
#include "cases/truth/solved/jointed/axis_modes.h"
#include "cases/truth/solved/jointed/constraint_rows.h"
#include "cases/truth/solved/jointed/joint_axis.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

// The efforts of springs, dampers, motors and servos on the axes while nothing switches.
template <typename Real>
class AxisEfforts {
 public:
  AxisEfforts(const Scene& scene, const std::vector<JointAxis<Real>>& axes, double t, const AxisModes& modes) {
    for (std::size_t k = 0; k < axes.size(); ++k) {
      drives_.emplace_back(scene, axes[k].joint, t, modes.empty() ? AxisMode() : modes[k]);
      joints_.push_back(&scene.joints[axes[k].joint]);
    }
    for (const Motor& motor : scene.motors) {
      if (motor.plus.empty() || !(t >= motor.from && t < motor.until)) continue;
      SumServo& sum = sums_.emplace_back(SumServo{{}, ServoLaw<Real>(*motor.servo, false, t)});
      const auto add = [&](int joint, double ratio) {
        sum.terms.push_back({place_of(joint, axes), static_cast<Real>(ratio)});
      };
      add(motor.joint, 1);
      for (const JointTerm& term : motor.plus) add(term.joint, term.ratio);
    }
  }

  // The generalised forces on the moving bodies, and into `change` the rates of what stands behind the bodies in a
  // state. `axes`: the rows of the axes' rates; `place`: where in a state their numbers begin.
  template <int N>
  std::vector<Eigen::Matrix<Real, N, 1>> on_bodies(const std::vector<ReferenceRow<Real, N>>& axes,
                                                   const std::vector<Eigen::Matrix<Real, N, 1>>& velocities,
                                                   const std::vector<Real>& state, std::size_t place,
                                                   std::vector<Real>& change) const {
    std::vector<Value> values;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      values.push_back({axes[k].gap, axes[k].rate(velocities)});
      change[place + k] = values[k].rate;
    }
    const std::size_t clock = place + axes.size();
    std::fill(change.begin() + static_cast<std::ptrdiff_t>(clock), change.end(), Real(0));
    if (clock < change.size()) change[clock] = 1;
    const std::vector<Real> efforts = efforts_at(values, state.data() + clock);
    std::vector<Eigen::Matrix<Real, N, 1>> forces(velocities.size(), Eigen::Matrix<Real, N, 1>::Zero());
    for (std::size_t k = 0; k < axes.size(); ++k) {
      for (int end = 0; end < 2; ++end) {
        if (const int body = axes[k].body[end]; body >= 0) forces[body] += efforts[k] * axes[k].block[end];
      }
    }
    return forces;
  }

 private:
  struct Value {
    Real x, rate;  // of a coordinate: rad or m, and per s
  };
  // A servo on a sum of coordinates.
  struct SumServo {
    struct Term {
      std::size_t axis;
      Real ratio;
    };
    std::vector<Term> terms;
    ServoLaw<Real> law;
  };

  // On b, and its opposite on a: N m or N, by axis. `clock` as in AxisDrive.
  std::vector<Real> efforts_at(const std::vector<Value>& values, const Real* clock) const {
    std::vector<Real> efforts;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto& [x, rate] = values[k];
      efforts.push_back(drives_[k].effort(x, rate, clock, k) -
                        elastic_effort(*joints_[k], Real(x - static_cast<Real>(joints_[k]->rest))) -
                        static_cast<Real>(joints_[k]->damping) * rate);
    }
    for (const SumServo& sum : sums_) {
      Value of_sum = {0, 0};
      for (const auto& [axis, ratio] : sum.terms)
        of_sum.x += ratio * values[axis].x, of_sum.rate += ratio * values[axis].rate;
      const Real effort = sum.law.effort(of_sum.x, of_sum.rate, clock[0]);
      for (const auto& [axis, ratio] : sum.terms) efforts[axis] += ratio * effort;
    }
    return efforts;
  }

  std::vector<const Joint*> joints_;     // of each axis
  std::vector<AxisDrive<Real>> drives_;  // of each axis
  std::vector<SumServo> sums_;
};

}  // namespace rigor::inline truth
