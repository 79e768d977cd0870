// The smooth step of DART 6.12 as a method of the core: semi-implicit Euler in the coordinates of joints and of free
// bodies, see adapters/common/reduced_twin.h.
#pragma once

#include "core/dynamics/integrators/integrator.h"

namespace rigor::inline adapters {

extern const Integrator kDartTwin;

}  // namespace rigor::inline adapters
