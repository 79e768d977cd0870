// Whether a run gives the same bits under each change that should not matter.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/repeats/changes.h"
#include "cases/case/case.h"

namespace rigor::inline analysis {

struct RepeatOutcome {
  std::string change, label;
  bool must_hold = true;
  bool is_run = false;      // otherwise `why` says why not
  bool has_failed = false;  // an engine that ran once fails under the change
  std::string why;
  std::optional<BitDifference> difference;  // none: the same bits
  std::string body;                         // of the difference
  // Whether a start that differs by one rounding differs as much at the end.
  bool is_like_rounding = false;

  bool breaks() const { return must_hold && (difference || has_failed); }
};

struct RepeatReport {
  std::string case_id;
  RunName run;
  StepSize dt{0, ""};
  long steps = 0;
  double rounding_position = 0, rounding_angle = 0;  // m, rad: at the end, from a start that differs by one rounding
  std::vector<RepeatOutcome> outcomes;
  std::vector<std::uint64_t> hashes;

  bool repeats() const;
};

// Runs the case in another process and returns its hashes; null where no program can be started. `environment`: a
// variable of that process as "NAME=VALUE"; or "".
using HashesElsewhere = std::function<std::vector<std::uint64_t>(const std::string& environment)>;

struct RepeatOptions {
  int jobs = 1;
  double limit = 120;  // s of CPU time for a run
  HashesElsewhere elsewhere = {};
  std::function<void(std::size_t done, std::size_t all)> on_changes = {};  // after each change that was tried
  std::vector<std::string> changes = {};                                   // of change_names(); none: all
};

// In the order in which they are reported.
std::vector<std::string> change_names();

// The states of the run, from a process of its own. Throws InputError where the engine cannot run the scene.
RecordedStates base_states(const EngineTable& engines, const Case& definition, const RunName& run, const StepSize& dt,
                           double limit);

RepeatReport repeat(const EngineTable& engines, const Case& definition, const RunName& run, const StepSize& dt,
                    const RepeatOptions& options);

}  // namespace rigor::inline analysis
