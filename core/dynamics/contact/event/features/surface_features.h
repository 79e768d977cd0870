// Features of surfaces of triangles. A flat region of triangles (patch) is one plane, which ends at its border. An edge
// that sticks out is a line, and its ends are points. Flat and reentrant edges touch nothing.
#pragma once

#include <vector>

#include "core/dynamics/contact/event/features/feature_choices.h"
#include "core/scene/shapes/surface.h"

namespace rigor::inline dynamics {

// At a point [m, in B] with the outward normal.
Choices choices_on_surface(const TriangleSurface& surface, const Vec3& at, const Vec3& normal);

// The one feature that a ball touches: it follows from its centre [m, in B], which is beside the point `at`.
Choices surface_beside_ball(const TriangleSurface& surface, const Vec3& at, const Vec3& centre);

// m, as EndsOf (feature_ends.cpp): of the surface's `own` feature, touched at q by the `other`. Beyond `reach` it stays
// the same.
double distance_from_end(const TriangleSurface& surface, const ContactFeature& own, const ContactFeature& other,
                         const Vec3& q, double reach);

// The numbers of all patches that reach to a point [m, in B]: one inside a patch, several on its border.
void find_patches_at(const TriangleSurface& surface, const Vec3& at, std::vector<int>& out);

}  // namespace rigor::inline dynamics
