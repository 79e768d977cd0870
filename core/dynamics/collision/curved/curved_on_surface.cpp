// Cylinders and ellipsoids on surfaces of triangles. The pairs of features that touch:
//
//   ellipsoid:  its deepest point on a triangle; a ridge; a peak
//   cylinder:   points of both rims on a triangle; a peak on an end, on the side, before a rim; a ridge along or across
//               the side, across an end, before a rim
#include <algorithm>
#include <array>
#include <cmath>

#include "core/dynamics/collision/curved/collide_curved.h"
#include "core/dynamics/collision/curved/curved_axes.h"
#include "core/dynamics/collision/curved/curved_ways.h"
#include "core/dynamics/collision/side_by_side.h"
#include "core/dynamics/collision/surface_contacts.h"

namespace rigor::inline dynamics {
namespace {

// Numbers of features beside those of points.
constexpr std::uint32_t kOfPeak = 0x40000000u, kOfRidge = 0x20000000u;

class CurvedOnSurface : SurfaceContacts {
 public:
  CurvedOnSurface(const TriangleSurface& surface, const CurvedSolid& solid)
      : SurfaceContacts(surface, solid.inradius()), solid_(solid) {}

  // Nearest or not, all within `reach` [m].
  const std::vector<SurfaceTouch>& find(double reach) {
    const Vec3 half(solid_.reach(Vec3::UnitX()), solid_.reach(Vec3::UnitY()), solid_.reach(Vec3::UnitZ()));
    look_around(solid_.centre - half, solid_.centre + half, reach);
    visit_near([&](int t) { points_on(t); }, [&](int peak) { on_peak(peak); }, [&](int ridge) { on_ridge(ridge); });
    return touches_;
  }

 private:
  bool is_in_front(const Vec3& n, const Vec3& at) const { return n.dot(solid_.centre - at) > 0; }

  // Those of a cylinder are the same as on a plane (collide_round.cpp).
  void points_on(int t) {
    const TriangleSurface::Triangle& triangle = surface_.triangles[index_of(t)];
    const Vec3& n = triangle.normal;
    if (!is_in_front(n, point(triangle.corners[0]))) return;
    if (!solid_.is_cylinder) return add_point(t, solid_.centre - solid_.support(n), 0, 0);
    const Disc end = end_against(solid_, n);
    for (const RimPoint& rim : RimPoints(end, n)) add_point(t, rim.at, 0, rim.feature);
    if (!lies_flat(end, n)) add_point(t, deepest_line(solid_, n).to, 0, end.is_top() ? 0 : 8);
  }

  void on_peak(int number) {
    const TriangleSurface::Peak& peak = surface_.peaks[index_of(number)];
    const Vec3& q = point(peak.point);
    const std::uint32_t feature = kOfPeak ^ static_cast<std::uint32_t>(number) * 0x85EBCA77u;
    const auto add_if_out = [&](const Vec3& n) {
      if (strictly_out_of(peak, n) && is_in_front(n, q))
        add(n, q, n.dot(solid_.centre - q) - solid_.reach(n), feature, beyond_patches(number));
    };
    const auto add_nearest = [&] {
      for (const Vec3& n : ways_from_point(solid_, q)) add_if_out(n);
    };
    if (!solid_.is_cylinder) return add_nearest();
    const Vec3 line = q - solid_.centre, side = solid_.across(line);
    const double along = line.dot(solid_.axis()), r = side.norm(), beside = r - solid_.radius(),
                 above = std::abs(along) - solid_.half();
    if (beside > 0 && above > 0) return add_nearest();
    // Of a peak inside, the shallower way is real.
    if (above <= 0 && r > 0 && beside > above - slop()) add_if_out(-side / r);
    if (beside <= 0 && above > beside - slop()) {
      const Vec3 n = (along < 0 ? 1 : -1) * solid_.axis();
      if (points_out_of(peak, n) && is_in_front(n, q)) add(n, q, above, feature, patch_beside(peak, n, number));
    }
  }

  void on_ridge(int number) {
    const TriangleSurface::Ridge& ridge = surface_.ridges[index_of(number)];
    const Line line{point(ridge.from), point(ridge.to)};
    const std::uint32_t feature = kOfRidge ^ static_cast<std::uint32_t>(number) * 0xC2B2AE3Du;
    const int patch = beyond_patches(static_cast<int>(surface_.peaks.size()) + number);
    before_ridge(ridge, line, feature, patch);
    if (!solid_.is_cylinder) return;
    beside_ridge(ridge, line, feature, patch);
    for (const double end : {1.0, -1.0}) end_on_ridge(ridge, line, end, feature ^ (end > 0 ? 0x10u : 0x20u), patch);
  }

