// The angle of b relative to a about an axis, within half a turn, from two directions across the axis. Its sine and
// cosine are means over both directions. So it does not matter which two they are, even where the stages of an
// integrator leave the axes of both bodies slightly apart.
#pragma once

#include "core/base/math.h"
#include "core/base/portable.h"

namespace rigor::inline dynamics {

struct HingeAngle {
  Vec3 across_a;           // unit, across the axis, in a's frame
  Vec3 first_b, second_b;  // in b's frame: the same direction at t = 0, and the axis times it

  // rad. The axis is unit and in W; the rotations take the bodies' frames to W.
  double at(const Vec3& axis, const Mat3& a, const Mat3& b) const {
    const Vec3 first = a * across_a, second = axis.cross(first), to_first = b * first_b, to_second = b * second_b;
    return portable::atan2(second.dot(to_first) - first.dot(to_second), first.dot(to_first) + second.dot(to_second));
  }
};

}  // namespace rigor::inline dynamics
