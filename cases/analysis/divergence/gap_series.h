// The gap between two runs over time, thinned for a plot.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "cases/analysis/divergence/parting.h"

namespace rigor::inline analysis {

// At each time the largest share of a bound that any moving body has.
struct GapSeries {
  std::vector<double> time, share;  // s, ascending; 1: the bound
};

// Each kept sample is one of the motions. Of a group of neighbours the largest is kept, so no peak is lost. Both sides
// of the parting have the same number of groups: the parting may be early. The sample of the parting and its
// neighbour before it are always kept, as are the first and the last one. At most 404 samples.
GapSeries gap_series(const MotionView& a, const MotionView& b, const Scene& scene, const PartingBounds& bounds,
                     double seconds_per_sample, const std::optional<Parting>& parting);

}  // namespace rigor::inline analysis
