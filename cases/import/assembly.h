// Makes a scene of links, joints and shapes. A body of a scene has its origin at its centre of mass, and one shape
// there.
// - A link becomes a body. It has the axes of its shape if that is centred on the mass, else those of the link.
// - A shape elsewhere becomes a body of its own, fixed to the link's and with a part of its mass. Both together are the
//   same rigid body. The shape is left out if the link's inertia is too small for a part.
// - The world holds some links. Each of their shapes becomes a fixed body.
#pragma once

#include "core/scene/link_model.h"

namespace rigor {

// Adds to model.left_out what a scene cannot say, or says otherwise. Throws InputError.
Scene scene_of(LinkModel& model);

}  // namespace rigor
