#include "cases/truth/closed_form/joint/pendulum_phase.h"

#include <algorithm>
#include <cmath>

#include "cases/truth/closed_form/smooth/jacobi_elliptic.h"

namespace rigor::inline truth {

PendulumPhase::PendulumPhase(Extended angle, Extended rate, Extended square)
    : w0_(std::sqrt(square)),
      rate_(rate),
      sense_(rate < 0 ? -1 : 1),
      sine_(std::sin(angle / 2)),
      cosine_(std::cos(angle / 2)) {
  if (square == 0) return;
  const Extended h = std::abs(rate) / (2 * w0_), c = std::abs(cosine_);
  k_ = std::hypot(sine_, h);
  // k'² = (c - h) (c + h), or as much over k², without the cancellation of 1 - k².
  const Extended excess = (c - h) * (c + h);
  if (excess != 0) unsure_ = 8 * std::numeric_limits<Extended>::epsilon() * (c + h) / std::abs(c - h);
  const bool swings = excess > 0;
  complement_ = std::min<Extended>(1, std::sqrt(std::abs(excess)) / (swings ? 1 : k_));
  speed_ = swings ? w0_ : k_ * w0_;
  start_ = swings ? jacobi_argument(sense_ * sine_, h, complement_) : jacobi_argument(sense_ * sine_, c, complement_);
}

PendulumPhase::HalfTurn PendulumPhase::half_angle_at(Extended t) const {
  const Extended u = start_ + speed_ * t;
  const Extended reduced = complement_ == 0 ? u : std::remainder(u, 4 * quarter_period(complement_));
  const JacobiElliptic at = jacobi_elliptic(reduced, complement_);
  if (k_ < 1) return {sense_ * k_ * at.sn, at.dn, sense_ * 2 * k_ * w0_ * at.cn};
  return {sense_ * at.sn, at.cn, sense_ * 2 * k_ * w0_ * at.dn};
}

PendulumPhase::HalfTurn PendulumPhase::at(Extended t) const {
  if (w0_ == 0) return {std::sin(rate_ * t / 2), std::cos(rate_ * t / 2), rate_};
  const HalfTurn now = half_angle_at(t);
  return {now.sine * cosine_ - now.cosine * sine_, now.cosine * cosine_ + now.sine * sine_, now.rate};
}

// A phase off by d is an angle off by at most 2 k d; each quarter period is as uncertain as the complement.
double PendulumPhase::error(double t) const {
  if (w0_ == 0) return 4 * kExtendedEpsilon * static_cast<double>(std::abs(rate_)) * t;
  const double phase = static_cast<double>(std::abs(start_) + speed_ * t);
  const double off = 8 * kExtendedEpsilon * phase + static_cast<double>(unsure_) * (1 + phase);
  return 2 * std::max(1.0, static_cast<double>(k_)) * off;
}

}  // namespace rigor::inline truth
