// Explicit Euler: everything moves with what was known at the start of the step.
//   x1 = x0 + dt v0,  R1 = R0 turned by dt w0,  v1 = v0 + dt F0/m,  w1 = w0 + dt I⁻¹(tau0 - w0 x I w0)
// On an undamped oscillation of frequency f [rad/s] each step multiplies the energy by 1 + (f dt)²: it always blows up.
#include "core/dynamics/integrators/integrator.h"

namespace rigor {
namespace {

class ExplicitEuler : public Stepper {
 public:
  explicit ExplicitEuler(const StepperParts& parts) : parts_(parts) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    parts_.system.wrenches(state, t, dt, wrenches_);
    for (std::size_t i = 0; i < state.size(); ++i) step_body(state, i, dt);
    if (parts_.contact) parts_.contact->resolve(state);
  }

 private:
  void step_body(MutableBodyColumns state, std::size_t i, double dt) const {
    const Inertia& body = parts_.system.bodies[i];
    const Vec3 v = state.velocity(i), w = state.angular_velocity(i);
    const Vec3 w_rate = angular_acceleration(body, state.rotation(i), w, wrenches_[i].torque);
    state.set_position(i, state.position(i) + dt * v);
    parts_.orientation->advance(state, i, w, dt);
    state.set_velocity(i, v + dt * body.inverse_mass * wrenches_[i].force);
    state.set_angular_velocity(i, w + dt * w_rate);
  }

  StepperParts parts_;
  Wrenches wrenches_;
};

}  // namespace

extern const Integrator kExplicitEuler;
const Integrator kExplicitEuler = {
    .name = "explicit-euler",
    .summary = "positions and velocities from the start of the step; blows up on any oscillation",
    .order = 1,
    .symplectic = false,
    .velocity_lag = 0,
    .default_orientation = "quaternion-exponential",
    .make = make_stepper<ExplicitEuler>,
};

}  // namespace rigor
