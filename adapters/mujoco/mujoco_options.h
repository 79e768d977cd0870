// The options of MuJoCo's methods. Defaults of the track `stock` are those of MuJoCo 2.2.
#pragma once

#include "core/engine/option_info.h"

namespace rigor {

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
inline const OptionInfo kMujocoIterations{.name = "iterations",
                                          .meaning = "of the solver, at most",
                                          .min = 1,
                                          .max = 10000,
                                          .whole = true,
                                          .by_default = 200.0,
                                          .as_shipped = 100.0};

}  // namespace rigor
