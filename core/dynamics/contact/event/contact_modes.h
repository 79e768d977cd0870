// Decides which of the touching points stay in contact, and which of them slide, for the method `event`. The forces
// must satisfy the contact laws in accelerations, with the laws of an impact's velocities,
//   0 <= u'_n ⊥ f_n >= 0,   |f_t| <= mu f_n, against u'_t where that is not zero; of a point that slides, against u_t.
// A point that does not slide has its static friction. If that does not hold it, it slides with `friction`.
// If the points outnumber the degrees of freedom, this finds some forces within the cones if there are any.
// PersistentForces with the same accelerations may have others.
#pragma once

#include "core/dynamics/contact/event/persistent/persistent_forces.h"

namespace rigor::inline dynamics {

class ContactModes {
 public:
  // `joints`, which may be null, are those of the forces.
  ContactModes(const System& system, PersistentForces& forces, Joints* joints)
      : solver_(system, {}, joints), system_(system), joints_(joints), persistent_(forces) {}

  // Gives each of the persistent points its mode, and drops those that part. False if no forces were found.
  bool choose(BodyColumns state, const double* wrench);
  // Whether, after choose(), nothing moves and nothing begins to.
  bool are_at_rest(BodyColumns state) const;
  bool is_at_rest(BodyColumns state, int body) const;
  // The violation of the laws by the points' modes at this instant, relative to the accelerations: above 0 if other
  // modes must be chosen. Call it after persistent_.hold() at this instant.
  double violation(BodyColumns state, const double* wrench);

  // In the scene's units of speed. A slower slip sticks if the cone allows it, 5e-15 m/(m/s²) before it would stop.
  static constexpr double kSliding = 1e-7;

 private:
  const ContactScales& scales() const { return persistent_.scales(); }
  bool drop_pulling_points(BodyColumns state, const double* wrench);
  enum class Slips { by_speed, as_chosen };
  bool solve(BodyColumns state, const double* wrench, Slips slips);
  bool slides(const PersistentPoint& point, Slips slips) const;
  bool let_slip(MutableBodyColumns accelerations, Slips slips);
  void start_from_cones();
  Vec3 acceleration_of(std::size_t point) const;  // m/s², in the frame

  ConeSolver solver_;
  const System& system_;
  Joints* joints_;
  PersistentForces& persistent_;
  std::vector<ConeConstraint> cones_;
  BodyTable accelerations_;
  double size_ = 0;  // m/s²
};

}  // namespace rigor::inline dynamics
