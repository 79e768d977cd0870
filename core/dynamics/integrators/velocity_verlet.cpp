// Velocity Verlet: half a kick, a drift, half a kick, for v and for the angular momentum L.
//   v += dt/2 F/m, L += dt/2 tau;   x += dt v, R by free_rotation.h;   the same kick at the new positions
// With dampers the second kick needs the velocity at its own end: one predictor and one corrector keep second order.
#include "core/dynamics/free_rotation.h"
#include "core/dynamics/integrators/integrator.h"

namespace rigor {
namespace {

class VelocityVerlet : public Stepper {
 public:
  explicit VelocityVerlet(const StepperParts& parts) : parts_(parts), rotations_(free_rotations(parts.system)) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    parts_.system.wrenches(state, t, dt, wrenches_);
    for (std::size_t i = 0; i < state.size(); ++i) kick(state, i, dt);
    if (parts_.contact) parts_.contact->resolve(state);
    for (std::size_t i = 0; i < state.size(); ++i) drift(state, i, dt);

    parts_.system.wrenches(state, t, dt, wrenches_);
    if (parts_.system.loads.damped()) {
      predicted_ = BodyColumns(state);
      for (std::size_t i = 0; i < state.size(); ++i) kick(predicted_.columns(), i, dt);
      parts_.system.wrenches(predicted_.columns(), t, dt, wrenches_);
    }
    for (std::size_t i = 0; i < state.size(); ++i) kick(state, i, dt);
  }

 private:
  // Half a kick: w changes as L does, at the orientation of the moment.
  void kick(MutableBodyColumns state, std::size_t i, double dt) const {
    const Inertia& body = parts_.system.bodies[i];
    state.set_velocity(i, state.velocity(i) + 0.5 * dt * body.inverse_mass * wrenches_[i].force);
    const Vec3 change = angular_velocity_of(body, state.rotation(i), 0.5 * dt * wrenches_[i].torque);
    state.set_angular_velocity(i, state.angular_velocity(i) + change);
  }

  void drift(MutableBodyColumns state, std::size_t i, double dt) const {
    const Inertia& body = parts_.system.bodies[i];
    if (body.fixed) return;
    state.set_position(i, state.position(i) + dt * state.velocity(i));
    const Vec3 L = angular_momentum_of(body, state.rotation(i), state.angular_velocity(i));
    state.set_orientation(i, rotations_[i].advance(state.orientation(i), L, dt));
    state.set_angular_velocity(i, angular_velocity_of(body, state.rotation(i), L));
  }

  StepperParts parts_;
  std::vector<FreeRotation> rotations_;
  Wrenches wrenches_;
  BodyTable predicted_;
};

}  // namespace

extern const Integrator kVelocityVerlet;
const Integrator kVelocityVerlet = {
    .name = "velocity-verlet",
    .summary = "kick, drift, kick with an exact splitting of the free rotation; keeps |L| to rounding",
    .order = 2,
    .symplectic = true,
    .symmetric = true,
    .velocity_lag = 0,
    .default_orientation = "",
    .make = make_stepper<VelocityVerlet>,
};

}  // namespace rigor
