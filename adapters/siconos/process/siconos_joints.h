// Joints as Siconos's own relations, held at the velocities of each step's end.
#pragma once

#include <Interaction.hpp>
#include <NonSmoothDynamicalSystem.hpp>

#include "adapters/siconos/process/siconos_bodies.h"

namespace rigor::inline adapters::siconos {

// Links each joint of the scene, as it was at t = 0, into the system.
void link_joints(const Scene& scene, const Bodies& bodies, NonSmoothDynamicalSystem& into);

}  // namespace rigor::inline adapters::siconos
