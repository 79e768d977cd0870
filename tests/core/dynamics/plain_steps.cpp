#include "tests/core/dynamics/plain_steps.h"

#include <Eigen/LU>
#include <array>
#include <utility>

#include "core/dynamics/model/free_rotation.h"

namespace rigor::test {
namespace {

Wrenches wrenches_of(const System& system, const BodyTable& state, double t, double dt) {
  Wrenches wrenches;
  system.wrenches(state.columns(), t, dt, wrenches);
  return wrenches;
}

Quat turned(const Quat& q, const Vec3& w, double dt, bool additive) {
  if (!additive) return (rotation_by(dt * w) * q).normalized();
  return Quat(q.coeffs() + 0.5 * dt * (Quat(0, w.x(), w.y(), w.z()) * q).coeffs()).normalized();
}

// v1 = v0 + dt F/m, w1 = w0 + dt I⁻¹ (tau - w0 x I w0); then x and q with the new velocities, or with the old ones.
template <bool kExplicit, bool kAdditive>
void euler(const System& system, BodyTable& table, double t, double dt) {
  const Wrenches wrenches = wrenches_of(system, table, t, dt);
  const MutableBodyColumns state = table.columns();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Inertia& body = system.bodies[i];
    const BodyState old = state.body(i);
    BodyState now = old;
    now.velocity += dt * body.inverse_mass * wrenches[i].force;
    now.angular_velocity +=
        dt * angular_acceleration(body, state.rotation(i), old.angular_velocity, wrenches[i].torque);
    const BodyState& moving = kExplicit ? old : now;
    now.position += dt * moving.velocity;
    now.orientation = turned(old.orientation, moving.angular_velocity, dt, kAdditive);
    state.set_body(i, now);
  }
}

// The state with the angular momenta kept beside it.
struct Carried {
  BodyTable state;
  std::vector<Vec3> L;
};

Carried carried(const System& system, const BodyTable& table) {
  Carried c{table, {}};
  const BodyColumns bodies = table.columns();
  for (std::size_t i = 0; i < bodies.size(); ++i)
    c.L.push_back(angular_momentum_of(system.bodies[i], bodies.rotation(i), bodies.angular_velocity(i)));
  return c;
}

void write_angular_velocity(const System& system, Carried& c) {
  const MutableBodyColumns state = c.state.columns();
  for (std::size_t i = 0; i < state.size(); ++i)
    state.set_angular_velocity(i, angular_velocity_of(system.bodies[i], state.rotation(i), c.L[i]));
}

void kick(const System& system, Carried& c, const Wrenches& wrenches, double h) {
  const MutableBodyColumns state = c.state.columns();
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (system.bodies[i].fixed) continue;
    state.set_velocity(i, state.velocity(i) + h * system.bodies[i].inverse_mass * wrenches[i].force);
    c.L[i] += h * wrenches[i].torque;
  }
}

// free_rotation.h
Quat freely_turned(const Inertia& body, const Quat& q_WB, const Vec3& L, double dt) {
  const FreeRotation free(body);
  Quat q_WP = q_WB * free.q_BP;
  const auto turn_about = [&](int k, double excess, double h) {
    const double L_k = (q_WP.conjugate() * L)[k];
    q_WP = q_WP * rotation_by(h * excess * L_k * Vec3::Unit(k));
  };
  turn_about(0, free.excess_low, 0.5 * dt);
  turn_about(2, free.excess_high, dt);
  turn_about(0, free.excess_low, 0.5 * dt);
  return (rotation_by(dt * free.inverse_median * L) * q_WP * free.q_BP.conjugate()).normalized();
}

// 2 (J f + f x J f) = (1 + |f|²) dt Rᵀ L by plain Newton steps, of which the last change nothing.
Quat moser_veselov_turned(const Inertia& body, const Quat& q_WB, const Vec3& L, double dt) {
  if (body.fixed) return q_WB;
  const Mat3& J = body.inertia_B;
  const Vec3 a = dt * (matrix_of(q_WB).transpose() * L);
  Vec3 f = 0.5 * (body.inverse_inertia_B * a);
  for (int n = 0; n < 20; ++n) {
    const Vec3 residual = 2 * (J * f + f.cross(J * f)) - (1 + f.squaredNorm()) * a;
    const Mat3 slope = 2 * (J + cross_matrix(f) * J - cross_matrix(J * f) - a * f.transpose());
    f -= slope.inverse() * residual;
  }
  return (q_WB * Quat(1, f.x(), f.y(), f.z())).normalized();
}

using FreeTurn = Quat (*)(const Inertia& body, const Quat& q_WB, const Vec3& L, double dt);

void drift(const System& system, Carried& c, double h, FreeTurn turn) {
  const MutableBodyColumns state = c.state.columns();
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.set_position(i, state.position(i) + h * state.velocity(i));
    if (!system.bodies[i].fixed) state.set_orientation(i, turn(system.bodies[i], state.orientation(i), c.L[i], h));
  }
}

// Kick, drift, kick for each weight.
template <FreeTurn turn, std::size_t kCount>
void composition(const System& system, BodyTable& table, double t, double dt,
                 const std::array<double, kCount>& weights) {
  Carried c = carried(system, table);
  for (const double weight : weights) {
    kick(system, c, wrenches_of(system, c.state, t, dt), 0.5 * weight * dt);
    drift(system, c, weight * dt, turn);
    kick(system, c, wrenches_of(system, c.state, t, dt), 0.5 * weight * dt);
  }
  write_angular_velocity(system, c);
  table = c.state;
}

