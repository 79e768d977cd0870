// The drift of semi-implicit Euler if all joints are ball joints or hinges. Several joints are solved at once in the
// lanes of the kernels. The equations are those of Joints::close(), with 3 x 3 blocks whose inverses are kept,
//   J V1 + h/2 J' V1 + g/h = 0 at the start, then by the factor of the start until g = 0 at the end (SHAKE).
// A ball joint is one pin, which holds two points together. A hinge is two pins on its axis; the second leaves the
// direction along the axis free. If the joints form trees, each body is then moved to its joint from the root to the
// leaves. Only the rounding of positions then remains of a gap.
#pragma once

#include <vector>

#include "core/dynamics/joints/elimination_order.h"
#include "core/dynamics/kernels/ball_kernels.h"
#include "core/dynamics/model/system.h"

namespace rigor::inline dynamics {

class BallJoints {
 public:
  // Whether all joints are ball joints, or hinges without limits or motors of given speed, and each pair of bodies has
  // at most one joint.
  static bool are_all_of(const Scene& scene);

  // The system must outlive it. Gaps are closed to `within` of `size` [m], and so far apart are a hinge's two pins.
  BallJoints(const Scene& scene, const System& system, double size, double within);

  // Takes a state whose velocities have been kicked over a drift of h, turning by `turn`. False, and the state as it
  // was, if there seems to be no such impulse, or the joints are near a singular position.
  bool drift(MutableBodyColumns state, double h, Turn turn);

 private:
  // The last one is that of the world.
  using Records = AlignedDoubles;
  struct Pin {  // at t = 0
    int a, b;
    Vec3 point, axis = Vec3::Zero();  // m; along which it is free
    bool closes = true;               // not a hinge's second
  };
  struct PinEnd {
    std::int32_t arm, axis;  // where they stand in by_pin_
    bool is_b;
  };
  struct Closing {  // a pin, and the end that stays, the end that is moved
    std::size_t row;
    int stays, moves;
    double sign;  // of the pin's reach
  };
  struct Couplings {
    explicit Couplings(std::size_t couplings = 0, std::size_t world = 0);
    void set(std::size_t u, std::int32_t of_body, const PinEnd& row, const PinEnd& column);
    BallCouplings rows();
    std::size_t size;
    AlignedDoubles blocks;
    std::vector<std::int32_t> body, row_arm, column_arm, row_axis, column_axis;
  };
  BallJoints(const Scene& scene, const System& system, const std::vector<Pin>& pins, double within);
  static std::vector<Pin> pins_of(const Scene& scene, double apart);
  static std::vector<std::pair<int, int>> coupled(const std::vector<Pin>& pins, const Scene& scene);
  void set_rows(const Scene& scene, const std::vector<Pin>& pins);
  void list_couplings(const Scene& scene);
  void list_closings(const Scene& scene, const std::vector<Pin>& pins);
  BallRows rows();
  double* row(std::size_t p) { return by_pin_.data() + start_of_row(p, kBallColumns); }
  double* block_at(std::int32_t u) { return first_.blocks.data() + start_of_row(u, kCouplingColumns) + 8 * kBlock; }
  void add_other_couplings();
  bool factorise();
  Mat3 block(std::int32_t coupling);
  void subtract(const Mat3& F, const Mat3& B, std::int32_t target);
  void solve();
  void add_impulses();
  void close(MutableBodyColumns state) const;

  const System& system_;
  double within_;      // m
  std::size_t world_;  // its record
  EliminationOrder order_;
  std::vector<std::int32_t> a_, b_;
  AlignedDoubles by_pin_;
  Couplings first_, other_;           // of two pins by the first body that both are on, and by the other
  std::vector<std::int32_t> add_to_;  // of the first: by other coupling
  bool has_axes_ = false;
  Records poses_, velocities_, impulses_, inverse_inertias_;
  std::vector<Mat3> factor_;       // of each coupling: its block times the inverse of its column's
  std::vector<Mat3> inverse_;      // of each pin's block, once the others are eliminated
  std::vector<Vec3> solution_;     // N s, by pin in the order of elimination
  std::vector<Closing> closings_;  // empty where joints make loops
  BodyTable end_;
};

}  // namespace rigor::inline dynamics
