// The energy that a scene has in play, from the scene alone: what a gain or a loss is measured by where no truth says
// how much of it comes into motion. Never from a run that is judged: one that flies apart would excuse itself.
#pragma once

#include "core/scene/scene.h"

namespace rigor {

// J, the most kinetic energy that the bodies should come to have within `duration` [s]: what they start with, what
// the springs store, what timed forces can give, and each body's weight times the height it can fall. That height ends
// at the highest support under the body, and does not count the inradius that is left under its centre:
//   a level plane                     the body's centre over it
//   a tilted plane                    likewise, and then the slope as far as it slides without friction
//   any other fixed shape, no plane   the body's centre over the lowest point of the sphere round the lowest such shape
//   a spring, or several in a chain   to the world or a fixed body: their lengths, with what twice all of the scene's
//                                     weight stretches each by
//   nothing                           a free fall
// Where nothing can fall, move or recoil: what would lift every body by its inradius; without gravity, 1 J.
double energy_in_play(const Scene& scene, double duration);

}  // namespace rigor
