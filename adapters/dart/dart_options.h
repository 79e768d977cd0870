// The options of DART's methods. Defaults of the track `stock` are those of DART 6.12.
#pragma once

#include <fmt/format.h>

#include "adapters/dart/dart_matched.h"
#include "core/engine/option_info.h"

namespace rigor::inline adapters {

inline const OptionInfo kDartErp{
    .name = "erp",
    .meaning = "share of a gap or an overlap corrected in one step",
    .min = 0,
    .max = 1,
    .by_default = DefaultRule{fmt::format("{} for contacts, {} for loops", kDartContactErp, kDartLoopErp)},
    .as_shipped = 0.01};
inline const OptionInfo kDartSoftness{.name = "cfm",
                                      .meaning = "share by which a constraint's own inverse mass is raised: softness",
                                      .min = 1e-9,
                                      .max = 1,
                                      .by_default = kDartCfm,
                                      .as_shipped = 1e-5};

}  // namespace rigor::inline adapters
