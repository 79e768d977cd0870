// Bullet's own smooth step as a method of the core, see bullet_twin.cpp.
#pragma once

#include "core/dynamics/integrators/integrator.h"

namespace rigor::inline adapters {

extern const Integrator kBulletTwin;

}  // namespace rigor::inline adapters
