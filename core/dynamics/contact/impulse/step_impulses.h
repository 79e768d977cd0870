// The impulses of one step at its contact points, for reports of contact forces. A step has several updates of its
// contacts, and each update several sub-steps.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/contact/impulse/contact_row_layout.h"
#include "core/dynamics/contact/impulse/rebounds/rebounds.h"
#include "core/engine/capabilities.h"

namespace rigor::inline dynamics {

class StepImpulses : public ReportsContacts {
 public:
  void ask_for_contacts() override { is_asked_ = true; }
  std::vector<ReportedContact> contacts() const override { return contacts_; }

  bool is_asked() const { return is_asked_; }
  void begin_step() { contacts_.clear(), features_.clear(); }
  // The contacts until the next update. `state` is that of the update.
  void begin_update(const std::vector<ContactConstraint>& constraints, BodyColumns state);
  // Adds the impacts of bodies that bounce, and the impulses of the rows, of one sub-step.
  void add_impacts(const ContactRowLayout& rows, const std::vector<Rebounds::RowImpulse>& impacts);
  void add_rows(const ContactRowLayout& rows, const std::vector<ContactConstraint>& constraints);
  // As add_rows(), where the impulses are in other rows.
  Vec3* impulses() { return impulses_.data(); }
  void end_update() { join_update(); }
  void end_step(double dt);

 private:
  void join_update();

  bool is_asked_ = false;
  std::vector<ReportedContact> contacts_, of_update_;
  std::vector<std::uint32_t> features_, features_of_update_;
  std::vector<Vec3> impulses_;  // N s, of the update's constraints
};

}  // namespace rigor::inline dynamics
