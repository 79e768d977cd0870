#include "core/dynamics/integrators/symmetric_kick.h"

namespace rigor::inline dynamics {

SymmetricKick::SymmetricKick(const System& system)
    : system_(system),
      carried_(kCarriedColumns, system.size()),
      loads_(system),
      equations_(damped() ? system.size() : 0, BlockSystem::Kind::symmetric),
      impulse_(6 * static_cast<Eigen::Index>(system.size())),
      change_(impulse_.size()) {}

void SymmetricKick::begin(BodyColumns state) {
  system_.constants.for_each_block(
      [&](const Bodies& block) { kernels().momentum_of(block, state.column(0), carried()); });
}

void SymmetricKick::end(MutableBodyColumns state) const {
  system_.constants.for_each_block(
      [&](const Bodies& block) { kernels().velocity_of(block, state.column(0), carried_.data()); });
}

bool SymmetricKick::apply(MutableBodyColumns state, double h, double t, double dt, std::optional<double> instant) {
  if (damped()) {
    end(state);  // dampers need w
    system_.wrenches(state, t, dt, wrenches_);
    return damped_kick(state, h, t, dt);
  }
  const double* const wrench = loads_.over_step(state, t, dt, instant);
  system_.constants.for_each_block(
      [&](const Bodies& block) { kernels().momentum_kick(block, state.column(0), carried(), wrench, h); });
  return true;
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
    const Vec3 momentum = angular_momentum_of(system_.bodies[i], state.rotation(i), change.tail<3>());
    for (int k = 0; k < 3; ++k) carried_.column(kMomentum + k)[i] += momentum[k];
  }
  return true;
}

}  // namespace rigor::inline dynamics
