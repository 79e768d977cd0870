// Motion in persistent contact, for the method `event`. The contact forces are part of the equations of motion
// (persistent_forces.h). The integrator asks for them at each of its stages, so it keeps its order while each point
// continues to stick or to slide. The drift is corrected after each step. An integrator that does not ask for forces
// passes bodies in contact to one that does, of no lower order. The same holds for joints, with or without contacts:
// between two impacts one system of equations holds joints and points.
#pragma once

#include <functional>

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/contact/event/contact_modes.h"
#include "core/dynamics/contact/event/impacts.h"
#include "core/dynamics/contact/event/mass_weighted_projection.h"
#include "core/dynamics/contact/event/persistent/gap_closing.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/joints/joint_stops.h"
#include "core/dynamics/model/wrench_columns.h"

namespace rigor::inline dynamics {

class PersistentContact {
 public:
  PersistentContact(const ContactParts& parts, ContactPoints& contact_points);

  const std::vector<PersistentPoint>& points() const { return persistent_.points(); }
  // The largest number of moving bodies that these points and joints connect.
  std::size_t most_together(const std::vector<ContactPoint>& contact_points) const;
  // Which of the touching points stay in contact from t on, for some of dt, and which motors keep their speeds. False
  // if there are no forces that obey the laws.
  bool select(MutableBodyColumns state, const std::vector<ContactPoint>& contact_points, double t, double dt);
  // Advances from `start` at t to `end` at t + dt.
  void advance(BodyColumns start, MutableBodyColumns end, double t, double dt);
  // s, at most `length`, from the start that select() was called for. Friction damps slips across the direction of
  // sliding within m u/(mu N). An explicit method whose step is many of such times lets them grow. If the direction
  // turns, its error grows earlier, so an adaptive method takes over. Jointed bodies that rotate far need short steps,
  // too.
  double choose_step(BodyColumns state, double length);
  // 1/s: how fast friction damps the slowest slip, as of the last choose_step(); 0 without slips.
  double fastest_damping() const { return fastest_damping_; }
  // Whether nothing moves, and nothing will.
  bool is_at_rest(BodyColumns state) const;
  // Whether the body rests together with everything that it touches, while others move. It rests until something else
  // touches it, so its points need no forces at the stages.
  bool rests(int body) const { return rests_[static_cast<std::size_t>(body)] != 0; }
  // Visits the points with their forces from t on, for h. The sum of seconds times force is a point's impulse. `start`
  // and t are those of the last advance, which went as far as h. The motion stays as it was.
  using SeeForce = std::function<void(const PersistentPoint& point, BodyColumns state, double seconds)>;
  void visit_forces(BodyColumns start, double t, double h, const SeeForce& see);
  void visit_forces_at_rest(BodyColumns state, double h, const SeeForce& see);
  // How far the end of the last advance is from a change of what sticks, slides, touches or is driven there: negative
  // beyond it.
  double distance_from_change();
  // Before an impact: motors have no impulses.
  void let_go_motors(BodyColumns state);
  // As Loads::next_switch(), for the motors of a given speed.
  double next_switch(double t, double end) const { return motors_ ? motors_->next_switch(t, end) : end; }
  void forget_points();
  // Moves bodies so that nothing overlaps and, of `all`, what carries a force has no gap; velocities stay. Returns
  // whether any body had to move.
  enum class Closing { overlaps, all };
  bool close_gaps(MutableBodyColumns state, const std::vector<std::pair<int, int>>& pairs, Closing which);
  // Brings the joints back to where they hold.
  void close_joints(MutableBodyColumns state);
  // The point at which the last close_gaps() left two bodies deep in each other, because they have no room; null if
  // there is none.
  const ContactPoint* jam() const { return gaps_.jam(); }
  // Takes the velocities away that the points must not have. `before` they move, what begins to slip does not slip yet,
  // and what slides gets the friction of the impacts that are left out. `without_forces` it gets none.
  enum class When { before, without_forces, after };
  void stop_points(MutableBodyColumns state, When when);

  const std::vector<Loading>& largest_loads() const { return persistent_.largest_loads(); }
  const std::string& integrator_in_contact() const { return in_contact_.name; }
  bool has_joints() const { return joints_ != nullptr; }
  // Steps of the integrator so far; one that an adaptive method divides much counts as several.
  long passes() const { return passes_; }
  // Failures of closing gaps and stopping points since the last call; empty if there were none.
  std::string take_projection_warning() { return projection_.take_solver_warning(); }
  void archive_state(StateArchive& archive);
  // Failures of the last advance; empty if there were none.
  std::string solver_warning() const;

 private:
  bool select_points(MutableBodyColumns state, const std::vector<ContactPoint>& contact_points, double t, double dt);
  double distance_from_change_of_points();
  const double* wrench_beside_joints(const double* loads);
  double margin() const;
  double slipping_margin() const;
  void note_ends(BodyColumns state);
  double distance_from_ends() const;
  double longest_turn(BodyColumns state) const;
  double longest_way_of_rims(BodyColumns state) const;
  double damping_rate(const PersistentPoint& point) const;
  bool is_adaptive() const { return in_contact_.adaptive || follows_turning_slip_; }
  Stepper& stepper() const;
  void set_resting_aside(BodyColumns state);
  bool stop_with_friction(MutableBodyColumns state, double most);

  const ContactScales& scales() const { return persistent_.scales(); }
  double threshold_of(const ContactPoint& contact) const;

  bool is_free() const { return points().empty() && !joints_; }

  const System& system_;
  Joints* joints_;
  JointStops* motors_;  // null without joints
  std::string noted_;   // of the joints, before the present trial
  const Integrator& in_contact_;
  ContactPoints& contact_points_;
  PersistentForces persistent_;
  ContactModes modes_;
  std::unique_ptr<Stepper> free_stepper_, contact_stepper_, adaptive_stepper_;
  bool follows_turning_slip_ = false;  // by adaptive_stepper_
  double fastest_damping_ = 0;         // 1/s
  WrenchColumns loads_;
  Columns beside_joints_;
  MassWeightedProjection projection_;
  GapClosing gaps_;
  double restitution_threshold_;  // m/s
  BodyColumns end_;
  const double* wrench_at_end_ = nullptr;
  std::vector<PersistentPoint> old_points_, resting_points_;
  std::vector<char> rests_;  // by body
  std::vector<ProjectionTarget> targets_;
  BodyTable sampled_;
  BodyTable before_;
  long passes_ = 0;
};

}  // namespace rigor::inline dynamics