template <FreeTurn turn>
void leapfrog(const System& system, BodyTable& table, double t, double dt) {
  composition<turn, 1>(system, table, t, dt, {1.0});
}

void symplectic4(const System& system, BodyTable& table, double t, double dt) {
  const double g = 1 / (4 - std::cbrt(4.0));
  composition<freely_turned, 5>(system, table, t, dt, {g, g, 1 - 4 * g, g, g});
}

// The second half of the kick at the velocities that a first try predicts for its end.
void damped_verlet(const System& system, BodyTable& table, double t, double dt) {
  Carried c = carried(system, table);
  kick(system, c, wrenches_of(system, table, t, dt), 0.5 * dt);
  drift(system, c, dt, freely_turned);
  write_angular_velocity(system, c);
  Carried predicted = c;
  kick(system, predicted, wrenches_of(system, c.state, t, dt), 0.5 * dt);
  write_angular_velocity(system, predicted);
  kick(system, c, wrenches_of(system, predicted.state, t, dt), 0.5 * dt);
  write_angular_velocity(system, c);
  table = c.state;
}

// Rates of x, v, L, and of a quaternion or a rotation vector (then w is unused).
struct Rates {
  Vec3 x, v, L;
  Eigen::Vector4d q;
};

Rates rates_of(const System& system, const BodyTable& stage, const Wrenches& wrenches, std::size_t i, const Vec3* phi) {
  const Inertia& body = system.bodies[i];
  const Vec3 w = stage.columns().angular_velocity(i);
  Rates r{stage.columns().velocity(i), body.inverse_mass * wrenches[i].force,
          body.fixed ? Vec3::Zero().eval() : wrenches[i].torque, Eigen::Vector4d::Zero()};
  if (phi) {
    r.q.head<3>() = w - 0.5 * phi->cross(w) + phi->cross(phi->cross(w)) / 12;
  } else {
    r.q = 0.5 * (Quat(0, w.x(), w.y(), w.z()) * stage.columns().orientation(i)).coeffs();
  }
  return r;
}

// The motion after h times the rates from the start; phi comes out where rotation vectors are meant.
BodyTable moved(const System& system, const Carried& start, const std::vector<Rates>& rates, double h,
                std::vector<Vec3>* phi) {
  BodyTable out = start.state;
  const MutableBodyColumns state = out.columns();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Rates& r = rates[i];
    if (phi) (*phi)[i] = h * r.q.head<3>();
    const Quat q0 = state.orientation(i);
    const Quat q = phi ? Quat(rotation_by((*phi)[i]) * q0) : Quat(Eigen::Vector4d(q0.coeffs() + h * r.q));
    state.set_position(i, state.position(i) + h * r.x);
    state.set_velocity(i, state.velocity(i) + h * r.v);
    state.set_orientation(i, q.normalized());
    state.set_angular_velocity(i, angular_velocity_of(system.bodies[i], state.rotation(i), start.L[i] + h * r.L));
  }
  return out;
}

template <bool kVectors>
void runge_kutta(const System& system, BodyTable& table, double t, double dt) {
  const Carried start = carried(system, table);
  const std::size_t size = table.size();
  std::vector<Vec3> phi(size, Vec3::Zero());
  std::vector<Rates> mean(size, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Eigen::Vector4d::Zero()}), now(size);
  BodyTable stage = table;
  for (const auto& [weight, next] : {std::pair(1.0, 0.5), {2.0, 0.5}, {2.0, 1.0}, {1.0, 0.0}}) {
    const Wrenches wrenches = wrenches_of(system, stage, t, dt);
    for (std::size_t i = 0; i < size; ++i) {
      now[i] = rates_of(system, stage, wrenches, i, kVectors ? &phi[i] : nullptr);
      mean[i].x += weight / 6 * now[i].x, mean[i].v += weight / 6 * now[i].v;
      mean[i].L += weight / 6 * now[i].L, mean[i].q += weight / 6 * now[i].q;
    }
    stage = moved(system, start, now, next * dt, kVectors ? &phi : nullptr);
  }
  table = moved(system, start, mean, dt, kVectors ? &phi : nullptr);
}

}  // namespace

const std::vector<PlainMethod>& plain_methods() {
  static const std::vector<PlainMethod> table = {
      {"explicit-euler", "quaternion-additive", true, euler<true, true>},
      {"explicit-euler", "quaternion-exponential", true, euler<true, false>},
      {"moser-veselov", "", false, leapfrog<moser_veselov_turned>},
      {"rk4", "", true, runge_kutta<false>},
      {"rkmk4", "", true, runge_kutta<true>},
      {"semi-implicit-euler", "quaternion-additive", true, euler<false, true>},
      {"semi-implicit-euler", "quaternion-exponential", true, euler<false, false>},
      {"symplectic4", "", false, symplectic4},
      {"velocity-verlet", "", true, damped_verlet},
      {"velocity-verlet", "", false, leapfrog<freely_turned>},
  };
  return table;
}

}  // namespace rigor::test
