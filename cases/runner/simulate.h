// One run of one engine on one scene: steps it, records it, stops where it is no longer finite.
#pragma once

#include <optional>

#include "core/engine/simulation.h"

namespace rigor {

// What the engine says that joints carry is recorded of the second step and each `reactions_every`-th from there on.
// Every step is recorded, or every n-th where the whole would pass kLargestTrajectory bytes; or as told.
inline constexpr double kLargestTrajectory = 512e6;
Simulation simulate(const Engine& engine, const Settings& settings, const Scene& scene, double dt, double duration,
                    std::optional<long> steps_per_sample = {}, bool is_timed = true, long reactions_every = 0);

// The first body with a number that is not finite.
std::optional<int> body_not_finite(BodyColumns bodies);

// Throws EngineFailure, invalid, where a run's first sample is not the scene's state at t = 0, as of bodies in another
// order. For runs without a truth: what such a one keeps it keeps from wherever it began.
void check_start(const Simulation& run, const Scene& scene);

// CPU seconds of the run's steps, for comparing engines. Where they take a few microseconds, reading the clock before
// and after each is a good part of them, beyond what it costs by itself. A short run is run again without a pause, some
// milliseconds in all, and the quickest repeat counts: whatever else the machine does only ever adds. Of a longer one
// the first milliseconds are run again in both ways, and by what they differ each of its steps is corrected.
double timed_again(const Engine& engine, const Settings& settings, const Scene& scene, const Simulation& run);

}  // namespace rigor
