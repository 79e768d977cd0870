// The scene's own units of length and time. The method `event` and the limits of joints state each threshold in these
// units, so that a change of units changes nothing but rounding. Scales are homogeneous: a scene that is scaled by
// powers of two has scales that are scaled by exactly these powers.
//   length   the largest bounding radius, or radius of gyration, of a body that moves
//   time     the inverse of the fastest rate: of gravity, sqrt(g/length), of the initial motion, of springs, joint
//            springs, forces and motors
#pragma once

#include "core/scene/scene.h"

namespace rigor::inline dynamics {

struct ContactScales {
  double length = 1;  // m
  double time = 1;    // s
  double factor = 1;  // multiplies each threshold that decides

  // Units of thresholds that tell roundings: of gaps [m], or of a hinge's angle at its limit [rad], and their rates.
  double gap_unit(bool is_angle = false) const { return is_angle ? 1 : length; }
  double speed_unit(bool is_angle = false) const { return gap_unit(is_angle) / time; }
  double acceleration_unit() const { return speed_unit() / time; }
  // The same, of thresholds that decide what touches, slides and rebounds.
  double gap(bool is_angle = false) const { return factor * gap_unit(is_angle); }
  double speed(bool is_angle = false) const { return factor * speed_unit(is_angle); }
};

ContactScales contact_scales(const Scene& scene, double factor = 1);

}  // namespace rigor::inline dynamics
