// The error of an engine's own scheme, from the core's replica: the run's twin and its measurements.
#pragma once

#include <limits>

#include "adapters/engines.h"
#include "cases/results/results.h"
#include "cases/runner/simulate.h"

namespace rigor::inline runner {

// The run of the core that repeats this engine's scheme. There is none for the core's own schemes. There is none where
// bodies can touch, because a step then exceeds its published formula, nor if the twin lacks a feature of the scene.
std::optional<RunName> twin_of(const EngineTable& engines, const RunName& run, const Scene& scene);

// How much of a twin is wanted.
struct TwinLength {
  std::size_t compared = std::numeric_limits<std::size_t>::max();  // the first samples, those the truth is good at
  bool is_whole = false;  // also beyond the comparable part: as long as the run itself
};

// The twin is stepped, and its rounding error found, only while it is comparable with the run. This ends where rounding
// has separated it from itself (samples_with_twin), or where it or a rotated run is no longer finite.
TwinRun run_twin(const EngineTable& engines, const RunName& twin, const Scene& scene, const Simulation& run,
                 double duration, TwinLength length = {});

// Measures the twin like a run, to show how much of the run's error its scheme makes. `judged` is `run`, with its twin.
SchemeFindings judge_scheme(const EngineTable& engines, const RunName& twin, const JudgedRun& judged,
                            const Simulation& run, double duration);

}  // namespace rigor::inline runner
