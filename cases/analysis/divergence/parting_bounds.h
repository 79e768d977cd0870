// The bounds within which two runs count as one motion: "1mm", "position=1mm", "velocity=2cm/s".
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline analysis {

// Infinite where a quantity is not looked at.
struct PartingBounds {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double position = kNone;          // m
  double orientation = kNone;       // rad
  double velocity = kNone;          // m/s
  double angular_velocity = kNone;  // rad/s
  double size = 0;                  // m, of the scene if the bounds follow from it; 0 if they were given
};

// m: the largest of the shapes, of the distances between moving bodies, and of the arms of joints and springs. Of a
// single body without any of them its radius of gyration.
double scene_size(const Scene& scene);

// 1 mm for each metre of the scene's size, and 1 mrad.
PartingBounds default_parting_bounds(const Scene& scene);

// Throws InputError for a text that is no bound, for one without a unit, and for two of one quantity.
PartingBounds parse_parting_bounds(const std::vector<std::string>& texts);

}  // namespace rigor::inline analysis
