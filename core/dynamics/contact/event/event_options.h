// The options of contact by events.
#pragma once

#include <fmt/format.h>

#include "core/dynamics/contact/event/impacts.h"
#include "core/engine/option_info.h"

namespace rigor::inline dynamics {

inline const OptionInfo kRestitutionThresholdOption{
    .name = "restitution-threshold",
    .meaning = "m/s, from below which nothing rebounds",
    .min = 1e-15,
    .max = 1,
    .by_default = DefaultRule{fmt::format("{} of the scene's speed", kRestitutionThreshold)}};
inline const OptionInfo kThresholdsOption{
    .name = "thresholds",
    .meaning = "factor on the thresholds that tell what touches, slides and rebounds",
    .min = 1e-3,
    .max = 1e3,
    .by_default = 1.0};
inline const OptionInfo kPatienceOption{.name = "patience",
                                        .meaning = "factor on the work that events may take before the run is invalid",
                                        .min = 1,
                                        .max = 1e6,
                                        .by_default = 1.0};

}  // namespace rigor::inline dynamics
