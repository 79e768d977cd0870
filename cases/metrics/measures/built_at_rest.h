// Scenes that are built to stand: every body at rest at the start and touching another, only gravity acting, or
// constant forces under which the truth stands. Ground of creep, collapse_time, force_peak and force_ripple.
#pragma once

#include <optional>
#include <string>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {

// Why the run's scene is not built to stand, or its truth moves; empty if it stands.
std::string why_not_built_at_rest(const JudgedRun& run);

// The first instant at which a body of such a scene has moved by more than half its bounding radius; none if all stand.
std::optional<Instant> collapse_of(const JudgedRun& run);

}  // namespace rigor::inline metric
