// What convex shapes of all kinds share where they touch a surface of triangles. A contact is a pair of features whose
// distance is a local minimum: its normal points out of both features. So a body that slides over the seam of two
// coplanar triangles meets no edge there. Only ridges and peaks, which stick out, touch by themselves. A feature counts
// only for bodies whose centre is in front of it: the back of a thin wall is not an overlap.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "core/dynamics/collision/narrow_phase.h"

namespace rigor::inline dynamics {

inline constexpr double kOnTriangle = 1e-9;  // of a triangle's size: a point on the seam of two lies on one at least
inline constexpr double kAcross = 1e-9;      // the sine between lines that cross
inline constexpr double kOverlapSlop =
    0.02;  // of the inradius: of two overlaps that differ by more, the shallower is real

struct SurfaceTouch {
  Vec3 normal;  // unit, from the surface to the shape
  Vec3 foot;    // m, on the surface
  double gap;   // m
  std::uint32_t feature;
  int patch;  // the flat region on which it lies; with a number beyond all of these for a ridge or peak
};

class SurfaceContacts {
 protected:
  SurfaceContacts(const TriangleSurface& surface, double inradius) : surface_(surface), inradius_(inradius) {}

  static std::size_t index_of(int i) { return static_cast<std::size_t>(i); }
  const Vec3& point(int i) const { return surface_.points[index_of(i)]; }
  int beyond_patches(int which) const { return static_cast<int>(surface_.triangles.size()) + which; }
  double slop() const { return kOverlapSlop * inradius_; }
  // m, from a point to the nearest triangle.
  double nearest_to(const Vec3& p) const {
    return (p - surface_.nearest(p, std::numeric_limits<double>::infinity())).norm();
  }

  // Finds the triangles whose boxes come within `reach` [m] of this one. Touches that are farther are left out.
  void look_around(const Vec3& low, const Vec3& high, double reach) {
    reach_ = reach;
    touches_.clear(), near_.clear();
    surface_.find_near(low - Vec3::Constant(reach), high + Vec3::Constant(reach), near_);
    std::sort(near_.begin(), near_.end());
  }

  // The triangles near the shape, and then the peaks and ridges of each.
  template <typename OnTriangle, typename OnPeak, typename OnRidge>
  void visit_near(const OnTriangle& on_triangle, const OnPeak& on_peak, const OnRidge& on_ridge) const {
    for (const int t : near_) on_triangle(t);
    for (const int t : near_) {
      for (const int peak : surface_.peaks_of[index_of(t)]) on_peak(peak);
      for (const int ridge : surface_.ridges_of[index_of(t)]) on_ridge(ridge);
    }
  }

  void add(const Vec3& normal, const Vec3& foot, double gap, std::uint32_t feature, int patch) {
    if (gap > reach_) return;
    touches_.push_back({normal, foot, gap, feature, patch});
  }

  // A point of the shape above a triangle. One that lies above two is added once for each flat region.
  void add_point(int t, const Vec3& p, double radius, std::uint32_t number) {
    const TriangleSurface::Triangle& triangle = surface_.triangles[index_of(t)];
    const Vec3& n = triangle.normal;
    const double height = n.dot(p - point(triangle.corners[0])), gap = height - radius;
    if (gap > reach_) return;
    const Vec3 foot = p - height * n;
    if (!is_inside(triangle, foot)) return;
    // A point a little way into the side of a step is deep below its top, too; one beyond a thin ridge is behind it.
    if (height < -slop() && -height > nearest_to(p) + slop()) return;
    const std::uint32_t feature = number ^ 0x9E3779B1u * static_cast<std::uint32_t>(triangle.patch);
    const bool is_known = std::any_of(touches_.begin(), touches_.end(), [&](const SurfaceTouch& touch) {
      return touch.feature == feature && touch.patch == triangle.patch;
    });
    if (!is_known) add(n, foot, gap, feature, triangle.patch);
  }

  bool is_inside(const TriangleSurface::Triangle& triangle, const Vec3& foot) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &from = point(triangle.corners[k]), side = point(triangle.corners[(k + 1) % 3]) - from;
      if (triangle.normal.dot(side.cross(foot - from)) < -kOnTriangle * side.squaredNorm()) return false;
    }
    return true;
  }

  // For a shape with faces and edges, which may lie on the feature's own triangles.
  static bool points_out_of(const TriangleSurface::Peak& peak, const Vec3& n) {
    return std::all_of(peak.edges.begin(), peak.edges.end(), [&](const Vec3& e) { return n.dot(e) <= kNearlyFlat; });
  }
  static bool points_out_of(const TriangleSurface::Ridge& ridge, const Vec3& n) {
    return n.dot(ridge.into_left) <= kNearlyFlat && n.dot(ridge.into_right) <= kNearlyFlat;
  }
  // For a round shape. Where it lies on a triangle, its point there says so.
  static bool strictly_out_of(const TriangleSurface::Peak& peak, const Vec3& n) {
    return std::all_of(peak.edges.begin(), peak.edges.end(), [&](const Vec3& e) { return n.dot(e) < -kOnTriangle; });
  }
  static bool strictly_out_of(const TriangleSurface::Ridge& ridge, const Vec3& n) {
    return n.dot(ridge.into_left) < -kOnTriangle && n.dot(ridge.into_right) < -kOnTriangle;
  }

  // A face that lies flat on a region belongs to it, with all corners of both.
  int patch_beside(const TriangleSurface::Peak& peak, const Vec3& n, int number) const {
    for (const int t : near_) {
      const TriangleSurface::Triangle& triangle = surface_.triangles[index_of(t)];
      const auto& c = triangle.corners;
      if (std::find(c.begin(), c.end(), peak.point) != c.end() && triangle.normal.cross(n).norm() < kNearlyFlat &&
          triangle.normal.dot(n) > 0)
        return triangle.patch;
    }
    return beyond_patches(number);
  }

  // An edge that lies nearly flat on one of the ridge's triangles belongs to its region, and has its normal.
  void add_crossing(const TriangleSurface::Ridge& ridge, const Vec3& n, const Vec3& foot, const Vec3& own,
                    double radius, std::uint32_t feature, int own_patch) {
    for (const int t : {ridge.left, ridge.right}) {
      const TriangleSurface::Triangle& triangle = surface_.triangles[index_of(t)];
      if (triangle.normal.dot(n) > 0 && triangle.normal.cross(n).norm() < kNearlyFlat)
        return add(triangle.normal, foot, triangle.normal.dot(own - foot) - radius, feature, triangle.patch);
    }
    add(n, foot, n.dot(own - foot) - radius, feature, own_patch);
  }

  const TriangleSurface& surface_;
  double inradius_;  // m, of the shape
  double reach_ = 0;
  std::vector<int> near_;
  std::vector<SurfaceTouch> touches_;
};

// The nearest touches, in W. Those of one region stand together, because together they are reduced to a few.
void add_touches(Manifold& out, std::vector<SurfaceTouch> touches, const Pose& of_surface);

// A pose in another one's frame.
inline Pose seen_from(const Pose& frame, const Pose& pose) {
  return {frame.R.transpose() * (pose.p - frame.p), frame.R.transpose() * pose.R};
}

}  // namespace rigor::inline dynamics
