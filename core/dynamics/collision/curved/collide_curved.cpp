// Cylinders and ellipsoids with each other, and with boxes, capsules and hulls.
//
// First the axis along which both are separated most (curved_axes.h). An ellipsoid touches in one point. A cylinder
// touches with an end or a side over an area or along a line, if these lie nearly flat on the other shape.
#include "core/dynamics/collision/curved/collide_curved.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/collision/curved/curved_axes.h"
#include "core/dynamics/collision/curved/flat_areas.h"
#include "core/dynamics/collision/side_by_side.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kOutsideArea = 1e-6;  // of the smaller inradius: a point still counts so far outside of a border

double sine_between(const Vec3& a, const Vec3& b) { return a.cross(b).norm(); }

// One point, at `upper` of the upper shape, which the axis points to.
ManifoldPoint single_point(const CurvedAxis& axis, const Vec3& upper, bool is_reversed) {
  const std::uint32_t feature = 0x40000000u ^ static_cast<std::uint32_t>(axis.edge + 1) * 0x9E3779B1u ^
                                static_cast<std::uint32_t>(axis.corner + 1) * 0x85EBCA77u;
  return {is_reversed ? Vec3(-axis.n) : axis.n, upper - 0.5 * axis.separation * axis.n, axis.separation, feature, 0, 0};
}

// Whether a cylinder touches along n with neither a flat end nor a straight side.
bool is_rounded(const CurvedSolid& solid, const Vec3& n) {
  if (!solid.is_cylinder) return true;
  return solid.across(n).norm() > kUpright && std::abs(n.dot(solid.axis())) > kUpright;
}

RoundLine side_line(const CurvedSolid& cylinder) {
  return {cylinder.centre, cylinder.axis(), cylinder.half(), cylinder.radius()};
}

RoundLine line_of(const Line& line, double radius) {
  const Vec3 along = line.to - line.from;
  return {0.5 * (line.from + line.to), along.normalized(), 0.5 * along.norm(), radius};
}

// The point of a cylinder's side that is nearest to another straight line, where both cross along n.
Vec3 on_side(const CurvedSolid& cylinder, const RoundLine& other, const Vec3& n) {
  const auto [s, t] = nearest_on_lines(side_line(cylinder), other);
  return cylinder.centre + s * cylinder.axis() - cylinder.radius() * cylinder.across(n).normalized();
}

// Lines side by side have the gaps of balls around them. The gap of a cylinder is larger by the second order of the
// angle at which they cross. `separation`: m, the exact one.
bool add_beside(const RoundLine& a, const RoundLine& b, double separation, Manifold& out) {
  const int first = out.size();
  if (!add_side_by_side(a, b, out)) return false;
  double least = out[first].gap;
  for (int i = first; i < out.size(); ++i) least = std::min(least, out[i].gap);
  for (int i = first; i < out.size(); ++i) out[i].gap += separation - least;
  return true;
}

// Puts the point of the axis in the place of the nearest point of the area, if the area does not lie along the axis and
// does not hold that point. An area without a point near it gets one more. Of a tilt by rounding alone the area tells
// more than the axis.
void complete(const ManifoldPoint& crossing, bool is_exact, double size, Manifold& out) {
  constexpr double kSameGap = 1e-6, kTouch = 1e-3;  // of the size
  if (out.size() == 0) return out.add(crossing);
  double least = out[0].gap;
  ManifoldPoint* nearest = out.begin();
  for (ManifoldPoint& point : out) {
    least = std::min(least, point.gap);
    if ((point.point - crossing.point).norm() < (nearest->point - crossing.point).norm()) nearest = &point;
  }
  if (least <= crossing.gap + kSameGap * size) return;
  // Along the axis itself only a touch at the very border is missing, or all of an overlap along a longer way.
  if (is_exact) {
    if (crossing.gap > -kTouch * size || least > 0) out.add(crossing);
    return;
  }
  if ((nearest->point - crossing.point).norm() > kNearlyFlat * size + std::abs(crossing.gap)) return out.add(crossing);
  nearest->normal = crossing.normal, nearest->point = crossing.point, nearest->gap = crossing.gap;
}

