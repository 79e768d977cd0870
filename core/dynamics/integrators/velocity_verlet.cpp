// Velocity Verlet: half a kick, a drift, half a kick, for v and for the angular momentum L.
//   v += dt/2 F/m, L += dt/2 tau;   x += dt v, R by the splitting;   the same kick at the new positions
// The rotation without torque is split, in principal axes with moments a (the median), b, c, into
//   H = |L|²/(2a) + (1/b - 1/a)/2 L_b² + (1/c - 1/a)/2 L_c².
// Each part turns the body exactly: the first about L in space by dt |L|/a, the others about their own axis. The first
// commutes with the others, and these are composed symmetrically: second order, |L| kept to rounding, and exact where
// two moments are equal. (Splittings of the free rigid body: Hairer, Lubich, Wanner, Geometric Numerical Integration,
// VII.5.) With dampers the second kick needs the velocity at its own end: one predictor and one corrector keep second
// order.
#include "core/dynamics/integrators/integrator.h"

namespace rigor {
namespace {

struct RotationSplitting {
  Quat q_BP;                               // principal axes to B
  double inverse_median = 0;               // 1/(kg m²)
  double excess_low = 0, excess_high = 0;  // 1/b - 1/a of the smallest (P's x) and the largest moment (P's z)
};

RotationSplitting splitting_of(const Inertia& body) {
  if (body.fixed) return {Quat::Identity(), 0, 0, 0};
  const PrincipalInertia principal = principal_inertia(body.inertia_B);
  const Vec3 inverse = principal.moments.cwiseInverse();
  return {principal.q_BP, inverse.y(), inverse.x() - inverse.y(), inverse.z() - inverse.y()};
}

// Turns P by the exact flow of excess/2 L_k² over dt, with L (in W) unchanged.
void turn_about_axis(Quat& q_WP, const Vec3& L, int k, double excess, double dt) {
  const double L_k = (q_WP.conjugate() * L)[k];
  q_WP = q_WP * rotation_by(dt * excess * L_k * Vec3::Unit(k));
}

// The orientation after dt of free rotation with constant angular momentum L in W.
Quat rotate_freely(const RotationSplitting& s, const Quat& q_WB, const Vec3& L, double dt) {
  Quat q_WP = q_WB * s.q_BP;
  turn_about_axis(q_WP, L, 0, s.excess_low, 0.5 * dt);
  turn_about_axis(q_WP, L, 2, s.excess_high, dt);
  turn_about_axis(q_WP, L, 0, s.excess_low, 0.5 * dt);
  q_WP = rotation_by(dt * s.inverse_median * L) * q_WP;
  return (q_WP * s.q_BP.conjugate()).normalized();
}

class VelocityVerlet : public Stepper {
 public:
  explicit VelocityVerlet(const StepperParts& parts) : parts_(parts) {
    for (const Inertia& body : parts.system.bodies) splittings_.push_back(splitting_of(body));
  }

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
    state.set_orientation(i, rotate_freely(splittings_[i], state.orientation(i), L, dt));
    state.set_angular_velocity(i, angular_velocity_of(body, state.rotation(i), L));
  }

  StepperParts parts_;
  std::vector<RotationSplitting> splittings_;
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
