#include "adapters/plugin/rigor_loads.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline adapters {

bool RigorLoads::over_step(const World& world, double dt) {
  rows_.clear();
  for (const Wrench& wrench : loads_.over_step(world, dt)) {
    rows_.insert(rows_.end(), wrench.force.begin(), wrench.force.end());
    rows_.insert(rows_.end(), wrench.torque.begin(), wrench.torque.end());
  }
  return std::all_of(rows_.begin(), rows_.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace rigor::inline adapters
