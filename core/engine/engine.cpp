#include "core/engine/engine.h"

#include <fmt/format.h>

namespace rigor {

std::string why_unsupported(const EngineInfo& engine, const Scene& scene, double dt) {
  for (const Need& need : needs_of(scene)) {
    if (!engine.features.contains(need.feature)) {
      return fmt::format("{} has no {}, which {} asks for", engine.name, need.feature, need.because);
    }
  }
  for (const Body& body : scene.bodies) {
    const double angle = body.angular_velocity.norm() * dt;
    if (angle > engine.max_rotation_per_step) {
      return fmt::format("{} turns a body by at most {:.3g} rad in one step; '{}' turns by {:.3g} rad", engine.name,
                         engine.max_rotation_per_step, body.name, angle);
    }
  }
  return "";
}

}  // namespace rigor
