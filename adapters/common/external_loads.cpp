#include "adapters/common/external_loads.h"

#include <fmt/format.h>

#include "core/engine/engine_failure.h"

namespace rigor::inline adapters {

const Wrenches& ExternalLoads::over_step(const World& world, double dt) {
  constexpr double kSameLength = 1 + 1e-9;
  if (dt > shortest_period_ * kSameLength)
    throw EngineFailure(FailureKind::unsupported,
                        fmt::format("a servo samples every {:g} s, and this engine can sample once in a step of {:g} s",
                                    shortest_period_, dt));
  world.read(now_);
  loads_.sample_servos(now_.bodies(), now_.time);
  loads_.evaluate(now_.bodies(), now_.time, dt, wrenches_);
  return wrenches_;
}

}  // namespace rigor::inline adapters
