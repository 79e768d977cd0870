// A scene made of links, joints and shapes. A scene's body has its origin at its centre of mass and one shape there:
// - a link becomes a body, its axes those of the link, or of its shape where that is centred on the mass;
// - a shape elsewhere that something may touch becomes a body of its own, fixed to the link's and with a part of its
//   mass, so that both together are the same rigid body; where no part can be taken, it is left out;
// - of what the world holds each shape becomes a fixed body, and the rest is the world.
#pragma once

#include "core/scene/link_model.h"

namespace rigor {

// Says in model.left_out what could not be said, or is said otherwise. Throws InputError.
Scene scene_of(LinkModel& model);

}  // namespace rigor
