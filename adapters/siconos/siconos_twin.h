// The smooth step of Siconos 4.4, Moreau and Jean's theta method, as a method of the core.
#pragma once

#include "core/dynamics/integrators/integrator.h"

namespace rigor::inline adapters {

extern const Integrator kSiconosTwin;

}  // namespace rigor::inline adapters
