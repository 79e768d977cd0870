#include "core/dynamics/model/loads/servo_drive.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {
namespace {

// Of `most`: a branch holds so far beyond its end, so that rounding does not switch it back and forth.
constexpr double kBranchOverlap = 1e-12;

}  // namespace

double ServoDrive::effort(double x, double rate, double t, double dt, std::optional<double> instant) const {
  double share = motor_.acts(t) ? 1 : 0;
  if (dt != 0) {
    const double first = std::max(motor_.from, std::min(t, t + dt)), last = std::min(motor_.until, std::max(t, t + dt));
    share = std::clamp((last - first) / std::abs(dt), 0.0, 1.0);
  }
  if (share == 0) return 0;
  if (servo().period > 0) return share * held_;
  if (!locates_events_) return share * servo().bounded(unbounded(x, rate, instant.value_or(t)));
  if (side_ != 0) return share * side_ * servo().most;
  return share * unbounded(x, rate, instant.value_or(t + dt / 2));
}

void ServoDrive::sample(double x, double rate, double t) {
  if (servo().period == 0) return;
  const double number = motor_.acts(t) ? motor_.sample_at(t) : -1;
  if (number == last_sample_) return;
  last_sample_ = number;
  held_ = number < 0 ? 0 : servo().bounded(unbounded(x, rate, t));
}

void ServoDrive::choose_branch(double x, double rate, double t) {
  if (servo().period > 0) return sample(x, rate, t);
  if (!motor_.acts(t)) {
    side_ = 0;
    return;
  }
  const double effort = unbounded(x, rate, t), overlap = kBranchOverlap * servo().most;
  if (side_ != 0 && side_ * effort > servo().most - overlap / 2) return;
  side_ = std::abs(effort) >= servo().most + overlap / 2 ? (effort > 0 ? 1 : -1) : 0;
}

ServoDrive::Distance ServoDrive::to_change(double x, double rate, double acceleration, double t) const {
  if (servo().period > 0 || std::isinf(servo().most) || !motor_.acts(t)) return {};
  const double effort = unbounded(x, rate, t), overlap = kBranchOverlap * servo().most,
               change = servo().kp * (servo().target.rate(t) - rate) - servo().kd * acceleration;
  const double side = side_ != 0 ? -side_ : effort > 0 ? 1 : -1;
  return {side * effort + (side_ != 0 ? servo().most : -servo().most) - overlap, side * change};
}

double ServoDrive::next_sample(double t, double end) const {
  return servo().period == 0 ? end : motor_.next_switch(t, end);
}

}  // namespace rigor::inline dynamics