  // A smooth part of the solid: an ellipsoid, or a rim.
  void before_ridge(const TriangleSurface::Ridge& ridge, const Line& line, std::uint32_t feature, int patch) {
    const Vec3 along = line.to - line.from;
    CurvedAxis best;
    for (const Vec3& n : ways_from_line(solid_, line.from, along.normalized())) {
      const bool is_rim =
          !solid_.is_cylinder || (solid_.across(n).norm() > kNearlyFlat && std::abs(n.dot(solid_.axis())) > kUpright);
      const double separation = n.dot(solid_.centre - line.from) - solid_.reach(n);
      if (is_rim && strictly_out_of(ridge, n) && separation > best.separation) best = {separation, n, -1, -1};
    }
    if (best.separation > reach_ || !std::isfinite(best.separation) || !is_in_front(best.n, line.from)) return;
    const Vec3 own = solid_.centre - solid_.support(best.n);
    const double share = along.dot(own - line.from) / along.squaredNorm();
    const Vec3 foot = line.from + share * along;
    if (share < 0 || share > 1 || is_false_overlap(best.separation, foot, own)) return;
    add(best.n, foot, best.separation, feature, patch);
  }

  // The side of a cylinder.
  void beside_ridge(const TriangleSurface::Ridge& ridge, const Line& line, std::uint32_t feature, int patch) {
    const Vec3 along = line.to - line.from, middle = 0.5 * (line.from + line.to), u = along.normalized();
    const Vec3 across = u.cross(solid_.axis());
    const double sine = across.norm(), cosine = u.dot(solid_.axis());
    if (sine > kAcross) {
      const Vec3 apart = solid_.centre - middle;
      const double s = (u.dot(apart) - cosine * solid_.axis().dot(apart)) / (sine * sine),
                   t = s * cosine - solid_.axis().dot(apart);
      for (const double side : {1.0, -1.0}) {
        const Vec3 n = side / sine * across;
        if (std::abs(s) > 0.5 * along.norm() || std::abs(t) > solid_.half() || !points_out_of(ridge, n)) continue;
        const Vec3 foot = middle + s * u, own = solid_.centre + t * solid_.axis() - solid_.radius() * n;
        if (!is_in_front(n, foot) || is_false_overlap(n.dot(own - foot), foot, own)) continue;
        add_crossing(ridge, n, foot, own, 0, feature ^ 1u, patch);
      }
    }
    if (sine > kNearlyParallelLines) return;
    for (const double end : {1.0, -1.0}) {
      const Vec3 at = solid_.centre + end * solid_.half() * solid_.axis();
      const double s = u.dot(at - middle), distance = (at - middle - s * u).norm();
      if (std::abs(s) > 0.5 * along.norm() || !(distance > 0)) continue;
      const Vec3 n = (at - middle - s * u) / distance;
      if (strictly_out_of(ridge, n))
        add(n, middle + s * u, distance - solid_.radius(), feature ^ (end > 0 ? 2u : 3u), patch);
    }
  }

  // Where a ridge that lies along a flat end leaves it.
  void end_on_ridge(const TriangleSurface::Ridge& ridge, const Line& line, double end, std::uint32_t feature,
                    int patch) {
    constexpr double kAlongEnd = 0.1;  // the sine between them
    const Vec3 out = end * solid_.axis(), n = -out, middle = solid_.centre + solid_.half() * out;
    const Vec3 along = line.to - line.from;
    if (std::abs(along.dot(out)) > kAlongEnd * along.norm() || !points_out_of(ridge, n) || !is_in_front(n, line.from))
      return;
    const Vec3 from = solid_.across(line.from - middle), rate = solid_.across(along);
    const double aa = rate.squaredNorm(), ab = rate.dot(from),
                 square = ab * ab - aa * (from.squaredNorm() - solid_.radius() * solid_.radius());
    if (!(square > 0)) return;
    for (const double sign : {1.0, -1.0}) {
      const double share = (-ab + sign * std::sqrt(square)) / aa;
      if (share < 0 || share > 1) continue;
      const Vec3 foot = line.from + share * along, own = foot - out.dot(foot - middle) * out;
      if (is_false_overlap(n.dot(own - foot), foot, own)) continue;
      add_crossing(ridge, n, foot, own, 0, feature ^ (sign > 0 ? 4u : 5u), patch);
    }
  }

  // Whether two features that have passed each other lie on different sides of a body, and not inside each other.
  bool is_false_overlap(double gap, const Vec3& foot, const Vec3& own) const {
    return gap < -slop() && (own - foot).norm() > nearest_to(own) + slop();
  }

  const CurvedSolid& solid_;
};

}  // namespace

void collide_curved(const CurvedSolid& a, const TriangleSurface& b, const Pose& pose_b, Manifold& out) {
  CurvedSolid seen = a;
  const Pose at = seen_from(pose_b, Pose{a.centre, a.R});
  seen.centre = at.p, seen.R = at.R;
  const double size = a.bounding_radius();
  if (!b.nearest(seen.centre, 2 * size).allFinite()) return;  // far away
  CurvedOnSurface on(b, seen);
  add_touches(out, on.find(size), pose_b);
}

}  // namespace rigor::inline dynamics
