// Cylinders and ellipsoids with planes and balls.
#include <algorithm>
#include <cmath>

#include "core/dynamics/collision/curved/curved_ways.h"

namespace rigor::inline dynamics {

void collide_end_plane(const CurvedSolid& cylinder, const Disc& end, const Plane& b, double nearly, Manifold& out) {
  const auto add = [&](const Vec3& at, std::uint32_t feature) {
    const double gap = b.normal.dot(at) - b.offset;
    out.add(b.normal, at - 0.5 * gap * b.normal, gap, feature);
  };
  for (const RimPoint& rim : RimPoints(end, b.normal, nearly)) add(rim.at, rim.feature);
  if (!lies_flat(end, b.normal, nearly)) add(deepest_line(cylinder, b.normal).to, end.is_top() ? 0 : 8);
}

void collide_cylinder_plane(const Cylinder& a, const Pose& pose_a, const Plane& b, Manifold& out) {
  const CurvedSolid cylinder(a, pose_a);
  collide_end_plane(cylinder, end_against(cylinder, b.normal), b, kNearlyFlat, out);
}

void collide_cylinder_sphere(const Cylinder& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b,
                             Manifold& out) {
  const Vec3 p = pose_a.R.transpose() * (pose_b.p - pose_a.p);
  const double r = std::hypot(p.x(), p.y()), half = 0.5 * a.length;
  const Vec3 outward = r > 0 ? Vec3(p.x() / r, p.y() / r, 0) : Vec3(Vec3::UnitX());
  const double beside = r - a.radius, above = std::abs(p.z()) - half;
  const Vec3 up = (p.z() < 0 ? -1 : 1) * Vec3::UnitZ();
  Vec3 n = beside > above ? outward : up;
  double distance = std::max(beside, above);
  if (beside > 0 && above > 0) distance = std::hypot(beside, above), n = (beside * outward + above * up) / distance;
  const double gap = distance - b.radius;
  const Vec3 n_W = pose_a.R * n;
  out.add(-n_W, pose_b.p - (b.radius + 0.5 * gap) * n_W, gap, 0);
}

void collide_ellipsoid_plane(const Ellipsoid& a, const Pose& pose_a, const Plane& b, Manifold& out) {
  const Vec3 lowest = pose_a.p + pose_a.R * a.support(-(pose_a.R.transpose() * b.normal));
  const double gap = b.normal.dot(lowest) - b.offset;
  out.add(b.normal, lowest - 0.5 * gap * b.normal, gap, 0);
}

void collide_ellipsoid_sphere(const Ellipsoid& a, const Pose& pose_a, const Sphere& b, const Pose& pose_b,
                              Manifold& out) {
  const Vec3 p = pose_a.R.transpose() * (pose_b.p - pose_a.p), n = out_of_ellipsoid(a.radii, p);
  const double distance = n.dot(p - a.support(n)), gap = distance - b.radius;
  const Vec3 n_W = pose_a.R * n;
  out.add(-n_W, pose_b.p - (b.radius + 0.5 * gap) * n_W, gap, 0);
}

}  // namespace rigor::inline dynamics
