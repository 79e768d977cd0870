// The options of ODE's methods and of its twin. Defaults of the track `stock` are those of ODE 0.16 in double
// precision.
#pragma once

#include <fmt/format.h>

#include "adapters/ode/ode_matched.h"
#include "core/engine/option_info.h"

namespace rigor::inline adapters {

inline const OptionInfo kOdeGyroscopic{
    .name = "gyroscopic", .meaning = "the implicit gyroscopic torque", .choices = {"on", "off"}, .by_default = "on"};
inline const OptionInfo kOdeRotation{
    .name = "rotation",
    .meaning = "update of the orientation: the exact turn, or an added quaternion rate",
    .choices = {"finite", "infinitesimal"},
    .by_default = "finite",
    .as_shipped = "infinitesimal"};

inline constexpr double kOdeShippedErp = 0.2, kOdeShippedCfm = 1e-10;
inline const OptionInfo kOdeErp{
    .name = "erp",
    .meaning = "share of a constraint's error corrected in one step",
    .min = 0,
    .max = 1,
    .by_default = DefaultRule{fmt::format("{} for joints, {} for contacts", kMatchedJointErp, kOdeShippedErp)},
    .as_shipped = kOdeShippedErp};
inline const OptionInfo kOdeCfm{
    .name = "cfm",
    .meaning = "constraint force mixing: softness of constraints",
    .min = 0,
    .max = 1,
    .by_default = DefaultRule{fmt::format("dt/(heaviest mass) times {} with joints, {} without", kMatchedJointSoftness,
                                          kMatchedContactSoftness)},
    .as_shipped = kOdeShippedCfm};
inline const OptionInfo kOdeIterations{
    .name = "iterations", .meaning = "sweeps a step", .min = 1, .max = 10000, .whole = true, .by_default = 20.0};
inline const OptionInfo kOdeSor{
    .name = "sor", .meaning = "over-relaxation factor", .min = 0.01, .max = 2, .by_default = 1.3};

inline const OptionInfo kOdeServo{
    .name = "servo",
    .meaning = "who computes a servo's effort: Rigor before each step, or ODE by a soft stop at the target",
    .choices = {"computed", "native"},
    .by_default = "computed"};

// The twin has no track of its own: the engine names what its track sets. It knows joints alone.
inline const OptionInfo kOdeTwinRotation{.name = kOdeRotation.name,
                                         .meaning = kOdeRotation.meaning,
                                         .choices = kOdeRotation.choices,
                                         .by_default = kOdeRotation.by_default};
inline const OptionInfo kOdeTwinErp{.name = "erp",
                                    .meaning = "share of a joint's gap closed in one step",
                                    .min = 0,
                                    .max = 1,
                                    .by_default = kMatchedJointErp};
inline const OptionInfo kOdeTwinCfm{
    .name = "cfm",
    .meaning = "softness of the joints' rows",
    .min = 0,
    .max = 1,
    .by_default = DefaultRule{fmt::format("dt/(heaviest mass) times {}", kMatchedJointSoftness)}};

}  // namespace rigor::inline adapters
