#include "core/dynamics/integrators/euler_passes.h"

namespace rigor::inline dynamics {
namespace {

struct Rates {
  Vec3 v, w;  // m/s², rad/s²
};

Rates rates_of(const System& system, const Bodies& block, BodyColumns state, std::size_t i, const double* wrench) {
  const Inertia& body = system.bodies[i];
  Wrench acting;
  if (wrench) {
    const double* at = wrench + i;
    for (std::size_t c = 0; c < 3; ++c) {
      acting.force[static_cast<Eigen::Index>(c)] = at[(kForce + c) * block.stride];
      acting.torque[static_cast<Eigen::Index>(c)] = at[(kTorque + c) * block.stride];
    }
  }
  Vec3 v_rate = body.inverse_mass * acting.force;
  if (!body.fixed) v_rate += system.scene_gravity;
  return {v_rate, angular_acceleration(body, state.rotation(i), state.angular_velocity(i), acting.torque)};
}

void change_velocity(MutableBodyColumns state, std::size_t i, const Rates& rates, double dt) {
  state.set_velocity(i, state.velocity(i) + dt * rates.v);
  state.set_angular_velocity(i, state.angular_velocity(i) + dt * rates.w);
}

}  // namespace

void EulerPasses::kick(const Bodies& block, MutableBodyColumns state, const double* wrench, double dt) const {
  if (!orientation_.keeps_matrix) return kernels().kick(block, state.column(0), wrench, dt);
  for (std::size_t i = block.begin; i < block.end; ++i) {
    change_velocity(state, i, rates_of(system_, block, state, i, wrench), dt);
  }
}

void EulerPasses::drift(const Bodies& block, MutableBodyColumns state, double dt) const {
  if (!orientation_.keeps_matrix) return kernels().drift(block, state.column(0), orientation_.turn, dt);
  for (std::size_t i = block.begin; i < block.end; ++i) {
    state.set_position(i, state.position(i) + dt * state.velocity(i));
    orientation_.advance(state, i, state.angular_velocity(i), dt);
  }
}

void EulerPasses::kick_and_drift_at_once(const Bodies& block, MutableBodyColumns state, const double* wrench,
                                         double dt) const {
  if (!orientation_.keeps_matrix) return kernels().explicit_step(block, state.column(0), wrench, orientation_.turn, dt);
  for (std::size_t i = block.begin; i < block.end; ++i) {
    const Rates rates = rates_of(system_, block, state, i, wrench);
    state.set_position(i, state.position(i) + dt * state.velocity(i));
    orientation_.advance(state, i, state.angular_velocity(i), dt);
    change_velocity(state, i, rates, dt);
  }
}

}  // namespace rigor::inline dynamics
