#include "core/dynamics/contact/event/event_forces.h"

#include <algorithm>

namespace rigor::inline dynamics {

// A point that persists from one part of the step to the next is one contact, where it was first. The constraint's
// normal points from its b to its a.
void EventForces::add(const ContactPoint& contact, const ConeConstraint& cone, BodyColumns state, const Vec3& impulse) {
  if (contact.is_limit()) return;
  const auto is_here = [&](const ContactPoint& other) {
    return other.same_place(contact) && other.part_a == contact.part_a && other.part_b == contact.part_b;
  };
  const auto found = std::find_if(places_.begin(), places_.end(), is_here);
  if (found != places_.end()) {
    contacts_[static_cast<std::size_t>(found - places_.begin())].force += impulse;
    return;
  }
  places_.push_back(contact);
  contacts_.push_back({cone.b, cone.a, state.position(static_cast<std::size_t>(cone.a)) + cone.arm_a, cone.frame.col(0),
                       contact.gap, impulse});
}

void EventForces::end_step(double dt) {
  for (ReportedContact& contact : contacts_) contact.force /= dt;
}

}  // namespace rigor::inline dynamics
