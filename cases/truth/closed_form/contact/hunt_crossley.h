// A ball that bounces along the normal of a plane by the contact law of Hunt and Crossley: at an overlap x the force is
// max(0, k x (1 + d x')).
#pragma once

#include <memory>

#include "cases/truth/closed_form/contact/plane_contact.h"

namespace rigor::inline truth {

// `stiffness` k [N/m], `dissipation` d [s/m], both above 0. Throws InputError if the ball starts inside the plane.
std::unique_ptr<BodyMotion> hunt_crossley_bounce(const Body& body, const Ground& ground, Extended stiffness,
                                                 Extended dissipation, Extended duration);

}  // namespace rigor::inline truth
