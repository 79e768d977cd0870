// Velocity-level contact for many points, in small sub-steps of length h (Macklin et al., Small steps in physics
// simulation, 2019; Catto, Solver2D, 2024). In each, bodies first move freely; then two passes take the points in turn,
//   p_n <- max(0, p_n - (u_n + bias) / k_n),   p_t <- onto the disc of radius mu p_n (p_t - u_t / k_t),
// starting from the impulses of the sub-step before. In the first pass a point that is apart may close its gap within
// h, and one that overlaps is pushed out as by a damped spring, stiff for h; positions follow this pass. The second
// has no bias, so that what pushed bodies out leaves them no speed. Then points that came together faster than gravity
// can have brought them within a few h get their restitution.
// Pairs of bodies that share none that moves are taken several at once (kernels/pile.h), with the same result as one by
// one in their order.
#pragma once

#include <vector>

#include "core/dynamics/contact/impulse/manifolds.h"
#include "core/dynamics/model/system.h"

namespace rigor {

class PileSolver {
 public:
  // `share`: of h for which the velocity after a sub-step counts in its way: 1 for a semi-implicit method, 1/2 for one
  // that takes the mean of the velocities before and after.
  PileSolver(const System& system, double share);

  // For a stretch of sub-steps h over these points, which take the impulses with them when it ends.
  void begin_stretch(BodyColumns state, std::vector<PilePoint>& points, double h);
  void begin_sub_step(BodyColumns state);
  void first_pass(MutableBodyColumns state);
  void second_pass(MutableBodyColumns state);
  void end_stretch();

 private:
  struct Pair {
    std::size_t first, points;    // among the points
    std::size_t level, of_level;  // its place among the pairs of that level
  };
  void set_law(double h);
  void sort_pairs_in_levels();
  void place_points();
  void fill_row(const PilePoint& point, std::size_t row, double scale);
  PileRecords records() { return {motions_.data(), changes_.data(), stirred_.data(), inertias_.data()}; }

  const System& system_;
  PileLaw law_{};
  AlignedDoubles motions_, changes_, inertias_;  // see PileRecords
  std::vector<std::int32_t> stirred_;
  std::int32_t nobody_;  // the first record that means nothing
  Columns start_;        // the state's poses at the stretch's start
  std::vector<PilePoint>* points_ = nullptr;
  std::vector<Pair> pairs_;
  std::vector<std::size_t> next_level_, pairs_of_level_;  // by body; then where a level's groups of eight begin
  std::vector<std::size_t> first_block_, row_of_point_;   // of eight pairs; of a point
  std::vector<RowBlock> blocks_;
  std::vector<std::int32_t> hits_;  // rows whose points may meet in this sub-step, faster than gravity brings them
  std::size_t hit_count_ = 0;
  bool any_rebound_ = false;
};

}  // namespace rigor
