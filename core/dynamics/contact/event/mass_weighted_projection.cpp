#include "core/dynamics/contact/event/mass_weighted_projection.h"

#include <Eigen/SparseCholesky>

namespace rigor {
namespace {

// Redundant points make the Delassus matrix singular: this much of its diagonal is added, and rounds of iterative
// refinement take the error out again of all that is not redundant.
constexpr double kRegularisation = 1e-6;
constexpr int kRounds = 4;
constexpr int kMostActiveSets = 10;  // of unilateral targets

}  // namespace

MassWeightedProjection::Side MassWeightedProjection::side_of(BodyColumns state, int body, const Vec3& arm,
                                                             const Vec3& direction) const {
  Side side{body, PoseStep::Zero(), PoseStep::Zero()};
  if (system_.bodies[body].fixed) return side;
  const Vec3 turn = arm.cross(direction);
  side.by << direction, turn;
  side.to << system_.bodies[body].inverse_mass * direction,
      angular_velocity_of(system_.bodies[body], state.rotation(body), turn);
  return side;
}

// One for each place, zero where it is not used, and everywhere if there is no solution.
Eigen::VectorXd MassWeightedProjection::multipliers(const std::vector<ProjectionTarget>& targets,
                                                    const std::vector<bool>& is_used) {
  const auto count = static_cast<Eigen::Index>(targets.size());
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<std::vector<std::pair<Eigen::Index, const Side*>>> of_body(system_.size());
  Eigen::VectorXd regularisation = Eigen::VectorXd::Ones(count), amounts = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!is_used[i]) continue;
    amounts[i] = targets[i].amount;
    regularisation[i] = kRegularisation * (sides_[i][0].by.dot(sides_[i][0].to) + sides_[i][1].by.dot(sides_[i][1].to));
    for (const Side& side : sides_[i]) of_body[side.body].emplace_back(i, &side);
  }
  for (const auto& sides : of_body) {
    for (const auto& [i, of] : sides)
      for (const auto& [j, by] : sides) entries.emplace_back(i, j, of->by.dot(by->to));
  }
  Eigen::SparseMatrix<double> delassus(count, count), regularised;
  delassus.setFromTriplets(entries.begin(), entries.end());
  regularised = delassus;
  for (Eigen::Index i = 0; i < count; ++i) regularised.coeffRef(i, i) += regularisation[i];
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(regularised);
  Eigen::VectorXd multiplier = Eigen::VectorXd::Zero(count);
  if (solver.info() == Eigen::Success) {
    for (int round = 0; round < kRounds; ++round) multiplier += solver.solve(amounts - delassus * multiplier);
  }
  if (solver.info() == Eigen::Success && multiplier.allFinite()) return multiplier;
  solver_warning_ = "no motion of touching bodies closes the gaps between them: its equations are singular";
  return Eigen::VectorXd::Zero(count);
}

const std::vector<PoseStep>& MassWeightedProjection::project(BodyColumns state,
                                                             const std::vector<ProjectionTarget>& targets) {
  sides_.clear();
  for (const ProjectionTarget& target : targets) {
    sides_.push_back({side_of(state, target.a, target.arm_a, target.direction),
                      side_of(state, target.b, target.arm_b, -target.direction)});
  }
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
    for (const Side& side : sides_[i]) motion_[side.body] += multiplier[i] * side.to;
  }
  return motion_;
}

}  // namespace rigor
