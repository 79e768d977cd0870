// The changes that should not matter to a run, and those that may. Each is a row: it repeats the run under the change
// and gives the states of the original's bodies, in their order.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cases/analysis/repeats/recorded_states.h"
#include "core/engine/run_name.h"

namespace rigor::inline analysis {

// A run that is repeated.
struct RepeatedRun {
  const Engine& engine;
  const EngineInfo& info;
  const RunName& name;
  const Scene& scene;
  double dt = 0;  // s
  long steps = 0;
  bool saves_state = false;  // its worlds can be saved and restored
};

// The run under one change. `due` computes what it is compared with, if that is not the run itself.
struct ChangedRun {
  std::string label;  // "threads 4", "seed 1"; or ""
  std::function<RecordedStates()> found;
  std::function<RecordedStates()> due = {};
  std::string why_not = {};  // why it cannot run here, if `found` is empty
};

struct RepeatChange {
  std::string name, summary;
  bool must_hold = true;  // otherwise a difference is the effect of a solver that depends on order
  // The runs under the change. Empty if it does not apply, with the reason. It loads no world: each run has a process
  // of its own, and what an engine starts in this one would be in all of them.
  std::vector<ChangedRun> (*runs)(const RepeatedRun& run, std::string& why_not);
  bool enlarges = false;  // the scene; an engine that refuses it is not broken
};

const std::vector<RepeatChange>& repeat_changes();

}  // namespace rigor::inline analysis
