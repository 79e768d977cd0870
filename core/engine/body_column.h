// Where the columns of bodies' motion begin: position [m], orientation (w, x, y, z), velocity [m/s], angular velocity
// [rad/s], and for engines whose own orientation is a matrix its nine elements, row by row.
#pragma once

namespace rigor {

enum Column { kPosition = 0, kOrientation = 3, kVelocity = 7, kAngularVelocity = 10, kRotation = 13 };

}  // namespace rigor
