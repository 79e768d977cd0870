#include "cases/truth/closed_form/phased_motion.h"

#include <algorithm>

namespace rigor::inline truth {
namespace {

// m and rad that the terms of a phase can add up to within `elapsed`.
double reach(const Phase& phase, Extended elapsed) {
  const ExtendedState& s = phase.start;
  return static_cast<double>(s.position.norm() + elapsed * (s.velocity.norm() + s.angular_velocity.norm()) +
                             elapsed * elapsed / 2 * (phase.acceleration.norm() + phase.angular_acceleration.norm()));
}

}  // namespace

ExtendedState Phase::at(Extended t) const {
  const Extended elapsed = t - from;
  const ExtendedVec3 angle = elapsed * start.angular_velocity + elapsed * elapsed / 2 * angular_acceleration;
  return {start.position + elapsed * start.velocity + elapsed * elapsed / 2 * acceleration,
          turn(angle) * start.orientation, start.velocity + elapsed * acceleration,
          start.angular_velocity + elapsed * angular_acceleration};
}

PhasedMotion::PhasedMotion(std::vector<Phase> phases, double start_error)
    : phases_(std::move(phases)), start_error_(start_error) {
  double farthest = 0;
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    if (i > 0) farthest = std::max(farthest, reach(phases_[i - 1], phases_[i].from - phases_[i - 1].from));
    farthest_.push_back(farthest);
  }
}

std::size_t PhasedMotion::index_at(Extended t) const {
  const auto later = std::upper_bound(phases_.begin(), phases_.end(), t,
                                      [](Extended time, const Phase& phase) { return time < phase.from; });
  return later == phases_.begin() ? 0 : static_cast<std::size_t>(later - phases_.begin()) - 1;
}

// The rounding of the result to double; each phase adds a few roundings of its start in extended precision.
double PhasedMotion::error(double t) const {
  const std::size_t index = index_at(t);
  const double farthest = std::max(farthest_[index], reach(phases_[index], t - phases_[index].from));
  constexpr double kRoundingsOfPhase = 16;
  const double passed = kRoundingsOfPhase * static_cast<double>(index + 1) * kExtendedEpsilon;
  return start_error_ + (kEpsilon + passed) * farthest;
}

std::vector<ExtendedVec3> PhasedMotion::way(Extended duration) const {
  std::vector<ExtendedVec3> points;
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    const Phase& phase = phases_[i];
    if (phase.from > duration) break;
    points.push_back(phase.start.position);
    const Extended end = i + 1 < phases_.size() ? std::min(duration, phases_[i + 1].from) : duration;
    const Extended square = phase.acceleration.squaredNorm();
    if (square == 0) continue;
    const Extended turns = phase.from - phase.start.velocity.dot(phase.acceleration) / square;
    if (turns > phase.from && turns < end) points.push_back(phase.at(turns).position);
  }
  points.push_back(at(duration).position);
  return points;
}

}  // namespace rigor::inline truth
