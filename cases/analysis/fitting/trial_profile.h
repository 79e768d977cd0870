// The profile likelihood of fitted values, from a few recorded trials whose starts are fitted along.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/fitting/fit_probe.h"
#include "cases/analysis/fitting/profile.h"

namespace rigor::inline analysis {

struct TrialProfile {
  BoxPoint best;                                  // the most likely values
  std::vector<ProfileAxis> axes;                  // empty without intervals
  std::vector<std::vector<double>> correlations;  // of the values
  std::string why_no_intervals;                   // a sentence; empty if there are intervals
  std::vector<std::string> caveats;               // sentences
};

// `minima`: where to search for the best values, best first.
TrialProfile profile_of_trials(FitProbe& probe, const FitTrials& trials, const std::vector<BoxPoint>& minima);

}  // namespace rigor::inline analysis
