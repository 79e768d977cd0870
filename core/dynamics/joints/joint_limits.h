// The limits of hinges and sliders as unilateral constraints g >= 0, for contact methods. g = x - lower, or upper - x,
// with the row of g' in the velocities of the joint's two bodies. A hinge's angle counts whole turns from the last
// noted state.
#pragma once

#include <vector>

#include "core/dynamics/model/joint_coordinate.h"

namespace rigor::inline dynamics {

// An upper bound of x within h, if its path between two instants bends in one direction: the intersection of the
// tangents at both ends. Returns minus infinity unless x first rises and then returns.
double peak_between(double x, double rate, double end_x, double end_rate, double h);

class JointLimits {
 public:
  explicit JointLimits(const Scene& scene);

  std::size_t size() const { return limits_.size(); }
  int a(std::size_t k) const { return limits_[k].coordinate.b(); }  // the body that g grows with, or the world
  int b(std::size_t k) const { return limits_[k].coordinate.a(); }
  double restitution(std::size_t k) const { return limits_[k].restitution; }

  struct Value {
    // rad or m; its rate; the part of the rate's derivative that does not depend on accelerations
    double gap = 0, rate = 0, bias = 0;
    // Unit, in W: a's velocity along it, of turning if it is a hinge's, less b's, is the rate. A slider's is that at
    // arms from the centres of mass [m, in W].
    Vec3 direction = Vec3::Zero(), arm_a = Vec3::Zero(), arm_b = Vec3::Zero();
    bool is_of_turning = false;
  };
  // At a state `since` [s] after the noted one.
  Value at(std::size_t k, BodyColumns state, double since = 0) const;
  void note(BodyColumns state, double since);  // the same

  template <typename Archive>
  void archive_state(Archive& archive) {
    archive.each(limits_, [&](Limit& limit) { archive(limit.x, limit.rate); });
  }

 private:
  struct Limit {
    JointCoordinate coordinate;
    double bound;  // rad, m
    int side;      // 1: lower, -1: upper
    double restitution;
    double x = 0, rate = 0;  // as noted
    double with_turns(const JointCoordinate::Value& at, double since) const;
  };
  std::vector<Limit> limits_;
};

}  // namespace rigor::inline dynamics
