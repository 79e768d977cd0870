// Whether a step continues the last one. A multistep method checks this before it uses its history.
#pragma once

#include "core/dynamics/model/loads/loads.h"
#include "core/engine/body_table.h"

namespace rigor::inline dynamics {

class Continuation {
 public:
  explicit Continuation(std::size_t bodies) : end_(bodies) {}

  // Returns true if the last step, with the same dt, ended at `state` and t, and no timed force begins or ends between
  // `oldest` and t + dt.
  bool goes_on(BodyColumns state, double t, double dt, const Loads& loads, double oldest) const;
  // Nothing is remembered before the first call.
  void ended(BodyColumns state, double t, double dt) { end_ = state, t_ = t, dt_ = dt; }
  template <typename Archive>
  void archive_state(Archive& archive) {
    archive(end_, t_, dt_);
  }

 private:
  BodyTable end_;
  double t_ = 0, dt_ = 0;
};

}  // namespace rigor::inline dynamics
