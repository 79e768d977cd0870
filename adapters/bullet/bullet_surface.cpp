#include "adapters/bullet/bullet_surface.h"

#include <BulletCollision/CollisionDispatch/btInternalEdgeUtility.h>

namespace rigor::inline adapters::bullet {

SurfaceArrays::SurfaceArrays(const TriangleSurface& surface) {
  for (const Vec3& point : surface.points) points.insert(points.end(), {point.x(), point.y(), point.z()});
  for (const TriangleSurface::Triangle& triangle : surface.triangles)
    corners.insert(corners.end(), triangle.corners.begin(), triangle.corners.end());
  btIndexedMesh mesh;
  mesh.m_numTriangles = static_cast<int>(surface.triangles.size());
  mesh.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(corners.data());
  mesh.m_triangleIndexStride = 3 * sizeof(int);
  mesh.m_numVertices = static_cast<int>(surface.points.size());
  mesh.m_vertexBase = reinterpret_cast<const unsigned char*>(points.data());
  mesh.m_vertexStride = 3 * sizeof(btScalar);
  triangles.addIndexedMesh(mesh);
}

SurfaceOfTriangles::SurfaceOfTriangles(const TriangleSurface& surface, bool knows_edges)
    : SurfaceArrays(surface), btBvhTriangleMeshShape(&triangles, true) {
  if (!knows_edges) return;
  setMargin(0);
  btGenerateInternalEdgeInfo(this, &edges_);
}

}  // namespace rigor::inline adapters::bullet
