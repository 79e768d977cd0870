// A motion in phases of constant acceleration, one after another: what a body does between the instants at which it
// begins or stops to slip, hits or comes to rest. In each phase the angular acceleration lies along the angular
// velocity (or one of them is zero), so that the angle turned is w t + a t²/2 about one axis.
#pragma once

#include <vector>

#include "cases/truth/closed_form/closed_form.h"

namespace rigor {

struct Phase {
  Extended from;  // s
  ExtendedState start;
  ExtendedVec3 acceleration = ExtendedVec3::Zero();          // m/s², in W
  ExtendedVec3 angular_acceleration = ExtendedVec3::Zero();  // rad/s², in W

  ExtendedState at(Extended t) const;
};

class PhasedMotion final : public BodyMotion {
 public:
  // `start_error` [m]: by how much the scene misses what the motion takes for granted (two bodies touch, say).
  PhasedMotion(std::vector<Phase> phases, double start_error);

  ExtendedState at(Extended t) const override { return phases_[index_at(t)].at(t); }
  double error(double t) const override;
  // Where the motion starts, changes its phase, turns back, and is at `duration`: between two of these it goes one way.
  std::vector<ExtendedVec3> way(Extended duration) const;

 private:
  std::size_t index_at(Extended t) const;

  std::vector<Phase> phases_;     // the first from 0 on
  std::vector<double> farthest_;  // of each phase: m and rad, that the terms of all before it can add up to
  double start_error_;
};

}  // namespace rigor
