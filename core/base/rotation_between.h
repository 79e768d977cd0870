// The shortest rotation that takes one direction to another. (Eigen's own brings a singular value decomposition into
// every file that asks for it.)
#pragma once

#include "core/base/math.h"

namespace rigor {

// Accepts directions of any length. For opposite directions the axis is any normal to them.
Quat rotation_between(const Vec3& from, const Vec3& to);

}  // namespace rigor
