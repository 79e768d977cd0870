// The result of one run of an engine on a scene: its trajectory, and how it ended.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/engine/capabilities.h"
#include "core/engine/engine.h"
#include "core/engine/trajectory.h"

namespace rigor::inline engine {

struct NotFinite {
  double time;  // s, of the first sample with a number that is not finite
  int body;
};

struct Simulation {
  Trajectory trajectory;  // finite samples only, t = 0 first
  SettingsInForce settings;
  std::optional<NotFinite> not_finite;
  std::string solver_warning;      // the first one of the world, with its time; empty if none
  double solver_warning_time = 0;  // s
  std::optional<ReducedOrder> reduced_order;
  std::optional<double> sub_step;  // s, see MayDivideSteps
  double cpu_seconds = 0;          // of the steps alone, without recording; not a number if nobody timed them
  long steps_per_sample = 1;
};

// Steps that fit into the duration, one that ends within rounding (1e-9 of a step) of it included.
inline long steps_in(double duration, double dt) {
  constexpr double kRounding = 1e-9, kMost = 9e18;
  return static_cast<long>(std::min(std::floor(duration / dt + kRounding), kMost));
}

}  // namespace rigor::inline engine
