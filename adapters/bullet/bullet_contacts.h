// Contact points and forces of Bullet's last step, for its rigid bodies and its multibodies.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <vector>

#include "core/engine/capabilities.h"

namespace rigor::inline adapters::bullet {

// The user index of each collision object is its body of the scene. `dt`: the length of the last step [s].
std::vector<ReportedContact> contacts_of(const btCollisionDispatcher& dispatcher, double dt);

}  // namespace rigor::inline adapters::bullet
