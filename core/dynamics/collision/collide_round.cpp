// Cylinders and ellipsoids with planes and balls.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/dynamics/collision/narrow_phase.h"

namespace rigor {

// By Newton's method from the left, where the function is convex and falls.
double nearest_root(const Vec3& squares, const Vec3& rp) {
  // At this start the term of each axis alone is at most 1, and that of one axis is 1.
  double t = (rp.cwiseAbs() - squares).maxCoeff();
  constexpr int kMostRounds = 100;
  for (int round = 0; round < kMostRounds; ++round) {
    const Vec3 bottom = squares.array() + t, share = rp.cwiseQuotient(bottom);
    const double value = share.squaredNorm() - 1, slope = -2 * share.cwiseAbs2().cwiseQuotient(bottom).sum();
    const double step = -value / slope;
    if (!(step > 1e-16 * squares.maxCoeff())) break;
    t += step;
  }
  return t;
}

// The lowest point of each rim, and three more of the lower rim, so that a standing cylinder has four.
void collide_cylinder_plane(const Cylinder& a, const Pose& pose_a, const Plane& b, Manifold& out) {
  const Vec3 n = pose_a.R.transpose() * b.normal;
  const double across = std::hypot(n.x(), n.y());
  // Rounding must not choose the points of a cylinder that stands upright.
  constexpr double kUpright = 1e-9;
  const Vec3 down = across > kUpright ? Vec3(-n.x() / across, -n.y() / across, 0) : Vec3(Vec3::UnitX());
  const Vec3 aside(-down.y(), down.x(), 0);
  const double base = b.normal.dot(pose_a.p) - b.offset, half = 0.5 * a.length, lower = n.z() < 0 ? half : -half;
  const auto add = [&](const Vec3& direction, double z, std::uint32_t feature) {
    const Vec3 local = a.radius * direction + z * Vec3::UnitZ();
    const double gap = base + n.dot(local);
    out.add(b.normal, pose_a.p + pose_a.R * local - 0.5 * gap * b.normal, gap, feature + (z > 0 ? 8 : 0));
  };
  add(down, lower, 0), add(down, -lower, 0);
  add(aside, lower, 1), add(-aside, lower, 2), add(-down, lower, 3);
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
  const Vec3 p = pose_a.R.transpose() * (pose_b.p - pose_a.p), squares = a.radii.cwiseAbs2();
  const double t = nearest_root(squares, a.radii.cwiseProduct(p));
  const Vec3 nearest = squares.cwiseProduct(p).cwiseQuotient((squares.array() + t).matrix());
  Vec3 n = nearest.cwiseQuotient(squares);
  if (!n.allFinite() || n.isZero(0)) {  // on the shortest axis's plane, deep inside
    int axis = 0;
    a.radii.minCoeff(&axis);
    n = Vec3::Unit(axis);
  }
  n.normalize();
  const double distance = n.dot(p - a.support(n)), gap = distance - b.radius;
  const Vec3 n_W = pose_a.R * n;
  out.add(-n_W, pose_b.p - (b.radius + 0.5 * gap) * n_W, gap, 0);
}

}  // namespace rigor
