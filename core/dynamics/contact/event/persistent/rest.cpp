#include "core/dynamics/contact/event/persistent/rest.h"

#include <algorithm>

namespace rigor::inline dynamics {

bool Rest::goes_on(BodyColumns state, double t, double dt) const {
  return from_ <= t && t + dt <= until_ && is_same(state);
}

void Rest::end_step(BodyColumns state, double t, double until) {
  if (is_same(state)) from_ = t, until_ = until;
}

bool Rest::is_same(BodyColumns state) const {
  const BodyColumns mine = state_.columns();
  if (mine.size() != state.size() || mine.has_rotation() != state.has_rotation()) return false;
  const int columns = state.has_rotation() ? kRotation + 9 : kRotation;
  for (int c = 0; c < columns; ++c)
    if (!std::equal(mine.column(c), mine.column(c) + mine.size(), state.column(c))) return false;
  return true;
}

}  // namespace rigor::inline dynamics
