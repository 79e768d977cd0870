#include "adapters/twin_joint_solver.h"

#include <Eigen/SparseCholesky>

namespace rigor {
namespace {

Eigen::VectorXd velocities_of(BodyColumns state) {
  Eigen::VectorXd velocities(6 * static_cast<Eigen::Index>(state.size()));
  for (std::size_t i = 0; i < state.size(); ++i)
    velocities.segment<6>(6 * static_cast<Eigen::Index>(i)) << state.velocity(i), state.angular_velocity(i);
  return velocities;
}

}  // namespace

void TwinJointSolver::enter(int body, const Vec6& share) {
  if (body == kWorld) return;
  const auto row = static_cast<Eigen::Index>(missing_.size());
  for (int c = 0; c < 6; ++c)
    if (share[c] != 0) of_J_.emplace_back(row, 6 * static_cast<Eigen::Index>(body) + c, share[c]);
}

void TwinJointSolver::add_row(int a, const Vec6& on_a, int b, const Vec6& on_b, double missing) {
  enter(a, on_a), enter(b, on_b);
  missing_.push_back(missing);
}

TwinJointSolver::Sparse TwinJointSolver::inverse_mass(BodyColumns state) {
  of_inverse_mass_.clear();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Inertia& body = system_.bodies[i];
    const Mat3 R = state.rotation(i), inverse_inertia = R * body.inverse_inertia_B * R.transpose();
    const auto first = 6 * static_cast<Eigen::Index>(i);
    for (int r = 0; r < 3; ++r) {
      of_inverse_mass_.emplace_back(first + r, first + r, body.inverse_mass);
      for (int c = 0; c < 3; ++c) of_inverse_mass_.emplace_back(first + 3 + r, first + 3 + c, inverse_inertia(r, c));
    }
  }
  const auto columns = 6 * static_cast<Eigen::Index>(state.size());
  Sparse matrix(columns, columns);
  matrix.setFromTriplets(of_inverse_mass_.begin(), of_inverse_mass_.end());
  return matrix;
}

void TwinJointSolver::push(MutableBodyColumns state, double dt) {
  const auto count = static_cast<Eigen::Index>(missing_.size());
  Sparse J(count, 6 * static_cast<Eigen::Index>(state.size())), identity(count, count);
  J.setFromTriplets(of_J_.begin(), of_J_.end());
  identity.setIdentity();
  const Sparse by_impulse = inverse_mass(state) * Sparse(J.transpose());  // M⁻¹ Jᵀ
  const Sparse system = Sparse(J * by_impulse) + (cfm_ ? *cfm_ / dt : softness_) * identity;
  const Eigen::SimplicialLDLT<Sparse> factor(system);
  warning_ = factor.info() == Eigen::Success ? "" : "the joints' equations have no single solution, and cfm is zero";
  const Eigen::VectorXd target = erp_ / dt * Eigen::Map<const Eigen::VectorXd>(missing_.data(), count),
                        right = target - J * velocities_of(state);
  Eigen::VectorXd impulses = factor.solve(right);
  impulses += factor.solve(right - system * impulses);  // once refined: rows that repeat others are nearly singular
  const Eigen::VectorXd change = by_impulse * impulses;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto of_body = change.segment<6>(6 * static_cast<Eigen::Index>(i));
    state.set_velocity(i, state.velocity(i) + Vec3(of_body.head<3>()));
    state.set_angular_velocity(i, state.angular_velocity(i) + Vec3(of_body.tail<3>()));
  }
  of_J_.clear(), missing_.clear();
}

}  // namespace rigor
