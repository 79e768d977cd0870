#include "core/scene/shapes/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rigor::inline scene {
namespace {

constexpr int kRound = 24;  // points of a ring

}  // namespace

TriangleMesh rings(const std::vector<std::array<double, 4>>& profile) {
  TriangleMesh mesh;
  for (const auto& [radius, height, outwards, upwards] : profile) {
    for (int k = 0; k <= kRound; ++k) {
      const double angle = 2 * std::numbers::pi * k / kRound;
      const Vec3 out(portable::cos(angle), portable::sin(angle), 0);
      mesh.points.push_back(radius * out + height * Vec3::UnitZ());
      mesh.normals.push_back((outwards * out + upwards * Vec3::UnitZ()).normalized());
    }
  }
  for (int ring = 0; ring + 1 < static_cast<int>(profile.size()); ++ring) {
    for (int k = 0; k < kRound; ++k) {
      const int low = ring * (kRound + 1) + k, high = low + kRound + 1;
      for (const int corner : {low, low + 1, high + 1, low, high + 1, high}) mesh.corners.push_back(corner);
    }
  }
  return mesh;
}

TriangleMesh unit_cube() {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      const Vec3 normal = 2 * side * Vec3::Unit(axis), u = Vec3::Unit((axis + 1) % 3), v = normal.cross(u);
      const int first = static_cast<int>(mesh.points.size());
      for (const auto& [a, b] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
        mesh.points.push_back(normal / 2 + a * u + b * v), mesh.normals.push_back(normal);
      }
      for (const int corner : {0, 1, 2, 0, 2, 3}) mesh.corners.push_back(first + corner);
    }
  }
  return mesh;
}

TriangleMesh unit_tube() { return rings({{0.5, -0.5, 1, 0}, {0.5, 0.5, 1, 0}}); }

TriangleMesh unit_ball() {
  std::vector<std::array<double, 4>> profile;
  for (int k = 0; k <= kRound / 2; ++k) {
    const double latitude = std::numbers::pi * (2.0 * k / kRound - 0.5), c = std::max(0.0, portable::cos(latitude)),
                 s = portable::sin(latitude);
    profile.push_back({c / 2, s / 2, c, s});
  }
  return rings(profile);
}

TriangleMesh scaled(TriangleMesh mesh, const Vec3& scale) {
  for (Vec3& point : mesh.points) point = point.cwiseProduct(scale);
  for (Vec3& normal : mesh.normals) normal = normal.cwiseQuotient(scale).normalized();
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& other, const Vec3& at) {
  const int first = static_cast<int>(mesh.points.size());
  for (const Vec3& point : other.points) mesh.points.push_back(point + at);
  mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  for (const int corner : other.corners) mesh.corners.push_back(first + corner);
}

}  // namespace rigor::inline scene
