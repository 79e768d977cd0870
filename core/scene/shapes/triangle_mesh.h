// Triangles of a surface, for pictures.
#pragma once

#include <array>
#include <vector>

#include "core/base/math.h"

namespace rigor::inline scene {

struct TriangleMesh {
  std::vector<Vec3> points, normals;  // m; unit, outwards
  std::vector<int> corners;           // three for each triangle, anticlockwise as seen from outside
};

// A surface of rings about z, from below upwards. A row has its radius and height, and the normal's parts outwards and
// upwards.
TriangleMesh rings(const std::vector<std::array<double, 4>>& profile);

TriangleMesh unit_cube();  // edges of 1
TriangleMesh unit_tube();  // diameter and length 1, along z, open at its ends
TriangleMesh unit_ball();  // diameter 1

// The mesh with each point and normal scaled along the axes.
TriangleMesh scaled(TriangleMesh mesh, const Vec3& scale);
void append(TriangleMesh& mesh, const TriangleMesh& other, const Vec3& at);

}  // namespace rigor::inline scene
