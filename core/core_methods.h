// Worlds of the core for any row of integrators. Its adapter adds rows that replicate the schemes of other engines
// (twins).
#pragma once

#include <memory>
#include <vector>

#include "core/dynamics/integrators/integrator.h"
#include "core/engine/engine.h"

namespace rigor {

// Facts about the core with these methods. The default method comes first, twins last.
EngineInfo core_info_of(const std::vector<Integrator>& methods);

// The method must support the scene, see why_unsupported().
std::unique_ptr<World> make_core_world(const Scene& scene, const Integrator& method, const Settings& settings);

}  // namespace rigor
