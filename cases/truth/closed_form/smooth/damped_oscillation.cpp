#include "cases/truth/closed_form/smooth/damped_oscillation.h"

#include <cmath>

namespace rigor::inline truth {
namespace {

struct Waves {
  Extended C, S;  // times e^(-decay t)
};

Waves waves(Extended decay, Extended square, Extended t) {
  const Extended difference = square - decay * decay, w = std::sqrt(std::abs(difference));
  if (difference == 0) return {std::exp(-decay * t), t * std::exp(-decay * t)};
  if (difference > 0) return {std::exp(-decay * t) * std::cos(w * t), std::exp(-decay * t) * std::sin(w * t) / w};
  // The slow decay, decay - w, without its cancellation.
  const Extended slow = std::exp(-square / (decay + w) * t);
  return {slow * (1 + std::exp(-2 * w * t)) / 2, -slow * std::expm1(-2 * w * t) / (2 * w)};
}

}  // namespace

DampedOscillation::Along DampedOscillation::at(Extended t) const {
  const Waves now = waves(decay, square, t);
  return {start * now.C + (velocity + decay * start) * now.S,
          velocity * now.C - (decay * velocity + square * start) * now.S};
}

std::vector<Extended> DampedOscillation::turns() const {
  const Extended difference = square - decay * decay, w = std::sqrt(std::abs(difference));
  const Extended pull = decay * velocity + square * start;
  if (difference == 0) return {velocity / pull};
  if (difference < 0) return {std::atanh(velocity * w / pull) / w};
  const Extended first = std::atan2(velocity * w, pull) / w, half_period = std::acos(-1.0L) / w;
  return {first, first + half_period, first + 2 * half_period};
}

Extended DampedOscillation::swing() const {
  return (std::abs(velocity) + (decay + std::sqrt(square)) * std::abs(start)) / std::sqrt(square);
}

Extended DampedOscillation::error(Extended t) const {
  return 8 * std::numeric_limits<Extended>::epsilon() * (std::sqrt(square) + decay) * t * swing();
}

}  // namespace rigor::inline truth
