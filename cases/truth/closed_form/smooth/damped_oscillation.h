// The damped oscillation s'' = -2 decay s' - w0² s about s = 0, in closed form. With w² = |w0² - decay²|,
//   s  = e^(-decay t) (s0 C + (v0 + decay s0) S),   s' = e^(-decay t) (v0 C - (decay v0 + w0² s0) S),
// C and S depend on the damping: cos wt and sin wt / w if underdamped, 1 and t if critically damped, cosh wt and sinh
// wt / w if overdamped (Landau and Lifshitz, Mechanics, 3rd ed., sections 21 and 25).
#pragma once

#include <vector>

#include "cases/truth/closed_form/closed_form.h"

namespace rigor::inline truth {

struct DampedOscillation {
  Extended decay = 0, square = 0;    // 1/s; w0² in 1/s²
  Extended start = 0, velocity = 0;  // m and m/s at t = 0

  struct Along {
    Extended offset;    // m, s
    Extended velocity;  // m/s
  };
  Along at(Extended t) const;

  // The first instants at which it turns round: where C / S is (decay v0 + w0² s0) / v0. Later turns are less wide.
  std::vector<Extended> turns() const;

  Extended swing() const;            // m, the farthest it can be from s = 0
  Extended error(Extended t) const;  // m, in extended precision
};

}  // namespace rigor::inline truth
