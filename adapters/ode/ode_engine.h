// The Open Dynamics Engine, double precision. A semi-implicit step: velocities first, then positions with the new
// velocities. Contacts are a linear complementarity problem, solved directly (worldstep) or by SOR sweeps (quickstep).
#pragma once

#include "core/engine/engine.h"

namespace rigor::inline adapters {

class OdeEngine : public Engine {
 public:
  EngineInfo info() const override;
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;
  std::string twin(const Settings& settings) const override;
};

}  // namespace rigor::inline adapters
