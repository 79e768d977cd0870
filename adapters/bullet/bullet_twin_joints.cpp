#include "adapters/bullet/bullet_twin_joints.h"

#include "adapters/bullet/bullet_matched.h"

namespace rigor::inline adapters {
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

}  // namespace

BulletTwinJoints::BulletTwinJoints(const Scene& scene, const System& system, double erp, std::optional<double> cfm)
    : system_(system), solver_(system, erp, cfm, bullet::softness(scene)) {
  for (const Joint& joint : scene.joints)
    joints_.push_back({make_bullet_rows(scene, joint), moving(scene, joint.a), moving(scene, joint.b)});
}

void BulletTwinJoints::push(MutableBodyColumns state, double dt) {
  for (const JointWithRows& joint : joints_) {
    found_.clear();
    joint.rows->add_to(found_, end_of(system_, state, joint.a), end_of(system_, state, joint.b));
    for (const ConstraintRow& row : found_) solver_.add_row(joint.a, row.on_a, joint.b, row.on_b, -row.gap);
  }
  solver_.push(state, dt);
}

}  // namespace rigor::inline adapters
