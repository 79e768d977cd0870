// Evaluates points of a fit: each point on some trials, in child processes.
#pragma once

#include <map>
#include <memory>

#include "cases/analysis/fitting/fitting.h"
#include "cases/analysis/fitting/minimizer.h"
#include "cases/analysis/fitting/trial_error.h"
#include "cases/analysis/fitting/trial_residuals.h"
#include "cases/analysis/sweep/sweep.h"
#include "cases/runner/process_pool.h"

namespace rigor::inline analysis {

struct FitTrial {
  std::size_t of_case = 0, trial = 0;
};
using FitTrials = std::vector<FitTrial>;

// One trial with the values of a point, whose start is moved for each recorded body.
struct StartedTrial {
  BoxPoint at;
  FitTrial trial;
  std::vector<StartShift> shifts;
};

class FitProbe {
 public:
  FitProbe(const FitInput& input, const EngineTable& engines, const Vocabulary& vocabulary);

  FitTrials all_trials() const;
  const MotionRecording* recording_of(std::size_t of_case) const { return recordings_[of_case].get(); }
  std::vector<std::string> values_at(const BoxPoint& point) const;
  // The errors of each trial at each point.
  std::vector<std::vector<TrialError>> errors(const std::vector<BoxPoint>& points, const FitTrials& trials);
  // Of recorded trials. The nearest velocities that the joints allow replace those of a moved start.
  std::vector<TrialResiduals> residuals(const std::vector<StartedTrial>& runs);
  const Scene& scene_of(std::size_t of_case) const { return input_.cases[of_case].scene; }
  const RecordedTrial& recorded(const FitTrial& one) const { return recordings_[one.of_case]->trials[one.trial]; }
  // The case at a point, and the run with the point's options.
  Case definition_at(const BoxPoint& point, std::size_t of_case) const;
  RunName run_at(const BoxPoint& point) const;
  std::size_t points() const { return points_; }  // tried so far

 private:
  SweepRow row_at(const BoxPoint& point, std::size_t of_case) const;
  void check_ends() const;
  void send_residuals(const std::vector<StartedTrial>& runs, std::size_t first, std::size_t stride,
                      const Channel& channel) const;

  const FitInput& input_;
  const EngineTable& engines_;
  Sweep sweep_;                                                     // knows how a key changes a case or a run
  std::vector<std::shared_ptr<const MotionRecording>> recordings_;  // of each case; null for a computed truth
  std::vector<std::vector<std::shared_ptr<const Truth>>> truths_;   // of each case and trial, as the case is written
  std::size_t points_ = 0;
};

}  // namespace rigor::inline analysis
