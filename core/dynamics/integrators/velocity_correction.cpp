#include "core/dynamics/integrators/velocity_correction.h"

namespace rigor::inline dynamics {
namespace {

void kick(const System& system, const Wrenches& wrenches, double dt, MutableBodyColumns state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Inertia& body = system.bodies[i];
    const Mat3 R = state.rotation(i);
    state.set_velocity(i, state.velocity(i) + dt * body.inverse_mass * wrenches[i].force);
    state.set_angular_velocity(
        i, state.angular_velocity(i) + dt * (R * (body.inverse_inertia_B * (R.transpose() * wrenches[i].torque))));
  }
}

}  // namespace

void resolve_ahead(Contact& contact, const System& system, const Wrenches& wrenches, double dt,
                   MutableBodyColumns state) {
  kick(system, wrenches, dt, state);
  contact.resolve(state);
  kick(system, wrenches, -dt, state);
}

}  // namespace rigor::inline dynamics
