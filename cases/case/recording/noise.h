// The noise of a recording, estimated from the recording itself. Through each nine samples in a row a parabola is
// fitted, for the turn from the middle one likewise. In free flight and at rest its residual is noise alone. An impact
// or a quick turn makes it larger, so the median over all such windows counts. It sees scatter only: a camera that is
// off by the same amount everywhere looks exact.
#pragma once

#include <optional>
#include <vector>

#include "cases/case/recording/recording.h"

namespace rigor::inline cases {

struct EstimatedNoise {
  std::optional<double> position, orientation;  // m, rad: one standard deviation along or about each axis
};

// Nothing for a part that was not measured nine times in a row, or that has no scatter.
EstimatedNoise estimated_noise(const std::vector<RecordedTrial>& trials);

}  // namespace rigor::inline cases
