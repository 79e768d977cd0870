// The energy that a scene has in play, from the scene alone. It is the scale of gains and losses if no truth says how
// much energy comes into motion. It never comes from the judged run, because a run that flies apart would excuse
// itself.
#pragma once

#include "core/scene/scene.h"

namespace rigor::inline metric {

// J, the largest kinetic energy that the bodies should reach within `duration` [s]: their initial energy, the energy of
// the springs, the work of timed forces, and each body's weight times the height it can fall. The height ends at the
// highest support under the body, and does not count the inradius below its centre:
//   a level plane                     the body's centre over it
//   a tilted plane                    the same, then the slope as far as it slides without friction
//   any other fixed shape, no plane   the body's centre over the lowest point of the lowest one's bounding sphere
//   a spring, or several in a chain   to the world or a fixed body: their lengths, plus the extension of each
//                                     under twice the scene's weight
//   nothing                           a free fall
// If nothing can fall, move or recoil: the energy that would lift every body by its inradius; without gravity, 1 J.
double energy_in_play(const Scene& scene, double duration);

}  // namespace rigor::inline metric
