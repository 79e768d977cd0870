// Motion in persistent contact, for the method `event`: the forces at the points in contact, constant over a sub-step,
// that leave velocities which obey the contact laws at its end. They enter the integrator's step as any other load, so
// that its scheme carries the motion; they act at the mean of the points' places and directions at both ends, which
// makes a sub-step second order where the contact turns, and exact where the forces are constant.
#pragma once

#include "core/dynamics/contact/event/impacts.h"
#include "core/dynamics/contact/event/mass_weighted_projection.h"
#include "core/dynamics/integrators/integrator.h"

namespace rigor {

struct PersistentPoint {
  ContactPoint at_start, at_end;
  double slip_at_start = 0, slip_at_end = 0;  // m/s
  Vec3 force = Vec3::Zero();                  // N, in the frames
};

class PersistentContact {
 public:
  PersistentContact(const Scene& scene, const Integrator& integrator, const OrientationUpdate* orientation,
                    const Settings& settings, ContactPoints& contact_points);

  const System& system() const { return system_; }
  std::vector<PersistentPoint>& points() { return points_; }
  // Takes the touching points that do not separate; forces of points that persist are where the next solve starts.
  void select(BodyColumns state, const std::vector<ContactPoint>& contact_points);
  // Takes those that separate more slowly than `speed`, too. Returns whether there were any.
  bool add_slower_than(double speed, BodyColumns state, const std::vector<ContactPoint>& contact_points);
  // From `start` at t to `end` at t + dt. False if the forces did not settle, as they do in a shorter step.
  bool advance(BodyColumns start, MutableBodyColumns end, double t, double dt);
  // How far the first of the sliding points is from sticking [m/s]: its speed while it slides; once it sticks, minus
  // the speed that the rest of its friction could stop. Infinite where nothing slides.
  double distance_from_sticking() const;
  // Moves bodies so that nothing overlaps and, of `all`, what carries a force has no gap; velocities stay. Returns
  // whether any body had to move.
  enum class Closing { overlaps, all };
  bool close_gaps(MutableBodyColumns state, const std::vector<std::pair<int, int>>& pairs, Closing which);
  // After that the points that carry a force have speeds again, for their arms have turned: takes these away.
  void stop_carrying_points(MutableBodyColumns state);
  long passes() const { return passes_; }  // steps of the integrator so far
  // What went wrong in closing gaps and stopping points since the last call; empty if nothing did.
  std::string take_projection_warning() { return projection_.take_solver_warning(); }
  // What did not settle in the last advance; empty if all did.
  std::string solver_warning() const { return solver_warning_.empty() ? stepper_->solver_warning() : solver_warning_; }

 private:
  double apply_forces(double dt);
  void correct(MutableBodyColumns end, double dt);
  bool carries(const ContactPoint& contact) const;
  void add_target(const ConeConstraint& cone, int axis, double amount, bool bilateral);

  System system_;  // the scene's, with one more force on each colliding body
  std::vector<std::size_t> force_of_body_;
  std::unique_ptr<Stepper> stepper_;
  ConeSolver solver_;
  MassWeightedProjection projection_;
  ContactPoints& contact_points_;
  std::vector<PersistentPoint> points_, old_points_;
  std::vector<ConeConstraint> cones_;
  std::vector<ContactPoint> open_;
  std::vector<ProjectionTarget> targets_;
  Wrenches wrenches_, old_wrenches_;
  double velocity_scale_ = 0;  // m/s, the most that one point's force alone would make of a body's speed in a step
  long passes_ = 0;
  std::string solver_warning_;
};

}  // namespace rigor
