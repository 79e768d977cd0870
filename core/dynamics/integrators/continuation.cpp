#include "core/dynamics/integrators/continuation.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {

bool Continuation::goes_on(BodyColumns state, double t, double dt, const Loads& loads, double oldest) const {
  constexpr double kRounding = 1e-9;  // of a clock that does not add up its steps, in dt
  if (dt != dt_ || std::abs(t - t_) > kRounding * dt) return false;
  if (loads.next_switch(oldest, t + dt) < t + dt) return false;
  for (int c = 0; c < kRotation; ++c) {
    if (!std::equal(state.column(c), state.column(c) + state.size(), end_.columns().column(c))) return false;
  }
  return true;
}

}  // namespace rigor::inline dynamics
