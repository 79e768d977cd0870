#include "core/dynamics/integrators/leapfrog_composition.h"

#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {

LeapfrogComposition::LeapfrogComposition(const StepperParts& parts, std::span<const double> weights)
    : parts_(parts), weights_(weights), kick_(parts.system), drift_(parts) {}

void LeapfrogComposition::step(MutableBodyColumns state, double t, double dt) {
  solver_warning_.clear();
  if (parts_.contact) {
    parts_.system.wrenches(state, t, dt, wrenches_);
    resolve_ahead(*parts_.contact, parts_.system, wrenches_, dt, state);
  }
  if (parts_.system.loads.empty() && drift_.is_free()) return free_step(state, dt);
  drift_.begin(state);
  kick_.begin(state);
  parts_.system.loads.for_each_smooth_part(t, dt,
                                           [&](double from, double length) { smooth_part(state, from, length); });
  kick_.end(state);
}

void LeapfrogComposition::archive_state(StateArchive& archive) { archive(solver_warning_); }

// No body knows of another: each block takes the whole step.
void LeapfrogComposition::free_step(MutableBodyColumns state, double dt) {
  parts_.system.constants.for_each_block([&](const Bodies& block) {
    kernels().momentum_of(block, state.column(0), kick_.carried());
    double owed = 0;  // the second half kick of the stage before
    for (const double weight : weights_) {
      kernels().momentum_kick(block, state.column(0), kick_.carried(), nullptr, owed + 0.5 * weight * dt);
      kernels().free_drift(block, state.column(0), kick_.carried(), weight * dt);
      owed = 0.5 * weight * dt;
    }
    kernels().momentum_kick(block, state.column(0), kick_.carried(), nullptr, owed);
    kernels().velocity_of(block, state.column(0), kick_.carried());
  });
}

void LeapfrogComposition::smooth_part(MutableBodyColumns state, double t, double dt) {
  double owed = 0;  // the second half kick of the stage before
  double now = t;   // to which the drifts have led
  for (const double weight : weights_) {
    const double half = 0.5 * weight * dt;
    // Two undamped kicks in a row are one; two damped ones are not quite.
    if (kick_.damped() && owed != 0) {
      kick(state, owed, t, dt, now);
      owed = 0;
    }
    kick(state, owed + half, t, dt, now);
    drift_.drift(state, kick_.carried_columns(), weight * dt, [&](MutableBodyColumns at, const double* carried) {
      parts_.system.constants.for_each_block(
          [&](const Bodies& block) { kernels().free_drift(block, at.column(0), carried, weight * dt); });
    });
    owed = half, now += weight * dt;
  }
  kick(state, owed, t, dt, now);
  drift_.settle(state, kick_.carried_columns());
}

void LeapfrogComposition::kick(MutableBodyColumns state, double h, double t, double dt, double instant) {
  if (!kick_.apply(state, h, t, dt, instant)) solver_warning_ = kNoSymmetricKick;
}

}  // namespace rigor::inline dynamics
