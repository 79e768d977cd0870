#include "adapters/core/core_engine.h"

#include <algorithm>
#include <cassert>

#include "adapters/common/option_values.h"
#include "core/core_methods.h"

namespace rigor::inline adapters {

CoreEngine::CoreEngine(std::vector<Integrator> twins) : integrators_(integrators()) {
  integrators_.insert(integrators_.end(), twins.begin(), twins.end());
  info_ = core_info_of(integrators_);
}

std::unique_ptr<World> CoreEngine::load(const Scene& scene, const Settings& settings) const {
  refuse_unsupported(info_, settings, scene);
  const auto row = std::find_if(integrators_.begin(), integrators_.end(),
                                [&](const Integrator& own) { return own.name == settings.method; });
  assert(row != integrators_.end() && "methods are checked when the run is named");
  return make_core_world(scene, *row, settings);
}

}  // namespace rigor::inline adapters
