// Which setting closes the gap. One setting of a run is replaced at a time; the run is repeated until the instant of
// the parting, and the rest of the gap is measured. Then the best are tried in pairs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/analysis/divergence/parting.h"
#include "cases/analysis/divergence/setting_swaps.h"

namespace rigor::inline analysis {

struct TriedSwap {
  std::vector<SettingSwap> swaps;  // one, or a pair
  DivergingRun a, b;               // the runs that it makes
  double closes = 0;               // share of the gap; 1: all of it; negative if it widens
  double closes_at_half_step = 0;  // the same with both steps halved; only where it is checked
  bool is_checked = false;
  bool has_gap_at_half_step = true;  // false: with both steps halved the runs stay within the bound, also for longer
  std::string why;                   // why it could not run; else empty
};

struct SwapSearch {
  std::vector<TriedSwap> tried;   // single ones by what they close, then pairs by what they close
  std::optional<TriedSwap> best;  // it closes at least half, also at half the step if a gap is left there
  bool has_differing_setting = false;
};

SwapSearch search_swaps(const RunPair& pair, const Scene& scene, double duration, const SettingsInForce& in_a,
                        const SettingsInForce& in_b, const PartingBounds& bounds, const Parting& parting,
                        const DivergenceOptions& options);

}  // namespace rigor::inline analysis
