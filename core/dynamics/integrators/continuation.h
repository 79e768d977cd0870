// Whether a step goes on where the last one ended: what a multistep method asks before it uses what it remembers.
#pragma once

#include "core/dynamics/model/loads.h"
#include "core/engine/body_table.h"

namespace rigor {

class Continuation {
 public:
  explicit Continuation(std::size_t bodies) : end_(bodies) {}

  // `state` and t are where the last step, of the same dt, ended, and no timed force has begun or ended since `oldest`,
  // nor will in the step to t + dt.
  bool goes_on(BodyColumns state, double t, double dt, const Loads& loads, double oldest) const;
  // Nothing is remembered before the first call.
  void ended(BodyColumns state, double t, double dt) { end_ = state, t_ = t, dt_ = dt; }

 private:
  BodyTable end_;
  double t_ = 0, dt_ = 0;
};

}  // namespace rigor
