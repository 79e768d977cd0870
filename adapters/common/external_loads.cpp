#include "adapters/common/external_loads.h"

namespace rigor {

const Wrenches& ExternalLoads::over_step(const World& world, double dt) {
  world.read(now_);
  loads_.evaluate(now_.bodies(), now_.time, dt, wrenches_);
  return wrenches_;
}

}  // namespace rigor
