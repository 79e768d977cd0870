// The contact forces of one step of the method `event`, for reports. They are means over the step: impulses of impacts
// and of crowded steps, and integrals of persistent forces, divided by its length.
#pragma once

#include <vector>

#include "core/dynamics/contact/event/contact_points.h"
#include "core/engine/capabilities.h"

namespace rigor::inline dynamics {

class EventForces : public ReportsContacts {
 public:
  void ask_for_contacts() override { is_asked_ = true; }
  std::vector<ReportedContact> contacts() const override { return contacts_; }

  bool is_asked() const { return is_asked_; }
  void begin_step() { contacts_.clear(), places_.clear(); }
  // An impulse [N s, in W] on the body a of `contact`, whose cone belongs to `state`.
  void add(const ContactPoint& contact, const ConeConstraint& cone, BodyColumns state, const Vec3& impulse);
  void end_step(double dt);

 private:
  bool is_asked_ = false;
  std::vector<ReportedContact> contacts_;
  std::vector<ContactPoint> places_;  // of the contacts
};

}  // namespace rigor::inline dynamics
