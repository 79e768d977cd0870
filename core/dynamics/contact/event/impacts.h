// Simultaneous impacts, for the method `event`. Points that approach each other now are resolved together, with
// Newton's restitution and Coulomb's cone, and with them the touching points whose restitution is 0; what they push
// into a neighbour is resolved in the next round, and so on until nothing approaches. Thus a cradle passes its impulse
// through, and a box lands on its four corners at once. Where Newton's law would create energy (Kane's paradox: an
// oblique blow on a corner with friction), the restitution of that round is lowered until it does not. Infinite
// friction stops slips of what touches at once, as an impact. Impulses act through the joints.
#pragma once

#include "core/dynamics/contact/event/contact_points.h"

namespace rigor {

// Approaching more slowly than this leaves no rebound: a sequence of bounces ends here, 2 u / (g (1 - e)) before its
// own end, which for e = 0.9 on Earth is 2e-7 s.
inline constexpr double kRestitutionThreshold = 1e-7;  // m/s, unless a run names another
// What the roundings of an impact leave of a velocity that should be zero.
inline constexpr double kStillSpeed = 1e-10;  // m/s

inline constexpr double kNewEnergy = 1e-12;  // of the energy before an impact: rounding, and no gain
double kinetic_energy(const System& system, BodyColumns state);  // J

class Impacts {
 public:
  // `joints` may be null.
  Impacts(const System& system, double restitution_threshold, Joints* joints)
      : system_(system), solver_(system, {}, joints), restitution_threshold_(restitution_threshold) {}

  double restitution_threshold() const { return restitution_threshold_; }  // m/s

  // Changes the velocities so that no touching points approach. Returns whether there were impacts above the
  // restitution threshold.
  bool resolve(MutableBodyColumns state, std::vector<ContactPoint>& contact_points);
  long work() const { return solver_.work(); }
  // Empty if every round came to its end.
  const std::string& solver_warning() const { return solver_warning_; }

 private:
  bool choose(BodyColumns state, const std::vector<ContactPoint>& contact_points, bool all);
  void let_infinite_friction_grip();
  void solve_round(MutableBodyColumns state);

  const System& system_;
  ConeSolver solver_;
  double restitution_threshold_;
  std::vector<ConeConstraint> points_, chosen_;
  BodyTable before_;
  bool rebound_ = false;
  std::string solver_warning_;
};

}  // namespace rigor
