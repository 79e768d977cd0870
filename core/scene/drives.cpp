#include "core/scene/drives.h"

#include <algorithm>
#include <numbers>

namespace rigor::inline scene {
namespace {

// The piece of a table in which t lies: its first row, or -1 before all.
std::ptrdiff_t piece_at(const TimeTable& table, double t) {
  return std::upper_bound(table.times.begin(), table.times.end(), t) - table.times.begin() - 1;
}

// Takes `end` to `instant` if that comes first on the way from t.
void come_first(double instant, double t, double& end) {
  if ((instant - t) * (end - instant) > 0) end = instant;
}

}  // namespace

double TimeTable::at(double t) const {
  const std::ptrdiff_t i = piece_at(*this, t);
  if (i < 0) return values.front();
  const auto k = static_cast<std::size_t>(i);
  if (!is_linear || k + 1 == times.size()) return values[k];
  const double share = (t - times[k]) / (times[k + 1] - times[k]);
  return values[k] + share * (values[k + 1] - values[k]);
}

double TimeTable::rate(double t) const {
  const std::ptrdiff_t i = piece_at(*this, t);
  if (!is_linear || i < 0 || static_cast<std::size_t>(i) + 1 == times.size()) return 0;
  const auto k = static_cast<std::size_t>(i);
  return (values[k + 1] - values[k]) / (times[k + 1] - times[k]);
}

// Each piece is linear, so its mean is the value at its middle.
double TimeTable::mean(double from, double to) const {
  if (from == to) return at(from);
  if (to < from) std::swap(from, to);
  double sum = 0;
  for (double t = from; t < to;) {
    const double next = next_time(t, to);
    sum += (next - t) * at(t + (next - t) / 2);
    t = next;
  }
  return sum / (to - from);
}

double TimeTable::next_time(double t, double end) const {
  if (end >= t) {
    const auto next = std::upper_bound(times.begin(), times.end(), t);
    return next != times.end() && *next < end ? *next : end;
  }
  const auto next = std::lower_bound(times.begin(), times.end(), t);
  return next != times.begin() && *std::prev(next) > end ? *std::prev(next) : end;
}

double Servo::unbounded(double x, double rate, double t, bool turns) const {
  double error = target.at(t) - x;
  if (turns) error = std::remainder(error, 2 * std::numbers::pi);
  return kp * error + kd * (target_speed - rate);
}

bool Motor::drives(int other) const {
  return joint == other ||
         std::any_of(plus.begin(), plus.end(), [&](const JointTerm& term) { return term.joint == other; });
}

double Motor::mean_effort(double t, double dt, std::optional<double> instant) const {
  if (dt == 0) return !acts(t) ? 0 : efforts ? efforts->at(t) : effort;
  const double first = std::max(from, std::min(t, t + dt)), last = std::min(until, std::max(t, t + dt));
  if (!(first < last)) return 0;
  // A whole step must give the effort itself, without the rounding of the quotient.
  const double share = std::clamp((last - first) / std::abs(dt), 0.0, 1.0);
  if (!efforts) return share * effort;
  return share * (instant ? efforts->extended((first + last) / 2, *instant) : efforts->mean(first, last));
}

double Motor::next_switch(double t, double end) const {
  come_first(from, t, end), come_first(until, t, end);
  if (efforts) end = efforts->next_time(t, end);
  if (!servo) return end;
  end = servo->target.next_time(t, end);
  if (servo->period == 0) return end;
  if (end > t) {
    if (t >= from && t < until) come_first(from + (sample_at(t) + 1) * servo->period, t, end);
  } else if (t > from) {
    come_first(from + (std::ceil((t - from) / servo->period - 1e-9) - 1) * servo->period, t, end);
  }
  return end;
}

}  // namespace rigor::inline scene
