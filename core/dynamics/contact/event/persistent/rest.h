// Recognises a scene that rests, for the method `event`: a step left its state as it was, because nothing moves and all
// forces balance. While no load changes, each later step does the same.
#pragma once

#include "core/engine/body_table.h"

namespace rigor::inline dynamics {

class Rest {
 public:
  // Of a step from t to t + dt [s].
  bool goes_on(BodyColumns state, double t, double dt) const;
  void begin_step(BodyColumns state) { state_ = state, forget(); }
  // Where a step from t ended at rest, with loads that stay until `until` [s].
  void end_step(BodyColumns state, double t, double until);
  // Where the points of contact are no longer those of the last step.
  void forget() { until_ = -1; }

 private:
  bool is_same(BodyColumns state) const;

  BodyTable state_;
  double from_ = 0, until_ = -1;  // s; until_ < from_: no rest
};

}  // namespace rigor::inline dynamics
