// The options of Bullet's methods and of its twin. Defaults of the track `stock` are those of Bullet 3.24.
#pragma once

#include <fmt/format.h>

#include "adapters/bullet/bullet_matched.h"
#include "core/engine/option_info.h"

namespace rigor::inline adapters::bullet {

inline const OptionInfo kIterations{.name = "iterations",
                                    .meaning = "sweeps of the solver a step",
                                    .min = 1,
                                    .max = 10000,
                                    .whole = true,
                                    .by_default = 10.0};
inline const OptionInfo kGyroscopic{.name = "gyroscopic",
                                    .meaning = "the gyroscopic torque",
                                    .choices = {"implicit-body", "implicit-world", "explicit", "off"},
                                    .by_default = "implicit-body"};
inline const OptionInfo kSplitImpulse{.name = "split-impulse",
                                      .meaning = "penetration corrected without adding velocity",
                                      .choices = {"on", "off"},
                                      .by_default = "on"};

inline constexpr double kShippedErp = 0.2;
inline const OptionInfo kErpOption{
    .name = "erp",
    .meaning = "share of a joint's error corrected in one step",
    .min = 0,
    .max = 1,
    .by_default = DefaultRule{fmt::format("{} with joints, {} without", kErp, kShippedErp)},
    .as_shipped = kShippedErp};
inline const OptionInfo kCfm{.name = "cfm",
                             .meaning = "constraint force mixing: softness of joints and contacts",
                             .min = 0,
                             .max = 1,
                             .by_default = 0.0};
// The same for the direct solver.
inline const OptionInfo kDirectCfm{
    .name = "cfm",
    .meaning = "constraint force mixing: softness of joints and contacts",
    .min = 0,
    .max = 1,
    .by_default = DefaultRule{fmt::format("dt/(heaviest mass) times {} with joints, {} without", kJointSoftness,
                                          kContactSoftness)},
    .as_shipped = 0.0};

// The twin knows joints alone.
inline const OptionInfo kTwinErp{
    .name = "erp", .meaning = "share of a joint's gap closed in one step", .min = 0, .max = 1, .by_default = kErp};
inline const OptionInfo kTwinCfm{.name = "cfm",
                                 .meaning = "softness of the joints' rows",
                                 .min = 0,
                                 .max = 1,
                                 .by_default = DefaultRule{fmt::format("dt/(heaviest mass) times {}", kJointSoftness)}};
inline constexpr double kNoLimit = 1e30;  // N m
inline const OptionInfo kGyroscopicLimit{.name = "gyroscopic-limit",
                                         .meaning = "where the explicit torque is cut off [N m]",
                                         .min = 0,
                                         .max = kNoLimit,
                                         .by_default = kNoLimit};
inline const OptionInfo kSleeping{
    .name = "sleeping", .meaning = "whether slow bodies fall asleep", .choices = {"on", "off"}, .by_default = "off"};

}  // namespace rigor::inline adapters::bullet
