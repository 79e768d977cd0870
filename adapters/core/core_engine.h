// The in-house core (core/world.h) behind the same seam as every other engine.
#pragma once

#include <memory>
#include <vector>

#include "core/dynamics/integrators/integrator.h"
#include "core/engine/engine.h"

namespace rigor::inline adapters {

class CoreEngine : public Engine {
 public:
  // `twins`: further methods, which replicate the schemes of other engines.
  explicit CoreEngine(std::vector<Integrator> twins = {});
  EngineInfo info() const override { return info_; }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;
  std::string twin(const Settings&) const override { return ""; }

 private:
  std::vector<Integrator> integrators_;
  EngineInfo info_;  // made once: worlds are loaded by the thousand
};

}  // namespace rigor::inline adapters
