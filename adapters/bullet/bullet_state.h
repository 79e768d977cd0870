// Saves and restores the rigid bodies and contacts of a Bullet world, as pybullet's saveState does, and the order of
// both. A world cannot be given the volumes that its tree of boxes has grown to. Pairs of bodies that do not touch may
// therefore differ after a restore, and with them the order of the solver's rows.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "core/engine/state_archive.h"

namespace rigor::inline adapters::bullet {

// Poses and velocities, with those that the next collision search interpolates from.
void archive_bodies(StateArchive& archive, btDiscreteDynamicsWorld& world);
// Pairs whose boxes overlap, and the points of each with their impulses and lifetimes. The user index of each collision
// object is its own. Bodies are restored before; all are awake afterwards.
void archive_contacts(StateArchive& archive, btDiscreteDynamicsWorld& world);
// Which bodies are awake, and for how long they have been slow.
void archive_sleep(StateArchive& archive, btDiscreteDynamicsWorld& world);

}  // namespace rigor::inline adapters::bullet
