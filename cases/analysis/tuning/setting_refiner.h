// Searches between the values of options that a tuning tries, for bounds that none of these values keeps. A restitution
// within 0.01, for example, takes MuJoCo's damping ratio within 2 %, and its tried values are a factor of 3 apart.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/fitting/minimizer.h"
#include "cases/analysis/tuning/tuning_probe.h"
#include "cases/analysis/tuning/tuning_space.h"

namespace rigor::inline analysis {

// A number of a run, and the tried values on both sides of it.
struct RefinedNumber {
  std::string option;
  double low = 0, high = 0;  // in the option's unit
  bool is_logarithmic = false;
  bool whole = false;
  std::string at(double share) const;  // share 0 is `low`, and 1 is `high`
  double share_of(double number) const;
};

// The numbers that `run` names and `options` leaves to choose.
std::vector<RefinedNumber> refined_numbers(const RunName& run, const std::vector<OptionInfo>& options);

struct Refined {
  Probe probe;
  ProbeAnswer answer;
};

// The best run found at the step of `start`, over the whole duration. The numbers that it names are searched. While
// that does not keep the bounds, one more of `options` is named, the one that improves the run most. `jobs`: cells at
// once.
Refined refine(const Refined& start, const std::vector<OptionInfo>& options, Prober& prober, const EngineTable& engines,
               int jobs);

}  // namespace rigor::inline analysis
