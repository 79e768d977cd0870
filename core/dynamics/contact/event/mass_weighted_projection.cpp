#include "core/dynamics/contact/event/mass_weighted_projection.h"

#include <Eigen/SparseCholesky>

namespace rigor {
namespace {

// Points may be more than the motion can tell apart: of a point's own give this much is added, and rounds take it out
// again of all that can be told apart.
constexpr double kLittle = 1e-6;
constexpr int kRounds = 4;
constexpr int kMostChoices = 10;  // of the points that push

}  // namespace

LeastMotion::Side LeastMotion::side_of(BodyColumns state, int body, const Vec3& arm, const Vec3& direction) const {
  Side side{body, PoseStep::Zero(), PoseStep::Zero()};
  if (system_.bodies[body].fixed) return side;
  const Vec3 turn = arm.cross(direction);
  side.by << direction, turn;
  side.to << system_.bodies[body].inverse_mass * direction,
      angular_velocity_of(system_.bodies[body], state.rotation(body), turn);
  return side;
}

// One for each place, zero where it is not used, and everywhere if there is no solution.
Eigen::VectorXd LeastMotion::pushes(const std::vector<Demand>& demands, const std::vector<bool>& is_used) {
  const auto count = static_cast<Eigen::Index>(demands.size());
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<std::vector<std::pair<Eigen::Index, const Side*>>> of_body(system_.size());
  Eigen::VectorXd little = Eigen::VectorXd::Ones(count), amounts = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!is_used[i]) continue;
    amounts[i] = demands[i].amount;
    little[i] = kLittle * (sides_[i][0].by.dot(sides_[i][0].to) + sides_[i][1].by.dot(sides_[i][1].to));
    for (const Side& side : sides_[i]) of_body[side.body].emplace_back(i, &side);
  }
  for (const auto& sides : of_body) {
    for (const auto& [i, of] : sides)
      for (const auto& [j, by] : sides) entries.emplace_back(i, j, of->by.dot(by->to));
  }
  Eigen::SparseMatrix<double> give(count, count), softened;
  give.setFromTriplets(entries.begin(), entries.end());
  softened = give;
  for (Eigen::Index i = 0; i < count; ++i) softened.coeffRef(i, i) += little[i];
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(softened);
  Eigen::VectorXd push = Eigen::VectorXd::Zero(count);
  if (solver.info() == Eigen::Success) {
    for (int round = 0; round < kRounds; ++round) push += solver.solve(amounts - give * push);
  }
  if (solver.info() == Eigen::Success && push.allFinite()) return push;
  solver_warning_ = "no motion of touching bodies closes the gaps between them: its equations are singular";
  return Eigen::VectorXd::Zero(count);
}

const std::vector<PoseStep>& LeastMotion::meet(BodyColumns state, const std::vector<Demand>& demands) {
  sides_.clear();
  for (const Demand& demand : demands) {
    sides_.push_back({side_of(state, demand.a, demand.arm_a, demand.direction),
                      side_of(state, demand.b, demand.arm_b, -demand.direction)});
  }
  std::vector<bool> is_used(demands.size(), true);
  Eigen::VectorXd push;
  for (int choice = 0; choice < kMostChoices && !demands.empty(); ++choice) {
    push = pushes(demands, is_used);
    bool is_pulling = false;
    for (std::size_t i = 0; i < demands.size(); ++i) {
      if (demands[i].both_ways || !(push[i] < 0)) continue;
      is_used[i] = false, is_pulling = true;
    }
    if (!is_pulling) break;
  }
  motion_.assign(system_.size(), PoseStep::Zero());
  for (std::size_t i = 0; i < demands.size(); ++i) {
    for (const Side& side : sides_[i]) motion_[side.body] += push[i] * side.to;
  }
  return motion_;
}

}  // namespace rigor
