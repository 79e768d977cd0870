// Which setting closes the gap. One setting of a run is replaced at a time; the run is repeated until the instant of
// the parting, and the rest of the gap is measured. Then the best are tried in pairs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/analysis/divergence/parting.h"
#include "cases/analysis/divergence/run_pair.h"
#include "core/engine/engine.h"

namespace rigor {

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

struct TriedSwap {
  std::vector<SettingSwap> swaps;  // one, or a pair
  DivergingRun a, b;               // the runs that it makes
  double closes = 0;               // share of the gap; 1: all of it; negative if it widens
  double closes_at_half_step = 0;  // the same with both steps halved; only where it is checked
  bool is_checked = false;
  std::string why;  // why it could not run; else empty
};

struct SwapSearch {
  std::vector<TriedSwap> tried;   // single ones by what they close, then pairs by what they close
  std::optional<TriedSwap> best;  // it closes at least half, also at half the step
  bool has_differing_setting = false;
};

// A setting of one run that differs from that of the other.
std::vector<SettingSwap> swaps_between(const DivergingRun& a, const DivergingRun& b, const SettingsInForce& in_a,
                                       const SettingsInForce& in_b, const EngineTable& engines);

// Makes the changes of a pair of runs. Throws InputError for one that the method does not take.
void apply_swap(const SettingSwap& swap, DivergingRun& a, DivergingRun& b, const EngineTable& engines);

SwapSearch search_swaps(const RunPair& pair, const Scene& scene, double duration, const SettingsInForce& in_a,
                        const SettingsInForce& in_b, const PartingBounds& bounds, const Parting& parting,
                        const DivergenceOptions& options);

}  // namespace rigor
