// The drift of semi-implicit Euler with joints that are all ball joints, several of them at once in the lanes of the
// kernels: the same equations as Joints::close() solves, with 3 x 3 blocks whose inverses are kept,
//   J V1 + h/2 J' V1 + g/h = 0 at the start, then by the factor of the start until g = 0 at the end (SHAKE).
// Where the joints make trees, each body is then moved to its joint, from the root to the leaves, which leaves of a gap
// nothing but the rounding of positions.
#pragma once

#include <vector>

#include "core/dynamics/joints/elimination_order.h"
#include "core/dynamics/kernels/ball_kernels.h"
#include "core/dynamics/model/system.h"

namespace rigor {

class BallJoints {
 public:
  // Whether all joints are ball joints and no two hold the same two bodies.
  static bool are_all_of(const Scene& scene);

  // The system must outlive it. Gaps are closed to `within` [m].
  BallJoints(const Scene& scene, const System& system, double within);

  // Takes a state whose velocities have been kicked over a drift of h, turning by `turn`. False, and the state as it
  // was, if there seems to be no such impulse, or the joints are near a singular position.
  bool drift(MutableBodyColumns state, double h, Turn turn);

 private:
  // The last one is that of the world.
  using Records = AlignedDoubles;
  struct Closing {  // a joint, and the end that stays, the end that is moved
    std::size_t row;
    int stays, moves;
    double sign;  // of the joint's reach
  };
  void list_couplings(const Scene& scene);
  void list_closings(const Scene& scene);
  BallRows rows();
  double* row(std::size_t p) { return by_joint_.data() + start_of_row(p, kBallColumns); }
  bool factorise();
  Mat3 block(std::int32_t coupling) const;
  void subtract(const Mat3& F, const Mat3& B, std::int32_t target);
  void solve();
  void add_impulses();
  void close(MutableBodyColumns state) const;

  const System& system_;
  double within_;
  EliminationOrder order_;
  std::size_t world_;  // its record
  std::vector<std::int32_t> a_, b_, body_, row_arm_, column_arm_;
  AlignedDoubles by_joint_, by_coupling_;
  Records poses_, velocities_, impulses_, inverse_inertias_;
  std::vector<Mat3> factor_;       // of each coupling: its block times the inverse of its column's
  std::vector<Mat3> inverse_;      // of each joint's block, once the others are eliminated
  std::vector<Vec3> solution_;     // N s, by joint in the order of elimination
  std::vector<Closing> closings_;  // empty where joints make loops
  BodyTable end_;
};

}  // namespace rigor
