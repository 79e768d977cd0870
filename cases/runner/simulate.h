// One run of one engine on one scene: steps it, records it, stops where it is no longer finite.
#pragma once

#include <optional>

#include "core/engine/simulation.h"

namespace rigor {

// Every step is recorded, or every n-th where the whole would pass kLargestTrajectory bytes; or as told.
inline constexpr double kLargestTrajectory = 512e6;
Simulation simulate(const Engine& engine, const Settings& settings, const Scene& scene, double dt, double duration,
                    std::optional<long> steps_per_sample = {}, bool is_timed = true);

// The first body with a number that is not finite.
std::optional<int> body_not_finite(BodyColumns bodies);

// Throws EngineFailure, invalid, where a run's first sample is not the scene's state at t = 0, as of bodies in another
// order. For runs without a truth: what such a one keeps it keeps from wherever it began.
void check_start(const Simulation& run, const Scene& scene);

// CPU seconds of the run's steps, for comparing engines. Steps of a few microseconds are run again without a pause,
// from the start and as many as the run had, and the quickest of the repeats counts: reading the clock before and after
// each would be a good part of them, and whatever else the machine does only ever adds. A run of more than a second is
// not.
double timed_again(const Engine& engine, const Settings& settings, const Scene& scene, const Simulation& run);

}  // namespace rigor
