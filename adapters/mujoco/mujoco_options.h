// The options of MuJoCo's methods. Defaults of the track `stock` are those of MuJoCo 2.2.
#pragma once

#include "core/engine/option_info.h"

namespace rigor::inline adapters {

inline const OptionInfo kMujocoCone{.name = "cone",
                                    .meaning = "the friction cone, or a pyramid in it",
                                    .choices = {"elliptic", "pyramidal"},
                                    .by_default = "elliptic",
                                    .as_shipped = "pyramidal"};
inline const OptionInfo kMujocoImpratio{.name = "impratio",
                                        .meaning = "how much stiffer friction is than contact",
                                        .min = 1e-3,
                                        .max = 1e6,
                                        .by_default = 100.0,
                                        .as_shipped = 1.0};
inline const OptionInfo kMujocoContactTime{.name = "contact-time",
                                           .meaning = "time constant of contacts, s; never less than two steps",
                                           .min = 1e-6,
                                           .max = 10,
                                           .by_default = 0.02};
inline const OptionInfo kMujocoContactDamping{
    .name = "contact-damping",
    .meaning = "damping ratio of contacts, 1 is critical; below it they bounce",
    .min = 0.01,
    .max = 10,
    .by_default = 1.0,
    .features_of_choice = {{"", {Feature::restitution}}}};
// The impedance is the share of the law's acceleration that a contact gives, from d0 at the surface to dmax at `width`.
inline const OptionInfo kMujocoContactStart{.name = "contact-d0",
                                            .meaning = "impedance of contacts at the surface",
                                            .min = 1e-4,
                                            .max = 0.9999,
                                            .by_default = 0.999,
                                            .as_shipped = 0.9};
inline const OptionInfo kMujocoContactDeep{.name = "contact-dmax",
                                           .meaning = "impedance of contacts at the depth contact-width",
                                           .min = 1e-4,
                                           .max = 0.9999,
                                           .by_default = 0.999,
                                           .as_shipped = 0.95};
inline const OptionInfo kMujocoContactWidth{.name = "contact-width",
                                            .meaning = "depth at which the impedance is contact-dmax, m",
                                            .min = 1e-9,
                                            .max = 10,
                                            .by_default = 0.001};
inline const OptionInfo kMujocoContactMargin{.name = "contact-margin",
                                             .meaning = "distance from which contacts press, m",
                                             .min = 0,
                                             .max = 1,
                                             .by_default = 0.0};
inline const OptionInfo kMujocoServo{
    .name = "servo",
    .meaning = "who computes a servo's effort: Rigor before each step, or MuJoCo's actuators",
    .choices = {"computed", "native"},
    .by_default = "computed"};

// The versions of MuJoCo differ in what they need on the track `matched`.
struct MujocoVersion {
  double tolerance;            // of the solver
  bool has_native_collisions;  // MuJoCo 3's own detector beside libccd
};
// With 1e-15 the line search of MuJoCo 2.2 fails now and then. MuJoCo 3 ends its solver while contact forces are off by
// up to 0.03 N with 1e-10, and by 1e-9 N with 0.
inline constexpr MujocoVersion kMujoco2{1e-10, false}, kMujoco3{0, true};

inline const OptionInfo kMujocoIterations{.name = "iterations",
                                          .meaning = "of the solver, at most",
                                          .min = 1,
                                          .max = 10000,
                                          .whole = true,
                                          .by_default = 200.0,
                                          .as_shipped = 100.0};

}  // namespace rigor::inline adapters
