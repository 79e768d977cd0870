// Offsets of the columns of motion: position [m], orientation (w, x, y, z), velocity [m/s], angular velocity [rad/s].
// An engine with matrix orientations adds nine elements, row by row.
#pragma once

namespace rigor::inline engine {

enum Column { kPosition = 0, kOrientation = 3, kVelocity = 7, kAngularVelocity = 10, kRotation = 13 };

}  // namespace rigor::inline engine
