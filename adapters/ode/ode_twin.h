// ODE's own smooth step as a method of the core, see ode_twin.cpp.
#pragma once

#include "core/dynamics/integrators/integrator.h"

namespace rigor::inline adapters {

extern const Integrator kOdeTwin;

}  // namespace rigor::inline adapters
