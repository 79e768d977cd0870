// Springs and timed forces for an engine that has none. Before each step they are computed by the core's own law from
// the engine's current state, and passed as constant forces for that step.
#pragma once

#include "core/dynamics/model/loads/loads.h"
#include "core/engine/engine.h"

namespace rigor::inline adapters {

class ExternalLoads {
 public:
  explicit ExternalLoads(const Scene& scene) : loads_(scene), shortest_period_(loads_.shortest_period()) {}

  bool empty() const { return loads_.empty(); }
  // Throws EngineFailure where a servo would have to sample within the step.
  // Force and torque about the centre of mass, in W, on each body over the step of dt that begins now. Valid until the
  // next call.
  const Wrenches& over_step(const World& world, double dt);

  // Of servos.
  template <typename Archive>
  void archive_state(Archive& archive) {
    archive(loads_);
  }

 private:
  Loads loads_;
  double shortest_period_;  // s, of servos
  Snapshot now_;
  Wrenches wrenches_;
};

}  // namespace rigor::inline adapters
