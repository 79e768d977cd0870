// Whether a body surely stays off a surface of triangles between two states. A triangle that stands apart has an axis
// along which the body cannot reach it (conservative_advancement.h): its normal, the direction from it to the body's
// centre, or a normal of their points of contact.
//
// A body that touches the surface, or has just parted from it, is too near for that to be shown of all triangles
// around. Then the regions that it touches are left out, and between two looks at the others the body may move by a
// quarter of the least height of a triangle, and by half of its own inradius. So it is seen over each of them.
#pragma once

#include <vector>

#include "core/dynamics/collision/conservative_advancement.h"
#include "core/scene/shapes/surface.h"

namespace rigor::inline dynamics {

class SurfaceClearance {
 public:
  struct Way {
    BodyColumns from, to;
    double h;       // s, from the one to the other
    Bend bend;      // of the body
    double spin;    // rad/s, of the body at most
    double missed;  // m: the deepest overlap that may be overlooked
  };

  SurfaceClearance(const Collider& body, const Collider& surface, const Way& way);

  // `touched`: patches of the surface. `normals`: in W, of the points of contact at both ends. `is_near`: it starts at
  // the surface.
  bool stays_off(const std::vector<int>& touched, const std::vector<Vec3>& normals, bool is_near) const;

 private:
  bool is_clear(int triangle, const std::vector<Vec3>& normals, BodyColumns state, double t) const;
  double longest_move() const;
  double least_height(int triangle) const;
  Vec3 corner(int triangle, int k) const;
  Vec3 centre(BodyColumns state) const;

  const Collider& body_;
  const TriangleSurface& surface_;
  Pose pose_;  // of the surface
  Way way_;
  std::vector<int> near_;
};

// The surface of a collider, or null.
const TriangleSurface* surface_of(const Collider& collider);

}  // namespace rigor::inline dynamics
