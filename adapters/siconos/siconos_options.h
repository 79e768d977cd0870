// The options of Siconos's method and of its twin. siconos_info.h gives the same to the seam of engines from outside.
#pragma once

#include "adapters/siconos/siconos_matched.h"
#include "core/engine/option_info.h"

namespace rigor::inline adapters {

inline const OptionInfo kSiconosThetaOption{
    .name = "theta", .meaning = "weight of the step's end", .min = 0.5, .max = 1, .by_default = kSiconosTheta};
inline const OptionInfo kSiconosToleranceOption{.name = "tolerance",
                                                .meaning = "of the contact solver",
                                                .min = 1e-15,
                                                .max = 1,
                                                .by_default = kSiconosTolerance,
                                                .as_shipped = DefaultRule{"as shipped"}};
inline const OptionInfo kSiconosIterationsOption{.name = "iterations",
                                                 .meaning = "most of the contact solver",
                                                 .min = 1,
                                                 .max = 1000000,
                                                 .whole = true,
                                                 .by_default = double{kSiconosIterations},
                                                 .as_shipped = DefaultRule{"as shipped"}};

}  // namespace rigor::inline adapters
