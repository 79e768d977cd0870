#include "core/dynamics/integrators/leapfrog_composition.h"

namespace rigor {

LeapfrogComposition::LeapfrogComposition(const StepperParts& parts, std::span<const double> weights)
    : parts_(parts), weights_(weights), rotations_(free_rotations(parts.system)), kick_(parts.system) {}

void LeapfrogComposition::step(MutableBodyColumns state, double t, double dt) {
  complaint_.clear();
  if (parts_.contact) {
    parts_.system.wrenches(state, t, dt, wrenches_);
    resolve_ahead(*parts_.contact, parts_.system, wrenches_, dt, state);
  }
  kick_.begin(state);
  parts_.system.loads.for_each_smooth_part(t, dt,
                                           [&](double from, double length) { smooth_part(state, from, length); });
  kick_.end(state);
}

void LeapfrogComposition::smooth_part(MutableBodyColumns state, double t, double dt) {
  double owed = 0;  // the second half kick of the stage before
  for (const double weight : weights_) {
    const double half = 0.5 * weight * dt;
    // Two undamped kicks in a row are one; two damped ones are not quite.
    if (kick_.damped() && owed != 0) {
      kick(state, owed, t, dt);
      owed = 0;
    }
    kick(state, owed + half, t, dt);
    drift(state, weight * dt);
    owed = half;
  }
  kick(state, owed, t, dt);
}

void LeapfrogComposition::kick(MutableBodyColumns state, double h, double t, double dt) {
  if (!kick_.apply(state, h, t, dt)) complaint_ = kNoSymmetricKick;
}

void LeapfrogComposition::drift(MutableBodyColumns state, double h) const {
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (parts_.system.bodies[i].fixed) continue;
    state.set_position(i, state.position(i) + h * state.velocity(i));
    state.set_orientation(i, rotations_[i].advance(state.orientation(i), kick_.angular_momentum(i), h));
  }
}

}  // namespace rigor
