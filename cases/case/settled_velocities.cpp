#include "cases/case/settled_velocities.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/dynamics/joints/joints.h"
#include "core/scene/joint_rates.h"

namespace rigor::inline cases {

void settle_velocities(Scene& scene) {
  const auto breaks = [&](const auto& row) { return !why_rates_break(scene, row).empty(); };
  if (std::none_of(scene.joints.begin(), scene.joints.end(), breaks) &&
      std::none_of(scene.couplings.begin(), scene.couplings.end(), breaks))
    return;
  BodyTable state(scene.bodies.size());
  set_initial_state(scene, state.columns());
  Scene at_rest = scene;  // velocities that break joints would only disturb
  for (Body& body : at_rest.bodies) body.velocity = body.angular_velocity = Vec3::Zero();
  const System system(at_rest);
  Joints joints(at_rest, system);
  joints.project(state.columns());
  if (const std::string why = joints.warning(); !why.empty()) throw InputError(why);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].fixed) continue;
    scene.bodies[i].velocity = state.columns().velocity(i);
    scene.bodies[i].angular_velocity = state.columns().angular_velocity(i);
  }
}

}  // namespace rigor::inline cases
