// Motions to compare: runs of engines, faulty ones among them, several at once in child processes, so that one that
// crashes costs itself.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "adapters/faults/fault.h"

namespace rigor {

// Of each body: position, rotation matrix row by row (of a quaternion of any length, see matrix_of), velocity, angular
// velocity. A matrix has no sign to choose.
inline constexpr std::size_t kMotionColumns = 18;

struct MotionTask {
  const Engine* engine;
  Settings settings;
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Fault> fault;  // that the engine is broken by; null: none
  double dt;                           // s
  long steps, every;                   // each `every`-th is kept, t = 0 first
};

struct StateSeries {
  std::vector<double> states;  // sample by sample, body by body; ends where the run blows up
  std::string why;             // it did not come about; empty if it did
};

// One a task. `limit`: s of CPU time for a run.
std::vector<StateSeries> simulate_motions(const std::vector<MotionTask>& tasks, const EngineTable& engines, int at_once,
                                          double limit);

}  // namespace rigor
