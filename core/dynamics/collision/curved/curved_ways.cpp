#include "core/dynamics/collision/curved/curved_ways.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {

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

namespace {

// The point of the ellipsoid's surface that is nearest to p, as shares of the radii.
Vec3 nearest_shares(const Vec3& radii, const Vec3& p) {
  constexpr double kNone = 1e-12;
  const Vec3 squares = radii.cwiseAbs2(), bottom = squares.array() + nearest_root(squares, radii.cwiseProduct(p));
  Vec3 share;
  int undetermined = -1;
  for (int k = 0; k < 3; ++k) {
    const bool has_place = bottom[k] > kNone * squares[k];
    share[k] = has_place ? radii[k] * p[k] / bottom[k] : 0;
    if (!has_place) undetermined = k;
  }
  // Deep inside, on the plane across the shortest axis: two points are equally near.
  if (undetermined >= 0)
    share[undetermined] = (p[undetermined] < 0 ? -1 : 1) * std::sqrt(std::max(0.0, 1 - share.squaredNorm()));
  return share.normalized();
}

// What a solid is, seen along a line: an ellipse with its centre at the origin, its longer axis first.
struct Ellipse {
  double longer, shorter;  // m
  double x, y;             // m, of the line, along the two axes
};

struct Way2 {
  double x, y;  // unit, outwards
};

// From a start (sine, cosine) on the ellipse, as shares of its two axes, to the point where its distance from the line
// is least, by Newton's method. Returns whether it is a minimum.
bool settle(const Ellipse& e, double& sine, double& cosine) {
  constexpr int kMostSettling = 12;
  for (int round = 0; round < kMostSettling; ++round) {
    const double squares = e.longer * e.longer - e.shorter * e.shorter;
    const double slope = squares * sine * cosine - e.x * e.longer * cosine + e.y * e.shorter * sine;
    const double bend = squares * (cosine * cosine - sine * sine) + e.x * e.longer * sine + e.y * e.shorter * cosine;
    if (!(bend > 0)) return false;
    const double step = -slope / bend, next_sine = sine + step * cosine, next_cosine = cosine - step * sine;
    const double length = std::sqrt(next_sine * next_sine + next_cosine * next_cosine);
    sine = next_sine / length, cosine = next_cosine / length;
    if (std::abs(step) < 1e-15) break;
  }
  return true;
}

// The direction out of the ellipse at a point of it.
Way2 out_of(const Ellipse& e, double sine, double cosine) {
  constexpr double kNear = 1e-6;  // of the longer axis: nearer points have no direction to the line
  const double x = e.x - e.longer * sine, y = e.y - e.shorter * cosine, distance = std::sqrt(x * x + y * y);
  double nx = e.shorter * sine, ny = e.longer * cosine;
  const double length = std::sqrt(nx * nx + ny * ny);
  const bool is_outside = std::abs(e.x * sine) > e.longer || x * nx + y * ny > 0;
  if (distance > kNear * e.longer && is_outside) return {x / distance, y / distance};
  return length > 0 ? Way2{nx / length, ny / length} : Way2{sine < 0 ? -1.0 : 1.0, 0};
}

// Calls visit(way) for the nearest point, and for that on the other side of the longer axis.
template <typename Visit>
void for_each_way_out(const Ellipse& e, const Visit& visit) {
  if (e.shorter > 0) {
    const Vec3 share = nearest_shares({e.longer, e.shorter, e.longer}, {e.x, e.y, 0});
    double sine = share.x(), cosine = share.y();
    const double before_sine = sine, before_cosine = cosine;
    if (!settle(e, sine, cosine)) sine = before_sine, cosine = before_cosine;
    visit(out_of(e, sine, cosine));
  }
  for (const double side : {1.0, -1.0}) {
    if (e.shorter > 0 && side * e.y > 0) continue;  // the nearest point lies there
    double sine = std::clamp(e.x / e.longer, -1.0, 1.0), cosine = side * std::sqrt(1 - sine * sine);
    if (settle(e, sine, cosine) && side * cosine >= 0) visit(out_of(e, sine, cosine));
  }
}

void add_ways_of_ellipsoid(const CurvedSolid& solid, const Vec3& line, const Vec3& along, Ways& ways) {
  const Vec3 u = along.unitOrthogonal(), v = along.cross(u);
  const Vec3 of_u = solid.radii.cwiseProduct(solid.R.transpose() * u),
             of_v = solid.radii.cwiseProduct(solid.R.transpose() * v);
  // The principal axes of the projection.
  const double uu = of_u.squaredNorm(), vv = of_v.squaredNorm(), uv = of_u.dot(of_v);
  const double middle = 0.5 * (uu + vv), half = 0.5 * (uu - vv), spread = std::sqrt(half * half + uv * uv);
  Vec3 first = u;
  if (spread > 0) first = half > 0 ? Vec3((half + spread) * u + uv * v) : Vec3(uv * u + (spread - half) * v);
  first.normalize();
  const Vec3 second = along.cross(first);
  const double longer = middle + spread, product = uu * vv - uv * uv;
  const Ellipse ellipse{std::sqrt(longer), std::sqrt(std::max(0.0, product / longer)), first.dot(line),
                        second.dot(line)};
  for_each_way_out(ellipse, [&](const Way2& way) { ways.add(-(way.x * first + way.y * second)); });
}

// The projection of a cylinder is that of a disc, moved along that of the axis.
void add_ways_of_cylinder(const CurvedSolid& solid, const Vec3& line, const Vec3& along, Ways& ways) {
  const Vec3 across = along.cross(solid.axis());
  const double sine = across.norm(), cosine = std::abs(along.dot(solid.axis()));
  if (!(sine > kUpright)) {
    const Vec3 beside = line - along.dot(line) * along;
    const double length = beside.norm();
    return ways.add(length > 0 ? Vec3(-beside / length) : Vec3(along.unitOrthogonal()));
  }
  const Vec3 side = across / sine, up = side.cross(along);
  ways.add(side), ways.add(-side);
  for (const double end : {1.0, -1.0}) {
    const Ellipse rim{solid.radius(), solid.radius() * cosine, side.dot(line),
                      end * up.dot(line) - solid.half() * sine};
    bool has_way = false;
    for_each_way_out(rim, [&](const Way2& way) {
      if (way.y < 0 || has_way) return;
      ways.add(-(way.x * side + end * way.y * up)), has_way = true;
    });
  }
}

}  // namespace