class OnHull {
 public:
  OnHull(const CurvedSolid& solid, const PlacedHull& hull, Manifold& out, double far)
      : solid_(solid), hull_(hull), axis_(best_axis(solid, hull, far)), far_(far), out_(out) {}

  void find() const {
    if (axis_.separation > far_) return;
    const ManifoldPoint crossing = single_point(axis_, upper_point(), false);
    if (!solid_.is_cylinder) return out_.add(crossing);
    const FlatFace face{hull_, facing_at(hull_, furthest_along(axis_.n), -axis_.n)};
    const Disc end = end_against(solid_, axis_.n);
    const auto is_same = [&](const Vec3& n) { return sine_between(n, axis_.n) < kUpright; };
    const bool is_by_end = is_same(end.out) && !is_same(face.normal());
    if (sine_between(face.normal(), axis_.n) < kNearlyFlat && !is_by_end) {
      add_area(solid_, face, points(face.normal()));
      return complete(crossing, is_same(face.normal()), smaller(), out_);
    }
    if (sine_between(end.out, axis_.n) < kNearlyFlat) {
      add_area(end, face, points(-end.out));
      return complete(crossing, is_same(-end.out), smaller(), out_);
    }
    if (!lies_along_edge()) out_.add(crossing);
  }

 private:
  int furthest_along(const Vec3& n) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < hull_.points.size(); ++i) {
      if (n.dot(hull_.points[i]) > n.dot(hull_.points[best])) best = i;
    }
    return static_cast<int>(best);
  }

  // The points of an area across n.
  AreaPoints points(const Vec3& n) const {
    constexpr double kRise = 1e-5;  // of the radius: of a nearly flat face over what counts outside of its border
    const double reach = n.dot(hull_.points[PlacedHull::index(furthest_along(n))]),
                 separation = n.dot(solid_.centre) - solid_.reach(n) - reach;
    return {n, false, kOutsideArea * smaller(), out_, separation - kRise * solid_.radius()};
  }
  double smaller() const { return std::min(solid_.inradius(), hull_.inradius); }

  Line edge() const {
    const Hull::Edge& of = hull_.hull->edges[PlacedHull::index(axis_.edge)];
    return {hull_.points[PlacedHull::index(of.from)], hull_.points[PlacedHull::index(of.to)]};
  }

  Vec3 upper_point() const {
    if (axis_.corner >= 0) return hull_.points[PlacedHull::index(axis_.corner)] + axis_.separation * axis_.n;
    if (axis_.edge >= 0 && !is_rounded(solid_, axis_.n)) return on_side(solid_, line_of(edge(), 0), axis_.n);
    return solid_.centre - solid_.support(axis_.n);
  }

  bool lies_along_edge() const {
    if (axis_.edge < 0 || std::abs(axis_.n.dot(solid_.axis())) > kNearlyParallelLines) return false;
    return add_beside(side_line(solid_), line_of(edge(), 0), axis_.separation, out_);
  }

  const CurvedSolid& solid_;
  const PlacedHull& hull_;
  CurvedAxis axis_;
  double far_;
  Manifold& out_;
};

// A capsule beside or on a curved solid; the axis points from the capsule to the solid.
void add_capsule(const Capsule& capsule, const Pose& pose, const CurvedSolid& solid, Manifold& out) {
  const Vec3 half = 0.5 * capsule.length * pose.R.col(2);
  const Line middle{pose.p - half, pose.p + half};
  CurvedAxis axis = best_axis(solid, middle);
  const RoundLine round{pose.p, pose.R.col(2), 0.5 * capsule.length, capsule.radius};
  // m: of the capsule's axis
  Vec3 on_axis = axis.corner == 1 ? middle.to : middle.from, upper;
  axis.separation -= capsule.radius;
  if (axis.corner >= 0)
    upper = on_axis + (capsule.radius + axis.separation) * axis.n;
  else if (is_rounded(solid, axis.n))
    upper = solid.centre - solid.support(axis.n);
  else
    upper = on_side(solid, round, axis.n);
  const ManifoldPoint crossing = single_point(axis, upper, true);
  if (solid.is_cylinder) {
    constexpr double kAlong = 0.1;  // the sine of a capsule to a flat end on which it lies
    const Disc end = end_against(solid, axis.n);
    if (sine_between(end.out, axis.n) < kNearlyFlat && std::abs(end.out.dot(round.direction)) < kAlong) {
      const Vec3 down = capsule.radius * end.out;
      const AreaPoints to{end.out, false, 0, out};
      add_area(Line{middle.from - down, middle.to - down}, end, to);
      return complete(crossing, sine_between(end.out, axis.n) < kUpright, solid.inradius(), out);
    }
    const bool is_beside = std::abs(axis.n.dot(solid.axis())) < kNearlyParallelLines;
    if (is_beside && add_beside(round, side_line(solid), axis.separation, out)) return;
  }
  out.add(crossing);
}

