// A world's time. Equal steps give n * dt, not a sum with n roundings, so that t after 300 steps of 1/30 s is 10 s.
#pragma once

#include <cstdint>

namespace rigor::inline engine {

class Clock {
 public:
  double time() const { return base_ + static_cast<double>(steps_) * dt_; }  // s
  void advance(double dt) {
    if (dt != dt_) base_ = time(), steps_ = 0, dt_ = dt;
    ++steps_;
  }

 private:
  double base_ = 0, dt_ = 0;
  std::int64_t steps_ = 0;
};

}  // namespace rigor::inline engine
