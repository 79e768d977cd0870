// Simultaneous impacts, for the method `event`. Points that approach each other are resolved together, with Newton's
// restitution and Coulomb's cone, and with them the touching points without restitution. Contacts that these push into
// approach are resolved in the next round, until nothing approaches. A cradle thus passes its impulse through, and a
// box lands on its four corners at once. Newton's law can create energy (Kane's paradox: an oblique impact on a corner
// with friction). The restitution of that round is then lowered until it does not. Infinite friction stops slips of
// touching bodies at once, like an impact. Impulses act through the joints.
#pragma once

#include <optional>
#include <utility>

#include "core/dynamics/contact/event/contact_points.h"
#include "core/engine/engine.h"

namespace rigor::inline dynamics {

// In the scene's units of speed. An approach that is slower than this leaves no rebound, unless a run names another
// threshold. A sequence of bounces then ends 2 u / (g (1 - e)) early, which for e = 0.9 on Earth is 2e-7 s.
inline constexpr double kRestitutionThreshold = 5e-8;
// m/s: the run's own threshold, or the one above.
double restitution_threshold(const Settings& settings, const ContactScales& scales);

inline constexpr double kNewEnergy = 1e-12;  // of the energy before an impact: rounding, and no gain
double kinetic_energy(const System& system, BodyColumns state);  // J

class Impacts {
 public:
  // `joints` may be null.
  Impacts(const System& system, const ContactScales& scales, double restitution_threshold, Joints* joints)
      : system_(system),
        scales_(scales),
        solver_(system, {}, joints),
        restitution_threshold_(restitution_threshold),
        joints_(joints) {}

  double restitution_threshold() const { return restitution_threshold_; }  // m/s

  // Changes the velocities so that no touching points approach. Returns whether there were impacts above the
  // restitution threshold.
  bool resolve(MutableBodyColumns state, std::vector<ContactPoint>& contact_points);
  // N s, of each point in the last resolve(), in its frame.
  const std::vector<Vec3>& impulses() const { return impulses_; }
  long work() const { return solver_.work(); }
  // The pairs of bodies that met in the last resolve(), if the result depends on which of them meets first. Found only
  // after watch_ties().
  void watch_ties() { watches_ties_ = true; }
  const std::vector<std::pair<int, int>>& tied() const { return tied_; }
  // Empty if every round converged.
  const std::string& solver_warning() const { return solver_warning_; }

 private:
  bool take_rounds(MutableBodyColumns state, const std::vector<ContactPoint>& contact_points);
  bool choose(BodyColumns state, const std::vector<ContactPoint>& contact_points, bool all);
  std::vector<std::pair<int, int>> hitting_pairs(BodyColumns state) const;
  void find_ties(BodyColumns result, const std::vector<ContactPoint>& contact_points);
  bool decides(const std::pair<int, int>& first, BodyColumns result, const std::vector<ContactPoint>& contact_points);
  void let_infinite_friction_grip();
  void solve_round(MutableBodyColumns state);

  const System& system_;
  ContactScales scales_;
  ConeSolver solver_;
  double restitution_threshold_;
  Joints* joints_;
  std::vector<ConeConstraint> points_, chosen_;
  std::vector<std::size_t> places_;          // of the chosen points
  std::vector<Vec3> impulses_;               // by point
  std::optional<std::pair<int, int>> only_;  // the pair that may take part; all if it is empty
  bool watches_ties_ = false;
  std::vector<std::pair<int, int>> tied_;
  BodyTable start_, other_;
  BodyTable before_;
  bool rebound_ = false;
  std::string solver_warning_;
};

}  // namespace rigor::inline dynamics
