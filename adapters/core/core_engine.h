// The in-house core behind the same seam as every other engine.
#pragma once

#include <memory>

#include "core/engine/engine.h"

namespace rigor {

class CoreEngine : public Engine {
 public:
  EngineInfo info() const override;
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;
  std::string twin(const Settings&) const override { return ""; }
};

}  // namespace rigor
