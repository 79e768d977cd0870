#pragma once

#include "core/base/math.h"

namespace rigor {

class TomlValue;

// A quaternion [w, x, y, z] of any length but 0, made a unit one.
Quat read_orientation(const TomlValue& value);

}  // namespace rigor
