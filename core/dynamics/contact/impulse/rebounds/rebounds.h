// Impacts of bodies that bounce, each at its own instant within a sub-step over which the integrator has moved the
// bodies freely. With that motion, and the impacts so far, the gap of a point closes as
//   g(t) = g_0 - b t - a t²/2;
// At its root the velocities change by Newton's and Coulomb's laws (impact_round.h). At the sub-step's end the bodies
// are where the changed velocities take them. Impacts are processed in rounds: those that come first for both of their
// bodies, then the neighbours that these push, and so on. A row of balls thus passes an impact on. Touching points
// without restitution are solved with the round that reaches them. With `simultaneous` all touching points are solved
// together, with any restitution (Moreau's law).
#pragma once

#include <vector>

#include "core/dynamics/contact/impulse/rebounds/impact_round.h"
#include "core/dynamics/kernels/contact_rows.h"
#include "core/dynamics/model/system.h"

namespace rigor::inline dynamics {

class Rebounds {
 public:
  // The number of impacts of one body within a sub-step; further ones have no rebound.
  static constexpr int kMostRounds = 200;

  Rebounds(const System& system, bool simultaneous);

  // For several simultaneous impacts.
  const char* law() const { return simultaneous_ ? "simultaneous (Moreau)" : "one after another"; }
  // The state before the integrator moves it.
  void begin(BodyColumns state);
  // `state` is that after the sub-step, `rows` are its rows with their gaps. Changes the state by the impacts, and the
  // biases of the rows whose bodies it has changed.
  void resolve(const std::vector<RowGroup>& groups, const SolverParameters& parameters, MutableBodyColumns state);

  struct RowImpulse {
    const double* row;  // its element of column 0
    Vec3 impulse;       // N s on body a, in W
  };
  // Of the last resolve().
  const std::vector<RowImpulse>& impulses() const { return impulses_; }

 private:
  struct Row {
    double* first;   // its column 0
    ImpactEnd a, b;  // without `angular`
    Vec3 normal;
    double hit;  // s, the instant at which it does; infinite if it does not
    double& at(int column) const { return first[static_cast<std::size_t>(column) * kRowsPerBlock]; }
    double get(int column) const { return at(column); }
    Vec3 get3(int column) const { return {get(column), get(column + 1), get(column + 2)}; }
  };

  bool moves(int body) const { return !system_.bodies[static_cast<std::size_t>(body)].fixed; }
  double along(const Row& row, const std::vector<BodyTwist>& motions) const {
    return row.normal.dot(relative_velocity(row.a, row.b, motions));
  }
  double closing_acceleration(const Row& row) const;
  double approach_at(const Row& row, double t) const;
  double gap_at(const Row& row, double t) const;
  double hit_of(const Row& row) const;
  void load(BodyColumns state, std::vector<BodyTwist>& out) const;
  void find_rows(const std::vector<RowGroup>& groups);
  Row row_of(const RowGroup& group, std::size_t point, std::size_t k) const;
  void find_hits(bool all);
  void choose();
  void add_resting();
  void add(const Row& row, double instant, double wanted, double wanted_without);
  void set_response(ImpactEnd& end, const Impact& impact) const;
  void commit_round();
  void move(MutableBodyColumns state);
  double share_without_gain(BodyColumns moved, const std::vector<Vec3>& momentum) const;
  void update_biases(const SolverParameters& parameters);

  const System& system_;
  bool simultaneous_;
  double h_ = 0, motion_time_ = 0, threshold_ = 0;  // s; s: the instant that velocities belong to; m/s
  double touching_ = 0;                             // m, see SolverParameters
  // By body.
  std::vector<BodyTwist> start_, free_, now_;  // before the sub-step; after it without impacts, and with those so far
  std::vector<BodyTwist> delay_;               // m, rad: the sum of each impact's change of motion times its instant
  std::vector<Vec3> angular_impulse_;          // kg m²/s
  std::vector<double> last_, next_;            // s, instants of a body's last impact and of its next one
  std::vector<char> is_changed_, is_new_;      // by an impact; by one of this round
  std::vector<Row> rows_;
  std::vector<Impact> impacts_;
  std::vector<const double*> rows_of_impacts_;
  std::vector<RowImpulse> impulses_;
  BodyColumns state_;  // that of resolve(), while it runs
};

}  // namespace rigor::inline dynamics
