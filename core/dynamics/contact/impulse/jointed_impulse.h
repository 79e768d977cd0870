// Contact by impulses of bodies that joints hold together; jointed_impulse.cpp is the method.
#pragma once

#include <memory>

#include "core/dynamics/contact/contact_method.h"

namespace rigor::inline dynamics {

// The parts have joints.
std::unique_ptr<ContactStepper> make_jointed_impulse_stepper(const Scene& scene, const ContactParts& parts);

}  // namespace rigor::inline dynamics
