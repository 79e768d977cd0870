// Moments of mass: what a tensor of inertia must be for matter to have it, and the nearest that matter can have.
#pragma once

#include <optional>

#include "core/base/math.h"

namespace rigor::inline imports {

// The inertia of a point mass at `offset` about the origin (Steiner).
Mat3 steiner(double mass, const Vec3& offset);

struct RepairedInertia {
  Mat3 inertia;
  double change;  // of the entries: the norm of the change over that of the whole
};

// The nearest tensor, in the sum of squares of its entries, that a body can have (N. J. Higham, Computing a nearest
// symmetric positive semidefinite matrix, 1988, for the second moments of the mass). Nothing for a zero
// tensor, which is near to none.
std::optional<RepairedInertia> nearest_inertia(const Mat3& inertia);

}  // namespace rigor::inline imports
