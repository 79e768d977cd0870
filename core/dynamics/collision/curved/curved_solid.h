// A cylinder or an ellipsoid in any frame, by its support: how far it reaches along a direction, and how that changes
// with the direction.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/dynamics/collision/narrow_phase.h"

namespace rigor::inline dynamics {

// Rounding must not choose the points of a cylinder that stands upright: the sine of the tilt up to which it does.
inline constexpr double kUpright = 1e-9;

struct CurvedSolid {
  Vec3 centre;       // m
  Mat3 R;            // its axes
  Vec3 radii;        // m; of a cylinder: its radius twice, and half its length
  bool is_cylinder;  // else an ellipsoid

  CurvedSolid(const Cylinder& c, const Pose& pose)
      : centre(pose.p), R(pose.R), radii(c.radius, c.radius, 0.5 * c.length), is_cylinder(true) {}
  CurvedSolid(const Ellipsoid& e, const Pose& pose) : centre(pose.p), R(pose.R), radii(e.radii), is_cylinder(false) {}

  // Of a cylinder.
  Vec3 axis() const { return R.col(2); }
  double half() const { return radii.z(); }
  double radius() const { return radii.x(); }
  // The part of n across the axis.
  Vec3 across(const Vec3& n) const { return n - n.dot(axis()) * axis(); }

  double inradius() const { return radii.minCoeff(); }
  double size() const { return radii.norm(); }  // m: no point is farther from the centre
  double bounding_radius() const {
    return is_cylinder ? std::sqrt(radius() * radius() + half() * half()) : radii.maxCoeff();
  }

  // m, along the unit vector n, from the centre. Both shapes are the same in the opposite direction.
  double reach(const Vec3& n) const {
    if (is_cylinder) return radius() * across(n).norm() + half() * std::abs(n.dot(axis()));
    return radii.cwiseProduct(R.transpose() * n).norm();
  }
  // m: the point that lies furthest along n, from the centre. Of the points of an end, the middle.
  Vec3 support(const Vec3& n) const {
    if (!is_cylinder) {
      const Vec3 stretched = radii.cwiseProduct(R.transpose() * n);
      return R * (radii.cwiseProduct(stretched) / stretched.norm());
    }
    const Vec3 beside = across(n);
    const double length = beside.norm();
    return (length > kUpright ? radius() / length : 0) * beside + (n.dot(axis()) < 0 ? -half() : half()) * axis();
  }
  // m: the derivative of support().
  Mat3 bend(const Vec3& n) const {
    if (!is_cylinder) {
      const Mat3 stretch = R * radii.cwiseAbs2().asDiagonal() * R.transpose();
      const Vec3 furthest = support(n);
      return (stretch - furthest * furthest.transpose()) / reach(n);
    }
    const Vec3 beside = across(n);
    const double length = beside.norm();
    if (!(length > kUpright)) return Mat3::Zero();
    const Vec3 tangent = axis().cross(beside) / length;
    return radius() / length * tangent * tangent.transpose();
  }
};

// A flat end of a cylinder.
struct Disc {
  Vec3 centre, out;  // m, unit
  Vec3 along, axis;  // unit: in its plane, and across it; both turn with the cylinder
  double radius;     // m

  bool is_top() const { return out.dot(axis) > 0; }
};

// A straight line on a cylinder's side, or an edge.
struct Line {
  Vec3 from, to;             // m
  bool is_from_top = false;  // of a cylinder: from the end in the direction of its axis
};

// The end of a cylinder that looks most against n.
inline Disc end_against(const CurvedSolid& cylinder, const Vec3& n) {
  const double sign = n.dot(cylinder.axis()) < 0 ? 1 : -1;
  return {cylinder.centre + sign * cylinder.half() * cylinder.axis(), sign * cylinder.axis(), cylinder.R.col(0),
          cylinder.axis(), cylinder.radius()};
}

// The direction in the end's plane in which it lies deepest, seen along n.
inline Vec3 deepest_direction(const Disc& disc, const Vec3& n) {
  const Vec3 beside = n - n.dot(disc.out) * disc.out;
  const double length = beside.norm();
  return length > kUpright ? Vec3(-beside / length) : disc.along;
}

inline bool lies_flat(const Disc& disc, const Vec3& n, double nearly = kNearlyFlat) {
  return disc.out.cross(n).norm() < nearly;
}

struct RimPoint {
  Vec3 at;  // m
  std::uint32_t feature;
};

// The points of a rim that may touch first. Of an end that lies flat, four points that turn with it, and the deepest
// one if that lies deeper: rounding must not move the points of a cylinder that stands. Of a tilted end, the deepest
// point, those at right angles to it, and the opposite one.
class RimPoints {
 public:
  static constexpr std::uint32_t kDeepest = 4;  // the feature of that one, modulo 8
  // `nearly`: the sine of the tilt up to which the end lies flat.
  RimPoints(const Disc& disc, const Vec3& n, double nearly = kNearlyFlat) {
    constexpr double kDeeper = 1e-6;  // of the radius
    const bool is_flat = lies_flat(disc, n, nearly);
    const Vec3 down = deepest_direction(disc, n), along = is_flat ? disc.along : down, aside = disc.axis.cross(along);
    const double lowest = std::max(std::abs(n.dot(along)), std::abs(n.dot(aside)));
    const bool has_deepest = is_flat && -n.dot(down) > lowest + kDeeper;
    const std::uint32_t first = disc.is_top() ? 8 : 0;
    const auto add = [&](const Vec3& direction, std::uint32_t feature) {
      points_[static_cast<std::size_t>(count_++)] = {disc.centre + disc.radius * direction, first + feature};
    };
    if (has_deepest) add(down, kDeepest);
    add(along, 0), add(aside, 1), add(-aside, 2), add(-along, 3);
  }

  const RimPoint* begin() const { return points_.data(); }
  const RimPoint* end() const { return points_.data() + count_; }

 private:
  std::array<RimPoint, 5> points_;
  int count_ = 0;
};

// Points of a cylinder's lower rim, and of one that is tilted the lowest one of the other.
void collide_end_plane(const CurvedSolid& cylinder, const Disc& end, const Plane& b, double nearly, Manifold& out);

// The line on a cylinder's side that lies deepest, seen along n, from the end that does.
inline Line deepest_line(const CurvedSolid& cylinder, const Vec3& n) {
  const Disc lower = end_against(cylinder, n);
  const Vec3 from = lower.centre + cylinder.radius() * deepest_direction(lower, n);
  return {from, from - 2 * cylinder.half() * lower.out, lower.is_top()};
}

}  // namespace rigor::inline dynamics
