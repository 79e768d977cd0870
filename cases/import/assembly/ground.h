// The ground that a model stands on.
#pragma once

#include "core/scene/link_model.h"

namespace rigor::inline imports {

inline constexpr double kGroundFriction = 1;  // of --ground: rubber on concrete

// Adds a plane, across gravity, under the lowest point of all shapes at t = 0. A model with a plane keeps its own.
// Throws InputError if no shape could touch it.
void add_ground(LinkModel& model);

}  // namespace rigor::inline imports
