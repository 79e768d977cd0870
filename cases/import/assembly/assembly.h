// Makes a scene of links, joints and shapes. A link becomes one body with all its shapes. Its origin is its centre of
// mass. It has the axes of its shape if that is its only one and centred, else those of the
// link. Each shape of a link that the world holds becomes a fixed body.
#pragma once

#include "core/scene/link_model.h"

namespace rigor::inline imports {

// Adds to model.left_out what a scene cannot say. `with_ground`: also a plane under the lowest shape, unless the model
// has a plane. Throws InputError.
Scene scene_of(LinkModel& model, bool with_ground = false);

}  // namespace rigor::inline imports
