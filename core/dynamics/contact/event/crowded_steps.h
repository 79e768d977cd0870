// Steps that do not look for events, for where the method `event` would find too many of them: Moreau's time-stepping
// (Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988; Acary, Brogliato, Numerical Methods
// for Nonsmooth Dynamical Systems, 2008, chapter 10). The bodies move as if they were free; what then overlaps is
// stopped together, within Coulomb's cones, by impulses that acted all through the step. Of first order; joints are
// closed at its end. A rebound that would be over within a step does not take place: below the speed v* = 2 |g| h an
// impact is plastic.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/contact/event/contact_points.h"

namespace rigor {

class CrowdedSteps {
 public:
  CrowdedSteps(const ContactParts& parts, ContactPoints& contact_points);

  // s, of a step of the run that is dt long.
  double longest(double dt) const;
  // From t on, over h [s] or less, so that no body moves by more than its inradius. Returns over how much. Some overlap
  // is left to be closed.
  double take(MutableBodyColumns state, double t, double h);
  // Empty if the impulses of the last step settled.
  const std::string& solver_warning() const { return solver_warning_; }
  // How many of them there were so far.
  std::string wording() const;

 private:
  double short_of_passing(BodyColumns state, double h) const;
  void stop_overlaps(MutableBodyColumns state, double h);
  Vec3 impulse_before(const ContactPoint& contact) const;
  void solve_where_they_came_to(MutableBodyColumns state);

  const System& system_;
  Joints* joints_;
  ContactPoints& contact_points_;
  std::unique_ptr<Stepper> stepper_;
  ConeSolver solver_;
  std::vector<ContactPoint> touching_, before_;  // of the step, and of the one before
  double length_before_ = 1;                     // s, of that
  std::vector<ConeConstraint> cones_;
  BodyTable free_;  // the state without contact
  double seconds_ = 0;
  long steps_ = 0;
  std::string solver_warning_;
};

}  // namespace rigor
