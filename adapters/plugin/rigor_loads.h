// Springs, dampers and timed forces for an engine from outside that accepts wrenches: rows of force [N] and torque
// about the centre of mass [N m], both in W, one per body in the scene's order.
#pragma once

#include <vector>

#include "adapters/common/external_loads.h"
#include "adapters/plugin/plugin_info.h"

namespace rigor::inline adapters {

class RigorLoads {
 public:
  RigorLoads(const Scene& scene, const PluginInfo& info) : loads_(loads_left_to_rigor(scene, info)) {}

  bool empty() const { return loads_.empty(); }
  // fx fy fz tx ty tz of each body over the step of dt that begins now; valid until the next call. False if one of them
  // is not finite.
  bool over_step(const World& world, double dt);
  const std::vector<double>& rows() const { return rows_; }

 private:
  ExternalLoads loads_;
  std::vector<double> rows_;
};

}  // namespace rigor::inline adapters
