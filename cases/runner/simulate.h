// One run of one engine on one scene: steps it, records it, stops where it is no longer finite.
#pragma once

#include <optional>
#include <string>

#include "core/engine/engine.h"
#include "core/engine/trajectory.h"

namespace rigor {

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
  double cpu_seconds = 0;          // of the steps alone, without recording; not a number if nobody timed them
  long steps_per_sample = 1;
};

// Steps that fit into the duration, one that ends within rounding (1e-9 of a step) of it included.
long steps_in(double duration, double dt);

// Every step is recorded, or every n-th where the whole would pass kLargestTrajectory bytes; or as told.
inline constexpr double kLargestTrajectory = 512e6;
Simulation simulate(const Engine& engine, const Settings& settings, const Scene& scene, double dt, double duration,
                    std::optional<long> steps_per_sample = {}, bool is_timed = true);

// CPU seconds of the run's steps, for comparing engines. Steps of a few microseconds are run again without a pause,
// from the start and as many as the run had, and the quickest of the repeats counts: reading the clock before and after
// each would be a good part of them, and whatever else the machine does only ever adds.
double timed_again(const Engine& engine, const Settings& settings, const Scene& scene, const Simulation& run);

}  // namespace rigor
