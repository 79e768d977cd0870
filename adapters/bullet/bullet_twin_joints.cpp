#include "adapters/bullet/bullet_twin_joints.h"

#include "adapters/bullet/bullet_matched.h"

namespace rigor {
namespace {

BulletEnd end_of(const System& system, BodyColumns state, int body) {
  BulletEnd end;
  if (body == kWorld) return end;
  const auto i = static_cast<std::size_t>(body);
  end.position = state.position(i), end.R = state.rotation(i);
  end.inverse_mass = system.bodies[i].inverse_mass;
  return end;
}

int moving(const Scene& scene, int body) {
  return body == kWorld || scene.bodies[static_cast<std::size_t>(body)].fixed ? kWorld : body;
}

Eigen::VectorXd velocities_of(BodyColumns state) {
  Eigen::VectorXd velocities(6 * static_cast<Eigen::Index>(state.size()));
  for (std::size_t i = 0; i < state.size(); ++i)
    velocities.segment<6>(6 * static_cast<Eigen::Index>(i)) << state.velocity(i), state.angular_velocity(i);
  return velocities;
}

}  // namespace

BulletTwinJoints::BulletTwinJoints(const Scene& scene, const System& system, double erp, std::optional<double> cfm)
    : system_(system), erp_(erp), cfm_(cfm), softness_(bullet::softness(scene)) {
  for (const Joint& joint : scene.joints)
    joints_.push_back({make_bullet_rows(scene, joint), moving(scene, joint.a), moving(scene, joint.b)});
}

void BulletTwinJoints::enter(Eigen::Index row, int body, const Vec6& share) {
  if (body == kWorld) return;
  for (int c = 0; c < 6; ++c)
    if (share[c] != 0) of_J_.emplace_back(row, 6 * static_cast<Eigen::Index>(body) + c, share[c]);
}

void BulletTwinJoints::assemble(BodyColumns state) {
  of_J_.clear(), of_inverse_mass_.clear(), gaps_.clear();
  for (const Held& joint : joints_) {
    found_.clear();
    joint.rows->add_to(found_, end_of(system_, state, joint.a), end_of(system_, state, joint.b));
    for (const ConstraintRow& row : found_) {
      const auto index = static_cast<Eigen::Index>(gaps_.size());
      enter(index, joint.a, row.on_a);
      enter(index, joint.b, row.on_b);
      gaps_.push_back(row.gap);
    }
  }
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
  J_.resize(static_cast<Eigen::Index>(gaps_.size()), columns), inverse_mass_.resize(columns, columns);
  J_.setFromTriplets(of_J_.begin(), of_J_.end());
  inverse_mass_.setFromTriplets(of_inverse_mass_.begin(), of_inverse_mass_.end());
}

void BulletTwinJoints::push(MutableBodyColumns state, double dt) {
  assemble(state);
  const auto count = static_cast<Eigen::Index>(gaps_.size());
  Sparse identity(count, count);
  identity.setIdentity();
  const Sparse by_impulse = inverse_mass_ * Sparse(J_.transpose());
  const Sparse system = Sparse(J_ * by_impulse) + (cfm_ ? *cfm_ / dt : softness_) * identity;
  const Eigen::SimplicialLDLT<Sparse> factor(system);
  warning_ = factor.info() == Eigen::Success ? "" : "the joints' equations are singular, and cfm is zero";
  const Eigen::VectorXd target = -erp_ / dt * Eigen::Map<const Eigen::VectorXd>(gaps_.data(), count),
                        right = target - J_ * velocities_of(state);
  Eigen::VectorXd impulses = factor.solve(right);
  impulses += factor.solve(right - system * impulses);  // once refined: rows that repeat others are nearly singular
  const Eigen::VectorXd change = by_impulse * impulses;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto of_body = change.segment<6>(6 * static_cast<Eigen::Index>(i));
    state.set_velocity(i, state.velocity(i) + Vec3(of_body.head<3>()));
    state.set_angular_velocity(i, state.angular_velocity(i) + Vec3(of_body.tail<3>()));
  }
}

}  // namespace rigor
