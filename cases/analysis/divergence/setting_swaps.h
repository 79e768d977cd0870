// Settings in which two runs differ, and the runs in which one of them is replaced by that of the other run.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/divergence/run_pair.h"
#include "core/engine/engine.h"

namespace rigor::inline analysis {

struct SettingSwap {
  enum class Kind { option, method, track, step };

  Kind kind = Kind::option;
  RunPair::Side side = RunPair::Side::b;  // of the run that changes
  std::string option;                     // of kind option
  std::string from, to;                   // values; "" for a default that is a rule
  bool clears = false;                    // the run no longer names the option
};

// "gyroscopic: on -> off"
std::string name_of(const SettingSwap& swap);

// A setting of one run that differs from that of the other.
std::vector<SettingSwap> swaps_between(const DivergingRun& a, const DivergingRun& b, const SettingsInForce& in_a,
                                       const SettingsInForce& in_b, const EngineTable& engines);

// Makes the changes of a pair of runs. Throws InputError for one that the method does not take.
void apply_swap(const SettingSwap& swap, DivergingRun& a, DivergingRun& b, const EngineTable& engines);

}  // namespace rigor::inline analysis
