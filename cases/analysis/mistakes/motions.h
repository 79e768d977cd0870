// Computes motions to compare: runs of engines with and without faults. Several run at once in child processes, so a
// crash costs one motion.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "adapters/faults/fault.h"

namespace rigor::inline analysis {

// The columns of each body: position, rotation matrix by rows, velocity, angular velocity. A matrix, unlike a
// quaternion, has no sign to choose.
inline constexpr std::size_t kMotionColumns = 18;

struct MotionTask {
  const Engine* engine;
  Settings settings;
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Fault> fault;  // the engine is broken by it; null: by none
  double dt;                           // s
  long steps, every;                   // each `every`-th step is kept, after the state at t = 0
};

struct StateSeries {
  std::vector<double> states;  // sample by sample, body by body; ends where the run blows up
  std::string why;             // the reason if the motion could not be computed; else empty
};

// One a task. `limit`: s of CPU time for a run. `on_motion` is called after each.
std::vector<StateSeries> simulate_motions(const std::vector<MotionTask>& tasks, const EngineTable& engines, int at_once,
                                          double limit, const std::function<void()>& on_motion = {});

}  // namespace rigor::inline analysis
