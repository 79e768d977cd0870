// Rows of joint coordinates that limits and motors of a given speed keep, and the coordinates' motion at a state, for
// any number type and coordinates of bodies.
#pragma once

#include <vector>

#include "cases/truth/solved/jointed/axis_modes.h"
#include "cases/truth/solved/jointed/constraint_rows.h"
#include "cases/truth/solved/jointed/joint_axis.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

template <typename Real>
struct AxisMotion {
  Real x = 0, rate = 0, acceleration = 0;  // rad or m, and per s, per s²
  Real servo = 0, servo_change = 0;        // the effort of its continuous servo before its bound, and per s; see Stops
  Real effort = 0;  // on b, of the row that keeps it: N m or N, or of an impact N m s or N s; 0 without a row
};

template <typename Real, int N>
struct JointRows {
  std::vector<ReferenceRow<Real, N>> constraints;
  std::vector<ReferenceRow<Real, N>> axes;  // of the rates of the axes in use; their gaps are the coordinates
};

// `row` is that of the coordinate's rate; its gap is the coordinate.
template <typename Real, int N>
ReferenceRow<Real, N> kept(ReferenceRow<Real, N> row, const AxisMode& mode, const Joint& joint) {
  if (mode.limit != 0) {
    row.gap -= static_cast<Real>(mode.limit > 0 ? joint.upper : joint.lower);
    row.speed = static_cast<Real>(mode.bounce);
  } else {
    row.gap = 0, row.speed = static_cast<Real>(mode.speed);
  }
  return row;
}

// Rows of modes stand after those of the joints, in the order of the axes.
template <typename Real, int N>
void add_mode_rows(const AxisModes& modes, const std::vector<JointAxis<Real>>& axes, const std::vector<Joint>& joints,
                   JointRows<Real, N>& rows) {
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (modes[k].has_row()) rows.constraints.push_back(kept(rows.axes[k], modes[k], joints[axes[k].joint]));
  }
}

template <typename Real, int N, typename Multipliers, typename Blocks>
std::vector<AxisMotion<Real>> axis_motions(const AxisModes& modes, const std::vector<ReferenceRow<Real, N>>& axes,
                                           const Multipliers& multipliers, const Blocks& velocities,
                                           const Blocks& accelerations) {
  auto next = multipliers.size();
  for (const AxisMode& mode : modes) next -= mode.has_row() && multipliers.size() > 0 ? 1 : 0;
  std::vector<AxisMotion<Real>> all(axes.size());
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const ReferenceRow<Real, N>& row = axes[k];
    all[k].x = row.gap, all[k].rate = row.rate(velocities);
    if (!accelerations.empty()) all[k].acceleration = row.rate(accelerations) + row.bias;
    if (!modes.empty() && modes[k].has_row() && multipliers.size() > 0) all[k].effort = multipliers[next++];
  }
  return all;
}

// Selects all of them, or the independent ones if some repeat others.
template <typename Rows, typename RowVector, typename Masses>
RowChoice choose_rows(const RowVector& rows, const Masses& inverse_masses) {
  Rows all(RowChoice::all(static_cast<int>(rows.size())));
  if (all.factorise(rows, inverse_masses) && all.is_well_posed()) return all.choice();
  Rows some;
  some.factorise(rows, inverse_masses);
  return some.choice();
}

}  // namespace rigor::inline truth
