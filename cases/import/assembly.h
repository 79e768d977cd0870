// A scene made of links, joints and shapes. A scene's body has its origin at its centre of mass and one shape there:
// - a link becomes a body, its axes those of the link, or of its shape where that is centred on the mass;
// - another shape that can touch something becomes a body of its own, fixed to the link's and with a part of its mass,
//   so that both together are the same rigid body. If no mass can be split off, the shape is left out;
// - each shape of the world becomes a fixed body; the rest is the world.
#pragma once

#include "core/scene/link_model.h"

namespace rigor {

// Says in model.left_out what could not be said, or is said otherwise. Throws InputError.
Scene scene_of(LinkModel& model);

}  // namespace rigor
