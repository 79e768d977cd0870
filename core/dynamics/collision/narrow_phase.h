// Contact points, normals and signed gaps of any two shapes. A gap is exact while the shapes are apart or just touch.
// Two polyhedra (boxes, hulls) use the separation along the best axis, among the face normals of both and the products
// of the edges. It equals the distance for every kind of touch, and never exceeds it. Flat and long contacts have
// several points, each with its own gap. A compound has the points of all its parts. On a surface, `part_b` numbers the
// regions that are touched.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/scene/features/feature.h"
#include "core/scene/scene.h"

namespace rigor::inline dynamics {

struct Pose {
  Vec3 p = Vec3::Zero();      // m, p_WB
  Mat3 R = Mat3::Identity();  // B to W

  Pose operator*(const BodyPose& part) const { return {p + R * part.position, R * matrix_of(part.orientation)}; }
};

struct ManifoldPoint {
  Vec3 normal;                   // unit, in W, from b to a
  Vec3 point;                    // m, in W, midway between the two surfaces
  double gap;                    // m, negative where they overlap
  std::uint32_t feature;         // the same from one instant to the next for the same corner, end or crossing of edges
  std::uint16_t part_a, part_b;  // of compounds: which part touches; else 0
};

class Manifold {
 public:
  static constexpr int kMost = 64;  // further points are dropped: of a compound, those with the largest gaps
  void clear() { count_ = 0; }
  void add(const Vec3& normal, const Vec3& point, double gap, std::uint32_t feature) {
    if (count_ < kMost) points_[count_++] = {normal, point, gap, feature, 0, 0};
  }
  void add(const ManifoldPoint& point) {
    if (count_ < kMost) points_[count_++] = point;
  }
  void keep(int first) { count_ = first; }
  int size() const { return count_; }
  ManifoldPoint& operator[](int i) { return points_[i]; }
  const ManifoldPoint& operator[](int i) const { return points_[i]; }
  ManifoldPoint* begin() { return points_.data(); }
  ManifoldPoint* end() { return points_.data() + count_; }
  const ManifoldPoint* begin() const { return points_.data(); }
  const ManifoldPoint* end() const { return points_.data() + count_; }

 private:
  std::array<ManifoldPoint, kMost> points_;
  int count_ = 0;
};

// Edges that cross over faces whose normals differ by less than this touch with all corners of these faces. With the
// crossing alone, a body that lies between two others would turn about both crossings.
inline constexpr double kNearlyFlat = 1e-2;  // rad
// Puts the crossing in the place of the nearest of the points from `first` on, which keeps its feature. Without one
// within `reach` [m] it removes these points and returns false.
bool put_crossing(const ManifoldPoint& crossing, double reach, int first, Manifold& out);

// Every point at which the shapes touch or come closest. Two planes have none, nor does a shape far from a surface of
// triangles. Shapes further apart than `far` [m] need none either, which spares time.
void collide(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Manifold& out,
             double far = std::numeric_limits<double>::infinity());

// The pairs of shapes that it takes.
Features contacts_in_collision();

// The harder pairs, in files of their own; normals from the second to the first.
void collide_boxes(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b, Manifold& out);
void collide_box_capsule(const Box& a, const Pose& pose_a, const Capsule& b, const Pose& pose_b, Manifold& out);
void collide_hulls(const Convex& a, const Pose& pose_a, const Convex& b, const Pose& pose_b, Manifold& out);
void collide_hulls(const Box& a, const Pose& pose_a, const Convex& b, const Pose& pose_b, Manifold& out);
void collide_hull_sphere(const Convex& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b, Manifold& out);
void collide_hull_plane(const Convex& a, const Pose& pose_a, const Plane& b, Manifold& out);
void collide_capsule_hull(const Capsule& a, const Pose& pose_a, const Convex& b, const Pose& pose_b, Manifold& out);
void collide_cylinder_plane(const Cylinder& a, const Pose& pose_a, const Plane& b, Manifold& out);
void collide_cylinder_sphere(const Cylinder& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b, Manifold& out);
void collide_ellipsoid_plane(const Ellipsoid& a, const Pose& pose_a, const Plane& b, Manifold& out);
// Shapes on a surface: the points with a gap of at most the shape's size, which is that from its centre to its end.
void collide_surface(const Box& a, const Pose& pose_a, const TriangleSurface& b, const Pose& pose_b, Manifold& out);
void collide_surface(const Capsule& a, const Pose& pose_a, const TriangleSurface& b, const Pose& pose_b, Manifold& out);
void collide_surface(const Convex& a, const Pose& pose_a, const TriangleSurface& b, const Pose& pose_b, Manifold& out);
void collide_surface(const Sphere& a, const Pose& pose_a, const TriangleSurface& b, const Pose& pose_b, Manifold& out);
void collide_ellipsoid_sphere(const Ellipsoid& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b,
                              Manifold& out);

}  // namespace rigor::inline dynamics