Vec3 out_of_ellipsoid(const Vec3& radii, const Vec3& p) {
  return nearest_shares(radii, p).cwiseQuotient(radii).normalized();
}

Ways ways_from_line(const CurvedSolid& solid, const Vec3& on_line, const Vec3& along) {
  Ways ways;
  const Vec3 line = on_line - solid.centre;
  if (solid.is_cylinder)
    add_ways_of_cylinder(solid, line, along, ways);
  else
    add_ways_of_ellipsoid(solid, line, along, ways);
  return ways;
}

Ways ways_from_point(const CurvedSolid& solid, const Vec3& p) {
  Ways ways;
  const Vec3 local = solid.R.transpose() * (p - solid.centre);
  if (!solid.is_cylinder) {
    ways.add(-(solid.R * out_of_ellipsoid(solid.radii, local)));
    return ways;
  }
  const double r = std::sqrt(local.x() * local.x() + local.y() * local.y());
  const double beside = r - solid.radius(), above = std::abs(local.z()) - solid.half();
  const Vec3 outward = r > 0 ? Vec3(local.x() / r, local.y() / r, 0) : Vec3(Vec3::UnitX()),
             up = (local.z() < 0 ? -1 : 1) * Vec3::UnitZ();
  if (beside > 0 && above > 0) {
    ways.add(-(solid.R * (beside * outward + above * up).normalized()));
  } else {
    ways.add(-(solid.R * outward)), ways.add(-(solid.R * up));
  }
  return ways;
}

}  // namespace rigor::inline dynamics
