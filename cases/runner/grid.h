// The grid: cases × engines × step sizes, known whole before anything runs, so that a cell that did not run is missed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/results/result_json.h"
#include "cases/results/results.h"
#include "cases/runner/executor.h"
#include "cases/runner/recorder.h"

namespace rigor::inline runner {

// Changes of the cases by the command line.
struct Overrides {
  std::vector<StepSize> dt;        // empty: each case's own
  std::optional<double> duration;  // s
};

// Throws InputError for a step longer than the run, or so short that the run would never end.
void override_run(Case& definition, const Overrides& overrides);

struct GridOptions {
  int jobs = 1;                        // children at once
  double limit = 120;                  // s of CPU time, for each cell, each stable step and each truth
  Recorders recorders;                 // of every run
  bool stable_steps = true;            // find the largest stable dt as well
  bool is_thorough = true;             // times each run and repeats it by its twin, also where no gate asks for it
  std::string journals = {};           // folder of the journals of cases (journal.h); empty: no journals
  const Executor* executor = nullptr;  // of the cases; null: processes of this machine
  int share = 0;                       // of the cases, that this process does (shards/shard.h); 0: all
  std::vector<std::string> only_metrics = {};  // measure these, costly or not, and no others; empty: all as above
  bool spreads = true;                         // of every two runs at a step, for which the path of each is kept
  std::function<void(std::size_t of_case, const MessageSubject& part)> on_part = {};  // after each message
};

// Which of all cells are in the grid.
struct Scope {
  bool stable_steps = true;  // the largest stable dt of each case and run as well
  bool only_judged = false;  // only cells that a gate judges; of a case without gates, all
};

// The runs that gates of these cases name and that are not among `but`. An example is an option of a method that only
// one case tests.
std::vector<RunName> runs_of_gates(const std::vector<Case>& cases, const std::vector<RunName>& but,
                                   const std::vector<EngineInfo>& engines);

// All cells, not yet run; cells that an engine cannot run are `unsupported`. `runs` apply to every case,
// `only_where_named` to cases whose gates name them. Throws InputError if there are no cells.
Results plan_grid(const std::vector<Case>& cases, const std::vector<RunName>& runs, const EngineTable& engines,
                  const Scope& scope, const std::vector<RunName>& only_where_named = {});

// Runs the grid and fills it in. One child process per case makes the truth and forks the case's cells, which inherit
// it. A truth that hangs, throws or crashes thus costs one case. Cases run side by side on all jobs, the long ones
// first. If there are fewer cases, they share the jobs. An executor gets shares of cases, so that no long case ends
// last. Each share makes the truth again, or takes it from the cache. `on_progress` is called when cells end.
void run_grid(Results& grid, const EngineTable& engines, const GridOptions& options,
              const std::function<void(std::size_t done, std::size_t all)>& on_progress);

}  // namespace rigor::inline runner
