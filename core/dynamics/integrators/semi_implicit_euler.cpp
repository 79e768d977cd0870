// Semi-implicit (symplectic) Euler: velocities first, then positions with the new velocities.
//   v1 = v0 + dt F0/m,  w1 = w0 + dt I⁻¹(tau0 - w0 x I w0),  x1 = x0 + dt v1,  R1 = R0 turned by dt w1
// The course's rule for contact acts between the two. Its velocities belong half a step before its positions. On an
// oscillation of frequency f it is stable while f dt < 2. The gyroscopic term is explicit, so that a free body's spin
// is not symplectic.
#include "core/dynamics/integrators/integrator.h"

namespace rigor {
namespace {

class SemiImplicitEuler : public Stepper {
 public:
  explicit SemiImplicitEuler(const StepperParts& parts) : parts_(parts) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    parts_.system.wrenches(state, t, dt, wrenches_);
    for (std::size_t i = 0; i < state.size(); ++i) kick(state, i, dt);
    if (parts_.contact) parts_.contact->resolve(state);
    for (std::size_t i = 0; i < state.size(); ++i) drift(state, i, dt);
  }

 private:
  void kick(MutableBodyColumns state, std::size_t i, double dt) const {
    const Inertia& body = parts_.system.bodies[i];
    const Vec3 w = state.angular_velocity(i);
    state.set_velocity(i, state.velocity(i) + dt * body.inverse_mass * wrenches_[i].force);
    state.set_angular_velocity(i, w + dt * angular_acceleration(body, state.rotation(i), w, wrenches_[i].torque));
  }

  void drift(MutableBodyColumns state, std::size_t i, double dt) const {
    state.set_position(i, state.position(i) + dt * state.velocity(i));
    parts_.orientation->advance(state, i, state.angular_velocity(i), dt);
  }

  StepperParts parts_;
  Wrenches wrenches_;
};

}  // namespace

extern const Integrator kSemiImplicitEuler;
const Integrator kSemiImplicitEuler = {
    .name = "semi-implicit-euler",
    .summary = "velocities first, then positions with them; what most engines do",
    .order = 1,
    .symplectic = true,
    .velocity_lag = 0.5,
    .default_orientation = "quaternion-exponential",
    .make = make_stepper<SemiImplicitEuler>,
};

}  // namespace rigor
