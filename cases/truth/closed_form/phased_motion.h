// A motion in successive phases of constant acceleration. A phase ends where the body begins or stops to slip, hits
// something or comes to rest. In each phase the angular acceleration is parallel to the angular velocity, or one of
// them is zero. The angle is then w t + a t²/2 about one axis.
#pragma once

#include <vector>

#include "cases/truth/closed_form/closed_form.h"

namespace rigor::inline truth {

struct Phase {
  Extended from;  // s
  ExtendedState start;
  ExtendedVec3 acceleration = ExtendedVec3::Zero();          // m/s², in W
  ExtendedVec3 angular_acceleration = ExtendedVec3::Zero();  // rad/s², in W

  ExtendedState at(Extended t) const;
};

class PhasedMotion final : public BodyMotion {
 public:
  // `start_error` [m]: the deviation of the scene from the assumptions of the motion, for example a gap between two
  // touching bodies.
  PhasedMotion(std::vector<Phase> phases, double start_error);

  ExtendedState at(Extended t) const override { return phases_[index_at(t)].at(t); }
  double error(double t) const override;
  // The instants of the start, of phase changes, of reversals, and of `duration`. Between two of these the motion is
  // monotonic.
  std::vector<ExtendedVec3> way(Extended duration) const;

 private:
  std::size_t index_at(Extended t) const;

  std::vector<Phase> phases_;     // the first from 0 on
  std::vector<double> farthest_;  // of each phase: m and rad, that the terms of all before it can add up to
  double start_error_;
};

}  // namespace rigor::inline truth
