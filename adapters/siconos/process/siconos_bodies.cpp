#include "adapters/siconos/process/siconos_bodies.h"

#include <SiconosVector.hpp>
#include <SimpleMatrix.hpp>
#include <utility>

#include "core/dynamics/model/system.h"

namespace rigor::inline adapters::siconos {

LoadedBody::LoadedBody(Bodies& all, int index, SP::SiconosVector q, SP::SiconosVector twist, double mass,
                       SP::SimpleMatrix inertia)
    : NewtonEulerDS(q, twist, mass, inertia), all_(all), index_(index) {}

void LoadedBody::computeForces(double time, SP::SiconosVector q, SP::SiconosVector twist) {
  NewtonEulerDS::computeForces(time, q, twist);  // the gyroscopic moment
  const Wrench& wrench = all_.wrench(index_);
  const Quat turn((*q)(3), (*q)(4), (*q)(5), (*q)(6));
  const Vec3 torque_B = turn.conjugate() * wrench.torque;
  for (int k = 0; k < 3; ++k) {
    (*_wrench)(k) += wrench.force[k];
    (*_wrench)(3 + k) += torque_B[k];
  }
}

void LoadedBody::computeJacobianvForces(double time) {
  NewtonEulerDS::computeJacobianvForces(time);
  const Mat6& slope = all_.slope(index_);
  for (unsigned row = 0; row < 6; ++row) {
    for (unsigned column = 0; column < 6; ++column) (*_jacobianWrenchTwist)(row, column) += slope(row, column);
  }
}

Bodies::Bodies(const Scene& scene)
    : scene_(scene), loads_(scene), table_(scene.bodies.size()), systems_(scene.bodies.size()) {
  set_initial_state(scene, table_.columns());
}

void Bodies::make_systems(double theta, double dt) {
  reach_ = theta * dt;
  const BodyColumns state = std::as_const(table_).columns();
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    const Body& body = scene_.bodies[i];
    if (body.fixed) continue;
    const auto q = std::make_shared<SiconosVector>(7), twist = std::make_shared<SiconosVector>(6);
    const auto inertia = std::make_shared<SimpleMatrix>(3, 3);
    const Quat turn = state.orientation(i);
    const Vec3 x = state.position(i), v = state.velocity(i), w_B = turn.conjugate() * state.angular_velocity(i);
    (*q)(3) = turn.w(), (*q)(4) = turn.x(), (*q)(5) = turn.y(), (*q)(6) = turn.z();
    for (int k = 0; k < 3; ++k) {
      (*q)(k) = x[k], (*twist)(k) = v[k], (*twist)(3 + k) = w_B[k];
      for (int j = 0; j < 3; ++j) inertia->setValue(k, j, body.inertia(k, j));
    }
    systems_[i] = std::make_shared<LoadedBody>(*this, static_cast<int>(i), q, twist, body.mass, inertia);
  }
}

void Bodies::gather() {
  const MutableBodyColumns columns = table_.columns();
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    if (!systems_[i]) continue;
    const SiconosVector &q = *systems_[i]->q(), &twist = *systems_[i]->twist();
    const Quat turn(q(3), q(4), q(5), q(6));
    columns.set_position(i, {q(0), q(1), q(2)});
    columns.set_orientation(i, turn);
    columns.set_velocity(i, {twist(0), twist(1), twist(2)});
    columns.set_angular_velocity(i, turn * Vec3(twist(3), twist(4), twist(5)));
  }
}

// Siconos asks for each body in order, while none of them moves. The loads are computed when it starts again at the
// first.
const Wrench& Bodies::wrench(int body) {
  if (body <= last_wrench_ || wrenches_.empty()) {
    gather();
    loads_.evaluate_with_gravity(state(), time_, 0, wrenches_);
  }
  last_wrench_ = body;
  return wrenches_[static_cast<std::size_t>(body)];
}

const Mat6& Bodies::slope(int body) {
  if (body <= last_slope_ || slopes_.empty()) {
    gather();
    loads_.evaluate_with_gravity(state(), time_, 0, wrenches_);
    load_slopes(loads_, state(), wrenches_, time_, reach_, slopes_);
  }
  last_slope_ = body;
  return slopes_[static_cast<std::size_t>(body)];
}

}  // namespace rigor::inline adapters::siconos
