#include "core/dynamics/symmetric_kick.h"

namespace rigor {

SymmetricKick::SymmetricKick(const System& system)
    : system_(system),
      momenta_(system.size()),
      equations_(system.size()),
      impulse_(6 * static_cast<Eigen::Index>(system.size())),
      change_(impulse_.size()) {}

void SymmetricKick::begin(BodyColumns state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    momenta_[i] = angular_momentum_of(system_.bodies[i], state.rotation(i), state.angular_velocity(i));
  }
}

void SymmetricKick::end(MutableBodyColumns state) const {
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (system_.bodies[i].fixed) continue;
    state.set_angular_velocity(i, angular_velocity_of(system_.bodies[i], state.rotation(i), momenta_[i]));
  }
}

bool SymmetricKick::apply(MutableBodyColumns state, double h, double t, double dt) {
  if (damped()) end(state);  // dampers need w
  system_.wrenches(state, t, dt, wrenches_);
  if (damped()) return damped_kick(state, h, t, dt);
  kick(state, h);
  return true;
}

void SymmetricKick::kick(MutableBodyColumns state, double h) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Inertia& body = system_.bodies[i];
    if (body.fixed) continue;
    state.set_velocity(i, state.velocity(i) + h * body.inverse_mass * wrenches_[i].force);
    momenta_[i] += h * wrenches_[i].torque;
  }
}

bool SymmetricKick::damped_kick(MutableBodyColumns state, double h, double t, double dt) {
  equations_.clear();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Inertia& body = system_.bodies[i];
    Mat6 inertia = Mat6::Identity();
    Vec6 impulse = Vec6::Zero();
    if (!body.fixed) {
      const Mat3 R = state.rotation(i);
      inertia.topLeftCorner<3, 3>() *= body.mass;
      inertia.bottomRightCorner<3, 3>() = R * body.inertia_B * R.transpose();
      impulse << h * wrenches_[i].force, h * wrenches_[i].torque;
    }
    equations_.add(i, i, inertia);
    impulse_.segment<6>(6 * static_cast<Eigen::Index>(i)) = impulse;
  }
  visit_load_jacobian(system_.loads, state, t, dt, [&](const WrenchDerivative& d) {
    if (!system_.bodies[d.row].fixed && !system_.bodies[d.column].fixed)
      equations_.add(d.row, d.column, -0.5 * h * d.by_velocity);
  });
  if (!equations_.solve(impulse_, change_)) return false;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vec6 change = change_.segment<6>(6 * static_cast<Eigen::Index>(i));
    state.set_velocity(i, state.velocity(i) + change.head<3>());
    momenta_[i] += angular_momentum_of(system_.bodies[i], state.rotation(i), change.tail<3>());
  }
  return true;
}

}  // namespace rigor
