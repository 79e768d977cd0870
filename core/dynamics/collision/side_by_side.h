// Two straight lines with radii: a capsule beside another one, or along an edge, which has no radius. Nearly parallel
// lines touch along a line, and its two ends stand for it. If the lines cross at a small angle, the crossing is nearer
// than both ends and is a point of its own.
#pragma once

#include <utility>

#include "core/dynamics/collision/narrow_phase.h"

namespace rigor::inline dynamics {

struct RoundLine {
  Vec3 centre, direction;  // m and unit, in W
  double half, radius;     // m

  Vec3 at(double s) const { return centre + s * direction; }
};

// The sine between lines that count as parallel. The gap at a crossing is then smaller than that at the ends by less
// than 1e-10 of the radius, even if a line is ten times as long as that.
inline constexpr double kParallelLines = 3e-6;
inline constexpr double kNearlyParallelLines = 1e-2;  // the sine, of 0.6 degrees: lines that lie side by side

// The nearest points of the two lines, as distances from their centres.
std::pair<double, double> nearest_on_lines(const RoundLine& a, const RoundLine& b);

// Adds the balls at a.at(s) and b.at(t) as a point of contact; the normal points from b to a.
void add_on_lines(const RoundLine& a, double s, const RoundLine& b, double t, std::uint32_t feature, Manifold& out);

// Adds the points of contact, the crossing first if there is one. Features: 0 and 1 for the ends, 2 for the crossing.
// Returns false and adds nothing if the angle is larger than 0.6 degrees, or if no part of a line lies beside the
// other.
bool add_side_by_side(const RoundLine& a, const RoundLine& b, Manifold& out);

}  // namespace rigor::inline dynamics
