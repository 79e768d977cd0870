// The triangles of a surface as Bullet's tree of triangles, with the arrays that it keeps pointers to.
#pragma once

#include <BulletCollision/CollisionShapes/btTriangleInfoMap.h>
#include <btBulletCollisionCommon.h>

#include <vector>

#include "core/scene/shapes/surface.h"

namespace rigor::inline adapters::bullet {

struct SurfaceArrays {
  explicit SurfaceArrays(const TriangleSurface& surface);
  std::vector<btScalar> points;
  std::vector<int> corners;
  btTriangleIndexVertexArray triangles;
};

// With `knows_edges` the contacts of flat and reentrant edges get the normals of the triangles, by Bullet's own utility
// for such edges. Bullet does so only for objects that ask for the callback of bullet_pair_laws.h.
class SurfaceOfTriangles : private SurfaceArrays, public btBvhTriangleMeshShape {
 public:
  SurfaceOfTriangles(const TriangleSurface& surface, bool knows_edges);

 private:
  btTriangleInfoMap edges_;
};

}  // namespace rigor::inline adapters::bullet
