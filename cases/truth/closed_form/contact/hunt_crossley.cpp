// In contact x'' = g - (k/m) x (1 + d x'), Hunt and Crossley, Coefficient of Restitution Interpreted as Damping in
// Vibroimpact, J. Appl. Mech. 42 (1975). At x' = -1/d the acceleration is g > 0, so the rate never falls to it: the
// force keeps its sign until the overlap is gone. The overlap is a power series in time over each short piece, by the
// recurrence of its coefficients:
//   u_n = (n + 1) x_{n+1},  (n + 1) u_{n+1} = g [n = 0] - (k/m) (x_n + d sum_j x_j u_{n-j}).
// A flight is a piece with three coefficients. Without gravity d v - ln(1 + d v) is the same before and after a bounce,
// which the tests check.
#include "cases/truth/closed_form/contact/hunt_crossley.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace rigor::inline truth {
namespace {

constexpr std::size_t kTerms = 24;
using PowerSeries =
    std::array<Extended, kTerms + 1>;  // of the overlap [m], in powers of the time since the piece began

Extended value_of(const PowerSeries& x, Extended t) {
  Extended sum = 0;
  for (std::size_t n = kTerms + 1; n-- > 0;) sum = sum * t + x[n];
  return sum;
}
Extended rate_of(const PowerSeries& x, Extended t) {
  Extended sum = 0;
  for (std::size_t n = kTerms; n > 0; --n) sum = sum * t + static_cast<Extended>(n) * x[n];
  return sum;
}

struct SeriesPiece {
  Extended from;  // s
  PowerSeries x;
};

class HuntCrossleyBounce final : public BodyMotion {
 public:
  HuntCrossleyBounce(const Body& body, const Ground& ground, Extended stiffness, Extended dissipation,
                     Extended duration)
      : body_(body),
        up_(ground.normal()),
        gravity_(ground.pressing()),
        spring_(stiffness / body.mass),
        dissipation_(dissipation),
        depth_(-ground.gap_under(body)) {
    if (depth_ > 0) ground.refuse(body, "starts inside the plane");
    Extended x = depth_, v = -up_.dot(extended(body.velocity)), t = 0;
    for (bool touches = false; t < duration; touches = !touches) {
      t = touches ? add_contact(t, x, v, duration) : add_flight(t, x, v);
      if (pieces_.size() > kMostPieces) ground.refuse(body, "bounces too often");
      x = 0, v = rate_of(pieces_.back().x, t - pieces_.back().from);
    }
  }

  ExtendedState at(Extended t) const override {
    const auto later = std::upper_bound(pieces_.begin(), pieces_.end(), t,
                                        [](Extended time, const SeriesPiece& piece) { return time < piece.from; });
    const SeriesPiece& piece = later == pieces_.begin() ? *later : *(later - 1);
    const Extended in = t - piece.from;
    return {extended(body_.position) - (value_of(piece.x, in) - depth_) * up_, extended(body_.orientation),
            -rate_of(piece.x, in) * up_, ExtendedVec3::Zero()};
  }

  // The rounding of the place to double, and that of each piece in extended precision. A bounce turns an error of its
  // time into one of the place of up to the largest speed times it.
  double error(double t) const override {
    const Extended fall = std::abs(depth_) + gravity_ * t * t / 2 + std::abs(pieces_.front().x[1]) * t;
    return kEpsilon * (body_.position.norm() + static_cast<double>(fall)) +
           64 * kExtendedEpsilon * static_cast<double>(pieces_.size()) *
               static_cast<double>((1 + std::sqrt(spring_) * t) * fall);
  }

 private:
  static constexpr std::size_t kMostPieces = 200000;

  // Returns when the ball comes to the plane.
  Extended add_flight(Extended from, Extended x, Extended v) {
    PowerSeries series{};
    series[0] = x, series[1] = v, series[2] = gravity_ / 2;
    pieces_.push_back({from, series});
    return from + (-v + std::sqrt(v * v - 2 * gravity_ * x)) / gravity_;
  }

  // Returns when the overlap is gone, or `end` if it is not by then.
  Extended add_contact(Extended from, Extended x, Extended v, Extended end) {
    while (from < end && pieces_.size() <= kMostPieces) {
      const PowerSeries& series = pieces_.emplace_back(SeriesPiece{from, series_at(x, v)}).x;
      const Extended length = std::min(length_of(series), end - from);
      if (value_of(series, length) < 0) return from + zero_of(series, length);
      x = value_of(series, length), v = rate_of(series, length), from += length;
    }
    return end;
  }

  PowerSeries series_at(Extended x, Extended v) const {
    PowerSeries series{};
    std::array<Extended, kTerms + 1> u{};
    series[0] = x, u[0] = v;
    for (std::size_t n = 0; n < kTerms; ++n) {
      const Extended next = static_cast<Extended>(n + 1);
      Extended product = 0;  // of overlap and rate
      for (std::size_t j = 0; j <= n; ++j) product += series[j] * u[n - j];
      series[n + 1] = u[n] / next;
      u[n + 1] = ((n == 0 ? gravity_ : 0) - spring_ * (series[n] + dissipation_ * product)) / next;
    }
    return series;
  }

  // s, after which the terms left out are below the rounding of the overlap's scale: half of where the last terms are.
  Extended length_of(const PowerSeries& series) const {
    const Extended scale = std::abs(series[0]) + std::abs(series[1]) / std::sqrt(spring_);
    Extended length = 1 / std::sqrt(spring_);
    for (const std::size_t n : {kTerms - 1, kTerms}) {
      if (series[n] == 0) continue;
      const Extended ratio = kExtendedEpsilon * scale / std::abs(series[n]);
      length = std::min(length, std::pow(ratio, 1 / static_cast<Extended>(n)));
    }
    return length / 2;
  }

  // The overlap is above zero just after the start, and below it after `length`.
  static Extended zero_of(const PowerSeries& series, Extended length) {
    constexpr int kHalvings = 80;
    Extended low = 0, high = length;
    for (int i = 0; i < kHalvings; ++i) {
      const Extended middle = (low + high) / 2;
      (value_of(series, middle) < 0 ? high : low) = middle;
    }
    return high;
  }

  const Body& body_;
  ExtendedVec3 up_;
  Extended gravity_, spring_, dissipation_;  // m/s², 1/s²: k/m, s/m
  Extended depth_;                           // m, at the start; negative above the plane
  std::vector<SeriesPiece> pieces_;
};

}  // namespace

std::unique_ptr<BodyMotion> hunt_crossley_bounce(const Body& body, const Ground& ground, Extended stiffness,
                                                 Extended dissipation, Extended duration) {
  return std::make_unique<HuntCrossleyBounce>(body, ground, stiffness, dissipation, duration);
}

}  // namespace rigor::inline truth
