// The fixed steps of Simbody's integrators as methods of the core, see simbody_twin.cpp.
#pragma once

#include <vector>

#include "core/dynamics/integrators/integrator.h"

namespace rigor::inline adapters {

std::vector<Integrator> simbody_twins();

}  // namespace rigor::inline adapters
