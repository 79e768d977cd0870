#include "adapters/common/twin_joint_solver.h"

#include "core/base/factors.h"

namespace rigor::inline adapters {
namespace {

constexpr Eigen::Index kMostDense = 64;  // rows, up to which a dense factorisation takes less than a sparse one's order

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

// p of A p = b with A = S + softness, and whether it has one; once refined, for rows that repeat others are nearly
// singular.
template <typename Factors, typename Matrix>
Eigen::VectorXd TwinJointSolver::solved(const Factors& factors, const Matrix& matrix, const Eigen::VectorXd& right) {
  warning_ = factors.is_regular() ? "" : "the joints' equations have no single solution, and cfm is zero";
  const Eigen::VectorXd impulses = factors.solve(right);
  return impulses + factors.solve(right - matrix * impulses);
}

void TwinJointSolver::push(MutableBodyColumns state, double dt) {
  const auto count = static_cast<Eigen::Index>(missing_.size());
  Sparse J(count, 6 * static_cast<Eigen::Index>(state.size()));
  J.setFromTriplets(of_J_.begin(), of_J_.end());
  const Sparse by_impulse = inverse_mass(state) * Sparse(J.transpose());  // M⁻¹ Jᵀ
  const double softness = cfm_ ? *cfm_ / dt : softness_;
  const Eigen::VectorXd target = erp_ / dt * Eigen::Map<const Eigen::VectorXd>(missing_.data(), count),
                        right = target - J * velocities_of(state);
  Eigen::VectorXd impulses;
  if (count <= kMostDense) {
    Eigen::MatrixXd system = J * by_impulse;
    system.diagonal().array() += softness;
    impulses = solved(SymmetricFactors(system), system, right);
  } else {
    Sparse identity(count, count);
    identity.setIdentity();
    const Sparse system = Sparse(J * by_impulse) + softness * identity;
    impulses = solved(SparseFactors(system), system, right);
  }
  const Eigen::VectorXd change = by_impulse * impulses;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto of_body = change.segment<6>(6 * static_cast<Eigen::Index>(i));
    state.set_velocity(i, state.velocity(i) + Vec3(of_body.head<3>()));
    state.set_angular_velocity(i, state.angular_velocity(i) + Vec3(of_body.tail<3>()));
  }
  of_J_.clear(), missing_.clear();
}

}  // namespace rigor::inline adapters
