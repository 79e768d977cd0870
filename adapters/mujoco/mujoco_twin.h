// MuJoCo's own smooth steps as methods of the core, see mujoco_twin.cpp.
#pragma once

#include "core/dynamics/integrators/integrator.h"

namespace rigor::inline adapters {

extern const Integrator kMujocoEulerTwin, kMujocoImplicitTwin, kMujocoRk4Twin;

}  // namespace rigor::inline adapters
