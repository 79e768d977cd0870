// What an engine's own scheme does, by the core's word: the run's twin, and what is measured of it.
#pragma once

#include <limits>

#include "adapters/engines.h"
#include "cases/results/results.h"
#include "cases/runner/simulate.h"

namespace rigor {

// The run of the core that repeats this engine's scheme; none for a scheme of the core itself, none where bodies can
// touch, for there a step is more than its published formula, and none where the twin lacks what the scene needs.
std::optional<RunName> twin_of(const EngineTable& engines, const RunName& run, const Scene& scene);

// How much of a twin is wanted.
struct TwinLength {
  std::size_t compared = std::numeric_limits<std::size_t>::max();  // the first samples, those the truth is good at
  bool is_whole = false;  // beyond what can be compared with the run as well: as long as the run itself
};

// The twin is asked for its roundings, and steps, no longer than it can be compared with the run: to where roundings
// have parted it from itself (samples_with_twin), or to where it or one of the turned ones is no longer finite.
TwinRun run_twin(const EngineTable& engines, const RunName& twin, const Scene& scene, const Simulation& run,
                 double duration, TwinLength length = {});

// Measures the twin like a run of its own, to show how much of the run's error its scheme must make. `judged` is
// `run`, with its twin.
SchemeFindings judge_scheme(const EngineTable& engines, const RunName& twin, const JudgedRun& judged,
                            const Simulation& run, double duration);

}  // namespace rigor
