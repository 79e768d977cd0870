// The smooth step of Bullet's btMultiBody as a method of the core, see bullet_multibody_twin.cpp.
#pragma once

#include "core/dynamics/integrators/integrator.h"

namespace rigor::inline adapters {

extern const Integrator kBulletMultibodyTwin;

}  // namespace rigor::inline adapters
