// Newton's method for the direction of largest separation, where the separation is smooth.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace rigor::inline dynamics {

// A separation along n: homogeneous of degree 1 and concave in n, so its value is n · gradient.
struct SeparationAt {
  Vec3 gradient;  // m
  Mat3 bend;      // m, its second derivative
};

// The tangents along which a direction may turn.
struct Tangents {
  Vec3 first, second;  // unit, across each other
};

inline Tangents tangents_of(const Vec3& n) {
  const Vec3 first = n.unitOrthogonal();
  return {first, n.cross(first)};
}

// Goes uphill from n over the unit sphere. Steps are accepted only if they gain, so that the method also ends at a
// kink. It soon gives up there: on 300,000 random pairs of cylinders and ellipsoids it found the same axes as with more
// rounds, to 1e-13 of the size. Their half-axes differed by up to a hundred times. `size`: m, of both shapes.
template <typename Separation>
Vec3 uphill(const Separation& separation, Vec3 n, double size) {
  constexpr int kMostRounds = 40, kMostHalvings = 24, kShort = 8, kMostAtKink = 2;
  constexpr double kRounding = 4e-16, kLongest = 0.5, kNoTurn = 1e-15;  // of the size; rad; rad
  SeparationAt here = separation(n);
  int at_kink = 0;  // rounds at a kink, where only short steps gain: what lies beyond it is found from other starts
  for (int round = 0; round < kMostRounds; ++round) {
    const double value = n.dot(here.gradient);
    const Tangents along = tangents_of(n);
    const double gx = along.first.dot(here.gradient), gy = along.second.dot(here.gradient);
    if (!(std::max(std::abs(gx), std::abs(gy)) > kRounding * size)) break;
    // On the sphere a direction that turns loses the value itself at second order.
    const Vec3 bent_x = here.bend * along.first, bent_y = here.bend * along.second;
    double xx = along.first.dot(bent_x) - value, yy = along.second.dot(bent_y) - value;
    const double xy = along.first.dot(bent_y);
    const double middle = 0.5 * (xx + yy), spread = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    // Where it curves upwards, steps go uphill all the same.
    const double least = 1e-9 * (size + spread);
    if (middle + spread > -least) {
      const double shift = middle + spread + 0.1 * std::max(spread, size);
      xx -= shift, yy -= shift;
    }
    const double determinant = xx * yy - xy * xy;
    Vec3 step = (xy * gy - yy * gx) / determinant * along.first + (xy * gx - xx * gy) / determinant * along.second;
    const double length = step.norm();
    if (!(length > kNoTurn)) break;
    if (length > kLongest) step *= kLongest / length;
    double hoped = here.gradient.dot(step);  // m
    bool has_gained = false;
    for (int halving = 0; halving < kMostHalvings && !has_gained; ++halving, step *= 0.5, hoped *= 0.5) {
      if (halving > 0 && !(hoped > kRounding * size)) break;  // no gain could be told from rounding
      const Vec3 next = (n + step).normalized();
      const SeparationAt there = separation(next);
      const double gain = next.dot(there.gradient) - value;
      const Vec3 slope_here = here.gradient - value * n, slope_there = there.gradient - next.dot(there.gradient) * next;
      const bool is_level = std::abs(gain) <= kRounding * size;
      if (gain > kRounding * size || (is_level && slope_there.norm() < 0.5 * slope_here.norm()))
        n = next, here = there, has_gained = true, at_kink += halving >= kShort;
    }
    if (!has_gained || at_kink > kMostAtKink) break;
  }
  return n;
}

}  // namespace rigor::inline dynamics
