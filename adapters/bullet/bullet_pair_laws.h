// Bullet combines two bodies' friction (product, at most 10) and restitution (product) by functions that are global to
// the process. Ours look up the scene's law of the pair, for bodies of a Rigor world, and leave all others to Bullet. A
// third function is called for each new contact point, and gives a soft pair its stiffness and damping.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "core/scene/contact_laws.h"

namespace rigor::inline adapters::bullet {

// Once in a process; any number of times is the same.
void install_pair_laws();

// The object's contacts follow the laws from now on; the laws must outlive the object.
void follow_laws(btCollisionObject& object, const ContactLaws& laws, int index);

// Also stiffness and damping, and the edges between triangles of a surface that has them
// (bullet_surface.h). This costs a call for each new contact point.
void adjust_contacts(btCollisionObject& object);

}  // namespace rigor::inline adapters::bullet
