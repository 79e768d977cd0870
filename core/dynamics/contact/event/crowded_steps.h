// Steps without a search for events, for use where the method `event` would find too many of them: Moreau's
// time-stepping (Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988; Acary, Brogliato,
// Numerical Methods for Nonsmooth Dynamical Systems, 2008, chapter 10). The bodies move as if they were free.
// Overlapping bodies are then stopped together, within Coulomb's cones, by impulses that acted throughout the step. The
// order is one; joints are closed at the step's end. A rebound shorter than a step is suppressed: below the speed v* =
// 2 |g| h an impact is plastic.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/contact/event/contact_points.h"

namespace rigor::inline dynamics {

class CrowdedSteps {
 public:
  CrowdedSteps(const ContactParts& parts, ContactPoints& contact_points);

  // s, of a step of the run that is dt long.
  double longest(double dt) const;
  // Steps from t over `rest` or `longest` [s], or less, so that no body moves by more than its inradius. It is never
  // less than a small part of `longest`, unless the rest is. Returns the length. Some overlap remains to be closed.
  double take(MutableBodyColumns state, double t, double rest, double longest);
  // The contacts of the last step, and the impulse on the body a of each [N s, in W].
  const std::vector<ContactPoint>& contacts() const { return touching_; }
  const std::vector<Vec3>& impulses() const { return impulses_; }
  // Empty if the impulses of the last step settled.
  const std::string& solver_warning() const { return solver_warning_; }
  // The number of these steps so far.
  std::string wording() const;
  void archive_state(StateArchive& archive);

 private:
  double short_of_passing(BodyColumns state, double rest, double longest) const;
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
  std::vector<Vec3> impulses_;
  BodyTable free_;  // the state without contact
  double seconds_ = 0;
  long steps_ = 0;
  std::string solver_warning_;
};

}  // namespace rigor::inline dynamics
