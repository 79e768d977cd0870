// The shortest rotation that takes one direction to another. (Eigen's own brings a singular value decomposition into
// every file that asks for it.)
#pragma once

#include "core/base/math.h"

namespace rigor {

// Of directions of any length. Between opposite ones the axis is any that is normal to them.
Quat rotation_between(const Vec3& from, const Vec3& to);

}  // namespace rigor
