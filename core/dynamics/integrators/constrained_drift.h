// The drift of a kick-drift-kick method with joints (RATTLE: H. C. Andersen, 1983; for rigid bodies whose free rotation
// is split: A. Kol, B. B. Laird, B. J. Leimkuhler, 1997). An impulse at the start of each drift, along the joint rows
// there, closes all joints at its end. An impulse at the end of the step removes the velocities that the joints do not
// allow. The result is as symplectic and symmetric as the drift.
#pragma once

#include <algorithm>

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/joints/joints.h"

namespace rigor::inline dynamics {

class ConstrainedDrift {
 public:
  explicit ConstrainedDrift(const StepperParts& parts) : parts_(parts) {}

  bool is_free() const { return parts_.joints == nullptr; }

  // Call it before the first kick of a step, with the velocities before it.
  void begin(BodyColumns state) {
    if (!is_free()) parts_.joints->note_rotors(state);
  }

  // Calls move(state, carried) once, or, with joints, repeats it until the joints are closed at the end. v and the
  // momenta L in `carried` are those before the drift over h; w is not read.
  template <typename Move>
  void drift(MutableBodyColumns state, Columns& carried, double h, const Move& move) {
    if (is_free()) return move(state, carried.data());
    kernels().velocity_of(parts_.system.constants.all(), state.column(0), carried.data());
    const bool closed = parts_.joints->close(state, h, [&](const double* impulse) -> BodyColumns {
      end_ = BodyColumns(state);
      momenta_ = carried;
      kick(end_.columns(), momenta_, impulse);
      move(end_.columns(), momenta_.data());
      return end_.columns();
    });
    if (!closed) parts_.joints->warn_of_gap(end_.columns());
    copy_columns(end_.columns(), state);
    std::swap(carried, momenta_);
  }

  // Leaves v, L and w such as the joints allow at this pose.
  void settle(MutableBodyColumns state, Columns& carried) {
    if (is_free()) return;
    kernels().velocity_of(parts_.system.constants.all(), state.column(0), carried.data());
    kick(state, carried, parts_.joints->velocity_impulse_with_rotors(state));
    kernels().velocity_of(parts_.system.constants.all(), state.column(0), carried.data());
  }

 private:
  void kick(MutableBodyColumns state, Columns& carried, const double* impulse) const {
    Bodies bodies = parts_.system.constants.all();
    bodies.has_gravity = false;
    std::fill_n(bodies.gravity, 3, 0.0);
    kernels().momentum_kick(bodies, state.column(0), carried.data(), impulse, 1);
  }

  StepperParts parts_;
  BodyTable end_;
  Columns momenta_;
};

}  // namespace rigor::inline dynamics
