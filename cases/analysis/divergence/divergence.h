// When, where and why two runs of one scene part, which of them is right, and which setting closes the gap.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/analysis/divergence/causes.h"
#include "cases/analysis/divergence/gap_series.h"
#include "cases/analysis/divergence/injections.h"
#include "cases/analysis/divergence/parting.h"
#include "cases/analysis/divergence/swap_search.h"

namespace rigor::inline analysis {

// The distance of both runs from the case's truth, of the body that parts, at that instant.
struct DivergenceTruth {
  double a = 0, b = 0, error = 0;                       // in the unit of the parting; of the truth itself [m or rad]
  bool is_made_like_a = false, is_made_like_b = false;  // by the code that makes the truth
  std::string why;                                      // why there is no truth here; else empty

  // The run that is nearer. None if the error of the truth may reverse the order.
  std::optional<RunPair::Side> nearer() const;
};

struct Divergence {
  std::string case_id;
  std::vector<std::string> names;  // of the bodies
  DivergingRun a, b;
  CommonSteps steps;
  PartingBounds bounds;
  SettingsInForce in_a, in_b;
  std::string ended;                  // where a run ended early; else empty
  double spread_a = 0, spread_b = 0;  // shares of a bound by which repeats of a run differ; 0: the same bits
  double compared = 0;                // s
  LargestShare largest;               // of the whole comparison
  GapSeries gap;                      // the same over time
  std::optional<Parting> parting;     // the rest is of it
  Injections injections;
  std::vector<Cause> causes;
  DivergenceTruth truth;
  SwapSearch swaps;
};

// Throws InputError for an engine that lacks a feature of the scene, or fails at once.
Divergence diverge(const EngineTable& engines, const Case& definition, const DivergingRun& a, const DivergingRun& b,
                   const PartingBounds& bounds, const DivergenceOptions& options);

}  // namespace rigor::inline analysis
