#include "core/dynamics/contact/impulse/step_impulses.h"

#include <algorithm>

namespace rigor::inline dynamics {

// A constraint's normal points from its b to its a, and its impulse acts on its a.
void StepImpulses::begin_update(const std::vector<ContactConstraint>& constraints, BodyColumns state) {
  of_update_.clear(), features_of_update_.clear();
  for (const ContactConstraint& at : constraints) {
    of_update_.push_back(
        {at.b, at.a, state.position(static_cast<std::size_t>(at.a)) + at.arm_a, at.normal, at.gap, Vec3::Zero()});
    features_of_update_.push_back(at.feature);
  }
  impulses_.assign(constraints.size(), Vec3::Zero());
}

void StepImpulses::add_impacts(const ContactRowLayout& rows, const std::vector<Rebounds::RowImpulse>& impacts) {
  for (const auto& [row, impulse] : impacts) impulses_[rows.constraint_of(row)] += impulse;
}

void StepImpulses::add_rows(const ContactRowLayout& rows, const std::vector<ContactConstraint>& constraints) {
  rows.add_impulses(constraints, impulses_.data());
}

// A point that persists from one update to the next is one contact of the step, where it was first.
void StepImpulses::join_update() {
  const std::size_t before = contacts_.size();
  for (std::size_t i = 0; i < of_update_.size(); ++i) {
    std::size_t k = 0;
    while (k < before && !(contacts_[k].a == of_update_[i].a && contacts_[k].b == of_update_[i].b &&
                           features_[k] == features_of_update_[i]))
      ++k;
    if (k == before)
      k = contacts_.size(), contacts_.push_back(of_update_[i]), features_.push_back(features_of_update_[i]);
    contacts_[k].force += impulses_[i];
  }
}

void StepImpulses::end_step(double dt) {
  for (ReportedContact& contact : contacts_) contact.force /= dt;
}

}  // namespace rigor::inline dynamics
