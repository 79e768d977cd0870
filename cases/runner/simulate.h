// One run of one engine on one scene: steps it, records it, stops where it is no longer finite.
#pragma once

#include <optional>

#include "core/engine/simulation.h"

namespace rigor::inline runner {

// Every step is recorded, or every n-th if all of them would exceed this.
inline constexpr double kLargestTrajectory = 512e6;  // bytes

struct RecordingOptions {
  std::optional<long> steps_per_sample = {};  // in place of the limit above
  bool is_timed = true;
  // Joint loads that the engine reports are recorded of the second step, and of each n-th step after it; 0: of none.
  long reactions_every = 0;
  bool has_contacts = false;  // whether the contacts that the engine reports are recorded, with each sample
};
Simulation simulate(const Engine& engine, const Settings& settings, const Scene& scene, double dt, double duration,
                    const RecordingOptions& options = {});

// The first body with a number that is not finite.
std::optional<int> body_not_finite(BodyColumns bodies);

// Throws EngineFailure (invalid) if a run's first sample is not the scene's state at t = 0, for example with bodies in
// another order. This check is for runs without a truth, whose conservation metrics start from that sample.
void check_start(const Simulation& run, const Scene& scene);

// CPU seconds of the run's steps, to compare engines. If steps take a few microseconds, reading the clock around each
// is a large part of them. A short run is therefore repeated without interruption for some milliseconds, and the
// quickest repeat counts, because other load only adds time. For a longer run the first milliseconds are repeated in
// both ways, and each step is corrected by the difference.
double timed_again(const Engine& engine, const Settings& settings, const Scene& scene, const Simulation& run);

}  // namespace rigor::inline runner
