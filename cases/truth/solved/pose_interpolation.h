// The motion of a body between two of its states: Hermite's cubics of its position and of the rotation vector from the
// first. A path whose position and rotation vector are cubics of time is met exactly; of another it misses h⁴/384 of
// the fourth derivative.
#pragma once

#include "core/engine/body_table.h"

namespace rigor::inline truth {

// At the share s, in [0, 1], of the time h [s] between them; it turns by less than half a turn.
BodyState between(const BodyState& from, const BodyState& to, double h, double s);

}  // namespace rigor::inline truth
