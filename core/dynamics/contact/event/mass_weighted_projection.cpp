#include "core/dynamics/contact/event/mass_weighted_projection.h"

namespace rigor::inline dynamics {
namespace {

// Redundant points make the Delassus matrix singular. This share of its diagonal is added, and iterative refinement
// removes the error in all parts that are not redundant.
constexpr double kRegularisation = 1e-6;
constexpr int kRounds = 4;
// The largest number of rows for which a dense matrix is faster. Without joints the addition makes it positive
// definite.
constexpr Eigen::Index kMostDense = 64;
constexpr int kMostActiveSets = 10;  // of unilateral targets

}  // namespace

MassWeightedProjection::Row MassWeightedProjection::row_of(BodyColumns state, const ProjectionTarget& target) {
  Row row;
  const auto along = [&](const Vec3& arm, const Vec3& direction) -> PoseStep {
    return target.is_of_turning ? joined(Vec3::Zero(), direction) : joined(direction, arm.cross(direction));
  };
  const PoseStep on[] = {along(target.arm_a, target.direction), along(target.arm_b, -target.direction)};
  for (const auto& [end, body] : {std::pair(0, target.a), std::pair(1, target.b)}) {
    if (body == kWorld) continue;
    const Inertia& inertia = system_.bodies[body];
    PoseStep by = PoseStep::Zero(), to = PoseStep::Zero();
    if (!inertia.fixed) {
      by = on[end];
      to << inertia.inverse_mass * by.head<3>(), angular_velocity_of(inertia, state.rotation(body), by.tail<3>());
    }
    row.by.push_back({body, by});
    if (!joints_) row.to.push_back({body, to});
    row.scale += by.dot(to);
  }
  if (!joints_) return row;
  const std::vector<int> moved = through_joints_->moved_by(target.a, target.b);
  const std::vector<Vec6>& change = through_joints_->of(moved, target.a, on[0], target.b, on[1]);
  for (const int body : moved) row.to.push_back({body, change[body]});
  return row;
}

// One for each place, zero where it is not used, and everywhere if there is no solution.
Eigen::VectorXd MassWeightedProjection::multipliers(const std::vector<ProjectionTarget>& targets,
                                                    const std::vector<bool>& is_used) {
  const auto count = static_cast<Eigen::Index>(targets.size());
  using Entries = std::vector<std::pair<Eigen::Index, const PoseStep*>>;
  std::vector<Entries> by_body(system_.size()), to_body(system_.size());
  Eigen::VectorXd regularisation = Eigen::VectorXd::Ones(count), amounts = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!is_used[i]) continue;
    amounts[i] = targets[i].amount;
    regularisation[i] = kRegularisation * rows_[i].scale;
    for (const Part& part : rows_[i].by) by_body[part.body].emplace_back(i, &part.of);
    for (const Part& part : rows_[i].to) to_body[part.body].emplace_back(i, &part.of);
  }
  const auto each_entry = [&](const auto& take) {
    for (std::size_t body = 0; body < system_.size(); ++body) {
      for (const auto& [i, by] : by_body[body])
        for (const auto& [j, to] : to_body[body]) take(i, j, by->dot(*to));
    }
  };
  const auto refined = [&](const auto& delassus, const auto& factors) {
    Eigen::VectorXd multiplier = Eigen::VectorXd::Zero(count);
    for (int round = 0; round < kRounds; ++round) multiplier += factors.solve(amounts - delassus * multiplier);
    return multiplier;
  };
  if (!joints_ && count <= kMostDense) {
    Eigen::MatrixXd delassus = Eigen::MatrixXd::Zero(count, count), regularised;
    each_entry([&](Eigen::Index i, Eigen::Index j, double entry) { delassus(i, j) += entry; });
    regularised = delassus;
    regularised.diagonal() += regularisation;
    dense_.factorise(regularised, DenseFactors::Kind::positive_definite);
    const Eigen::VectorXd multiplier = refined(delassus, dense_);
    if (multiplier.allFinite()) return multiplier;
  }
  std::vector<Eigen::Triplet<double>> entries;
  each_entry([&](Eigen::Index i, Eigen::Index j, double entry) { entries.emplace_back(i, j, entry); });
  Eigen::SparseMatrix<double> delassus(count, count), regularised;
  delassus.setFromTriplets(entries.begin(), entries.end());
  regularised = delassus;
  for (Eigen::Index i = 0; i < count; ++i) regularised.coeffRef(i, i) += regularisation[i];
  const SparseFactors factors(regularised);
  if (factors.is_regular()) {
    const Eigen::VectorXd multiplier = refined(delassus, factors);
    if (multiplier.allFinite()) return multiplier;
  }
  solver_warning_ = "no motion of touching bodies closes the gaps between them: its equations are singular";
  return Eigen::VectorXd::Zero(count);
}

const std::vector<PoseStep>& MassWeightedProjection::project(BodyColumns state,
                                                             const std::vector<ProjectionTarget>& targets) {
  rows_.clear();
  if (joints_) {
    joints_->velocity_impulse(state);  // for its factor
    through_joints_->set_pose(state);
  }
  for (const ProjectionTarget& target : targets) rows_.push_back(row_of(state, target));
  std::vector<bool> is_used(targets.size(), true);
  Eigen::VectorXd multiplier;
  for (int choice = 0; choice < kMostActiveSets && !targets.empty(); ++choice) {
    multiplier = multipliers(targets, is_used);
    bool is_pulling = false;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      if (targets[i].bilateral || !(multiplier[i] < 0)) continue;
      is_used[i] = false, is_pulling = true;
    }
    if (!is_pulling) break;
  }
  motion_.assign(system_.size(), PoseStep::Zero());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    for (const Part& part : rows_[i].to) motion_[part.body] += multiplier[i] * part.of;
  }
  return motion_;
}

ProjectionTarget target_of(const ConeConstraint& cone, int axis, double amount, bool bilateral) {
  return {.a = cone.a,
          .b = cone.b,
          .arm_a = cone.arm_a,
          .arm_b = cone.arm_b,
          .direction = cone.frame.col(axis),
          .is_of_turning = cone.is_couple,
          .amount = amount,
          .bilateral = bilateral};
}

}  // namespace rigor::inline dynamics
