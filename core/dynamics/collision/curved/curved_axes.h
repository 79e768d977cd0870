// The direction along which a curved solid and another shape are separated most, and by how much. Apart, that is their
// distance; overlapping, the shortest way that parts them. The separation along n, from the other shape to the solid,
// is n · (difference of the centres) - (how far both reach). It is smooth, except where a shape touches with a flat
// part or a straight line. Those directions are tried one by one, and Newton's method finds the others.
#pragma once

#include <limits>

#include "core/dynamics/collision/curved/curved_solid.h"
#include "core/dynamics/collision/placed_hull.h"

namespace rigor::inline dynamics {

struct CurvedAxis {
  double separation = -std::numeric_limits<double>::infinity();  // m
  Vec3 n = Vec3::UnitZ();                                        // unit, from the other shape to the curved solid
  int corner = -1, edge = -1;                                    // of a hull or line: what touches, if not a face
};

// Exact for shapes that are apart. An overlap may be found along a longer way than the shortest one: seldom where it is
// shallow (core/README.md has figures). Of shapes further apart than `far` [m] it may be any axis along which they are.
CurvedAxis best_axis(const CurvedSolid& solid, const PlacedHull& hull, double far);
CurvedAxis best_axis(const CurvedSolid& solid, const Line& line);
CurvedAxis best_axis(const CurvedSolid& solid, const CurvedSolid& other, double far);

}  // namespace rigor::inline dynamics