// Two cylinders, or a cylinder and an ellipsoid, or two ellipsoids. The axis points from b to a.
class TwoCurved {
 public:
  TwoCurved(const CurvedSolid& a, const CurvedSolid& b, Manifold& out, double far)
      : a_(a), b_(b), axis_(best_axis(a, b, far)), far_(far), out_(out) {}

  void find() const {
    if (axis_.separation > far_) return;
    const ManifoldPoint crossing = single_point(axis_, upper_point(), false);
    if (!a_.is_cylinder || !b_.is_cylinder) return out_.add(crossing);
    const double tilt_a = sine_between(a_.axis(), axis_.n), tilt_b = sine_between(b_.axis(), axis_.n);
    if (std::min(tilt_a, tilt_b) < kNearlyFlat) {
      const bool is_on_b = tilt_b < kUpright || tilt_b <= tilt_a;  // rounding must not choose
      add_on_end(is_on_b ? a_ : b_, is_on_b ? b_ : a_, is_on_b);
      return complete(crossing, std::min(tilt_a, tilt_b) < kUpright, std::min(a_.inradius(), b_.inradius()), out_);
    }
    const double along = std::max(std::abs(axis_.n.dot(a_.axis())), std::abs(axis_.n.dot(b_.axis())));
    if (along < kNearlyParallelLines && add_beside(side_line(a_), side_line(b_), axis_.separation, out_)) return;
    out_.add(crossing);
  }

 private:
  // One cylinder on the flat end of the other.
  void add_on_end(const CurvedSolid& upper, const CurvedSolid& lower, bool is_a_above) const {
    const Vec3 up = is_a_above ? axis_.n : Vec3(-axis_.n);
    const Disc below = end_against(lower, -up);
    const AreaPoints to{below.out, !is_a_above, kOutsideArea * std::min(a_.inradius(), b_.inradius()), out_};
    add_area(upper, below, to);
  }

  Vec3 upper_point() const {
    if (is_rounded(a_, axis_.n)) return a_.centre - a_.support(axis_.n);
    if (is_rounded(b_, axis_.n)) return b_.centre + b_.support(axis_.n) + axis_.separation * axis_.n;
    return on_side(a_, side_line(b_), axis_.n);
  }

  const CurvedSolid& a_;
  const CurvedSolid& b_;
  CurvedAxis axis_;
  double far_;
  Manifold& out_;
};

template <typename Polyhedron>
void collide_with_hull(const CurvedSolid& a, const Polyhedron& b, const Pose& pose_b, Manifold& out, double far) {
  static thread_local PlacedHull hull;
  hull.place(b, pose_b);
  OnHull(a, hull, out, far).find();
}

}  // namespace

void collide_curved(const CurvedSolid& a, const Box& b, const Pose& pose_b, Manifold& out, double far) {
  collide_with_hull(a, b, pose_b, out, far);
}

void collide_curved(const CurvedSolid& a, const Convex& b, const Pose& pose_b, Manifold& out, double far) {
  collide_with_hull(a, b, pose_b, out, far);
}

void collide_curved(const Capsule& a, const Pose& pose_a, const CurvedSolid& b, Manifold& out) {
  add_capsule(a, pose_a, b, out);
}

void collide_curved(const CurvedSolid& a, const CurvedSolid& b, Manifold& out, double far) {
  TwoCurved(a, b, out, far).find();
}

}  // namespace rigor::inline dynamics
