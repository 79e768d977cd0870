// A cell of a case whose recording has trials. Every trial runs from its own start, one after another in the cell's
// process. The cell's metrics are the means over the trials.
#pragma once

#include <functional>
#include <memory>

#include "cases/case/recording/recording.h"
#include "cases/runner/case_process.h"

namespace rigor::inline runner {

// Runs one trial; its case starts as the trial does.
using RunTrial = std::function<JudgedCell(const Case& of_trial, const Truth& truth, const TruthFacts& facts,
                                          const GridOptions& options)>;

// Recorders keep the first trial, or each of them (Recorder::keeps_each_trial). The status is that of the worst trial,
// which the reason names.
JudgedCell run_trials(const Case& definition, const std::shared_ptr<const MotionRecording>& recording,
                      const GridOptions& options, const RunTrial& run);

// What recorders keep of a case's truth, of a recording with trials as of each trial.
Recordings recordings_of_truth(const Case& definition, const Truth& truth, const TruthFacts& facts,
                               const Recorders& recorders);

}  // namespace rigor::inline runner
