// When two bodies of a truth touch, and how they move there.
#pragma once

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline metric {

// m: half the least width of the smallest moving body; infinite without one.
double smallest_half_width(const Scene& scene);

// m: a smaller gap is closed. It is beyond the rounding of a truth's positions, and below any gap that a scene means.
double touching_gap(const Scene& scene);

// m/s, of the body's point at `place`; both in W.
Vec3 velocity_at(BodyColumns bodies, int body, const Vec3& place);

}  // namespace rigor::inline metric
