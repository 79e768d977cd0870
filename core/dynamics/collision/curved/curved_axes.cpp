#include "core/dynamics/collision/curved/curved_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/dynamics/collision/curved/curved_ways.h"
#include "core/dynamics/collision/curved/smooth_ascent.h"
#include "core/dynamics/collision/side_by_side.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kSameWay = 1e-12;     // of the size: by how much a point may reach beyond the one that is looked at
constexpr double kAway = 0.1;          // rad: from a flat end to a start uphill
constexpr double kShallow = 0.01;      // of the smaller inradius: an overlap
constexpr double kRoundingOf = 1e-13;  // of the size: directions that gain less count as equal

struct FromSolid {
  CurvedSolid solid, other;

  SeparationAt operator()(const Vec3& n) const {
    return {solid.centre - other.centre - solid.support(n) - other.support(n), -solid.bend(n) - other.bend(n)};
  }
};

// The part of a solid that is smooth: of a cylinder, the rim on this side (1 or -1) of its middle.
CurvedSolid smooth_part(const CurvedSolid& solid, double side) {
  CurvedSolid part = solid;
  if (!solid.is_cylinder) return part;
  part.centre += side * solid.half() * solid.axis();
  part.radii.z() = 0;
  return part;
}

// The same around its support along n.
CurvedSolid smooth_part(const CurvedSolid& solid, const Vec3& n) {
  return smooth_part(solid, n.dot(solid.axis()) < 0 ? -1.0 : 1.0);
}

// What touches first along a direction: a point, the straight side of a cylinder, or its flat end.
struct TouchingPart {
  RoundLine line;  // without length for a point and an end; without radius but for an end

  TouchingPart(const CurvedSolid& solid, const Vec3& n) : line{solid.centre + solid.support(n), n, 0, 0} {
    if (!solid.is_cylinder) return;
    if (std::abs(n.dot(solid.axis())) < kUpright)
      line = {solid.centre + solid.radius() * solid.across(n).normalized(), solid.axis(), solid.half(), 0};
    else if (!(solid.across(n).norm() > kUpright))
      line.radius = solid.radius();
  }
};

// m: how deep a point lies in a cylinder; negative outside of it. An ellipsoid has no such formula, and proves nothing.
double depth_in(const CurvedSolid& solid, const Vec3& p) {
  if (!solid.is_cylinder) return -std::numeric_limits<double>::infinity();
  const Vec3 from = p - solid.centre;
  return std::min(solid.radius() - solid.across(from).norm(), solid.half() - std::abs(from.dot(solid.axis())));
}

// Tries directions from a polyhedron to the solid.
class FromHull {
 public:
  FromHull(const CurvedSolid& solid, const PlacedHull& hull) : solid_(solid), hull_(hull) {
    size_ = solid.size() + (hull.points.front() - hull.centre).norm();
  }

  CurvedAxis find(double far) {
    try_faces();
    if (solid_.is_cylinder) try_ends();
    if (best_.separation > far) return best_;
    for (std::size_t e = 0; e < hull_.hull->edges.size(); ++e) {
      if (may_touch_edge(hull_.hull->edges[e])) try_edge(static_cast<int>(e));
    }
    for (std::size_t i = 0; i < hull_.points.size(); ++i) try_corner(static_cast<int>(i));
    return best_;
  }

 private:
  const Vec3& point(int i) const { return hull_.points[PlacedHull::index(i)]; }
  const Vec3& normal(int f) const { return hull_.normals[PlacedHull::index(f)]; }

  double from(const Vec3& p, const Vec3& n) const { return n.dot(solid_.centre - p) - solid_.reach(n); }

  void offer(const CurvedAxis& axis) {
    if (axis.separation > best_.separation + kRoundingOf * size_) best_ = axis;
  }

  void try_faces() {
    deepest_.resize(hull_.normals.size());
    for (std::size_t f = 0; f < hull_.normals.size(); ++f) {
      const Vec3& n = hull_.normals[f];
      deepest_[f] = solid_.centre - solid_.support(n);
      offer({n.dot(solid_.centre) - solid_.reach(n) - hull_.offsets[f], n, -1, -1});
    }
  }

  void try_ends() {
    for (const Vec3& n : {solid_.axis(), Vec3(-solid_.axis())}) {
      int furthest = 0;
      for (std::size_t i = 1; i < hull_.points.size(); ++i) {
        if (n.dot(hull_.points[i]) > n.dot(point(furthest))) furthest = static_cast<int>(i);
      }
      offer({from(point(furthest), n), n, furthest, -1});
    }
  }

  // An edge touches before both of its faces only if the solid lies beyond one of them where it is deepest. A ball
  // around the solid's centre bounds the separation.
  bool may_touch_edge(const Hull::Edge& edge) const {
    const Vec3 &at = point(edge.from), along = hull_.edge(edge);
    const auto is_beyond = [&](int face, double side) {
      const Vec3 out = side * along.cross(normal(face));
      return out.dot(deepest_[PlacedHull::index(face)] - at) > -kSameWay * size_ * along.norm();
    };
    if (!is_beyond(edge.left, 1) && !is_beyond(edge.right, -1)) return false;
    const Vec3 line = solid_.centre - at;
    const double share = std::clamp(along.dot(line) / along.squaredNorm(), 0.0, 1.0);
    return (line - share * along).norm() - solid_.inradius() > best_.separation;
  }

  void try_edge(int number) {
    const Hull::Edge& edge = hull_.hull->edges[PlacedHull::index(number)];
    const Vec3 &at = point(edge.from), along = hull_.edge(edge).normalized();
    const Vec3 into_left = normal(edge.left).cross(along), into_right = along.cross(normal(edge.right));
    for (const Vec3& n : ways_from_line(solid_, at, along)) {
      if (n.dot(into_left) <= kSameWay && n.dot(into_right) <= kSameWay) offer({from(at, n), n, -1, number});
    }
  }

  void try_corner(int number) {
    const Vec3& p = point(number);
    if ((p - solid_.centre).norm() - solid_.inradius() <= best_.separation) return;
    for (const Vec3& n : ways_from_point(solid_, p)) {
      const double separation = from(p, n);
      if (separation <= best_.separation) continue;
      const double most = n.dot(p) + kSameWay * size_;
      if (std::all_of(hull_.points.begin(), hull_.points.end(),
                      [&](const Vec3& other) { return n.dot(other) <= most; }))
        offer({separation, n, number, -1});
    }
  }

  const CurvedSolid& solid_;
  const PlacedHull& hull_;
  double size_;                // m
  std::vector<Vec3> deepest_;  // by face: the solid's point that lies deepest behind it
  CurvedAxis best_;
};

// Tries directions from a curved solid to another one.
class FromCurved {
 public:
  FromCurved(const CurvedSolid& solid, const CurvedSolid& other)
      : solid_(solid), other_(other), line_(solid.centre - other.centre), size_(solid.size() + other.size()) {}

  CurvedAxis find(double far) {
    for (const auto tries : {&FromCurved::try_ends, &FromCurved::try_sides, &FromCurved::try_smooth_parts}) {
      (this->*tries)();
      if (best_.separation > far || is_surely_best()) return best_;
    }
    find_starts();
    for (const CurvedAxis& start : starts_) {
      if (std::isfinite(start.separation)) climb_from(start.n);
    }
    climb_on();
    return best_;
  }

 private:
  void try_ends() {
    for (const CurvedSolid* flat : {&other_, &solid_}) {
      if (flat->is_cylinder) offer(flat->axis()), offer(-flat->axis());
    }
  }

  void try_sides() {
    if (other_.is_cylinder) {
      for (const Vec3& n : ways_from_line(solid_, other_.centre, other_.axis())) offer(n), offer(-n);
    }
    if (solid_.is_cylinder) {
      for (const Vec3& n : ways_from_line(other_, solid_.centre, solid_.axis())) offer(n), offer(-n);
    }
  }

  void try_smooth_parts() {
    if (line_.norm() > kUpright * size_) climb_from(line_.normalized());
  }

  double separation(const Vec3& n) const { return n.dot(line_) - solid_.reach(n) - other_.reach(n); }

  void offer(const Vec3& n) {
    const double found = separation(n);
    if (found > best_.separation + kRoundingOf * size_) best_ = {found, n, -1, -1};
  }

  // A flat end of the smooth parts that face each other along `start` may be their best direction itself, and no other
  // one is unless they overlap deeply. At an end that is not, the way uphill leads away from it.
  void climb_from(Vec3 start) {
    const CurvedSolid one = smooth_part(solid_, -start), two = smooth_part(other_, start);
    const FromSolid both{one, two};
    for (const CurvedSolid* rim : {&one, &two}) {
      if (!rim->is_cylinder) continue;
      const Vec3 out = (start.dot(rim->axis()) < 0 ? -1 : 1) * rim->axis(), aside = rim->across(both(out).gradient);
      const double length = aside.norm();
      const bool is_top = length <= rim->radius();
      if (is_top && out.dot(both(out).gradient) > -kShallow * std::min(solid_.inradius(), other_.inradius())) return;
      if (!is_top && rim->across(start).norm() < kNearlyFlat) start = (out + kAway / length * aside).normalized();
    }
    offer(uphill(both, start, size_));
  }

  // A climb may have ended at a kink. From there, each pair of smooth parts may lead on. Directions around it cost more.
  // For overlaps they would help in one of 40,000.
  void climb_on() {
    constexpr int kMostRounds = 3;
    double before = -std::numeric_limits<double>::infinity();
    for (int round = 0; round < kMostRounds && best_.separation > before && !is_surely_best(); ++round) {
      before = best_.separation;
      const Vec3 n = best_.n;
      const Tangents along = tangents_of(n);
      for (const double side : {1.0, -1.0}) {
        for (const double other_side : {1.0, -1.0})
          offer(uphill(FromSolid{smooth_part(solid_, side), smooth_part(other_, other_side)}, n, size_));
        if (!(best_.separation > 0)) continue;
        for (const double aside : {1.0, -1.0}) {
          climb_from((n + kAway * std::numbers::sqrt2 / 2 * (side * along.first + aside * along.second)).normalized());
        }
        climb_from((n + kAway * side * along.first).normalized());
        climb_from((n + kAway * side * along.second).normalized());
      }
    }
  }

  // Solids that are apart are nearest where the parts that touch first face each other: the separation is concave.
  // Solids that overlap cannot be parted sooner than a point of the one leaves the other, whichever way it goes.
  bool is_surely_best() const {
    constexpr double kLevel = 1e-9;  // of the size
    const Vec3& n = best_.n;
    const TouchingPart upper(solid_, -n), lower(other_, n);
    RoundLine one = upper.line, two = lower.line;
    one.centre -= n.dot(one.centre) * n, two.centre -= n.dot(two.centre) * n;
    const auto [s, t] = nearest_on_lines(one, two);
    const Vec3 aside = two.at(t) - one.at(s);
    const double apart = aside.norm();
    if (best_.separation > 0) return apart - one.radius - two.radius < kLevel * size_;
    const auto reached = [&](const RoundLine& line, double at, double side) -> Vec3 {
      return line.at(at) + (apart > 0 ? side * std::min(1.0, line.radius / apart) : 0) * aside;
    };
    const double depth =
        std::max(depth_in(other_, reached(upper.line, s, 1)), depth_in(solid_, reached(lower.line, t, -1)));
    return depth > -best_.separation - kRoundingOf * size_;
  }

  // Smooth parts meet within the four lunes between the planes across both solids' flat axes. Of each lune, the best
  // direction of a coarse look around.
  void find_starts() {
    const Vec3 flat = flat_axis(solid_), other_flat = flat_axis(other_);
    const auto consider = [&](const Vec3& n) {
      const std::size_t lune = (n.dot(flat) < 0 ? 1u : 0u) + (n.dot(other_flat) < 0 ? 2u : 0u);
      const double found = separation(n);
      if (found > starts_[lune].separation) starts_[lune] = {found, n, -1, -1};
    };
    for (int k = 0; k < 27; ++k) {
      const Vec3 n(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (!n.isZero(0)) consider(solid_.R * n.normalized());
    }
    for (const double side : {1.0, -1.0}) {
      const Vec3 middle = flat + side * other_flat;
      if (middle.norm() > kUpright) consider(middle.normalized()), consider(-middle.normalized());
    }
    for (int axis = 0; axis < 3; ++axis) consider(other_.R.col(axis)), consider(-other_.R.col(axis));
  }

  static Vec3 flat_axis(const CurvedSolid& solid) {
    if (solid.is_cylinder) return solid.axis();
    int shortest = 0;
    solid.radii.minCoeff(&shortest);
    return solid.R.col(shortest);
  }

  const CurvedSolid& solid_;
  const CurvedSolid& other_;
  Vec3 line_;    // m, from the other's centre to the solid's
  double size_;  // m
  std::array<CurvedAxis, 4> starts_;
  CurvedAxis best_;
};

}  // namespace

CurvedAxis best_axis(const CurvedSolid& solid, const PlacedHull& hull, double far) {
  return FromHull(solid, hull).find(far);
}

CurvedAxis best_axis(const CurvedSolid& solid, const Line& line) {
  CurvedAxis best;
  const auto offer = [&](const Vec3& n, int corner, int edge) {
    const double reach = std::max(n.dot(line.from), n.dot(line.to)),
                 separation = n.dot(solid.centre) - solid.reach(n) - reach;
    if (separation > best.separation) best = {separation, n, corner, edge};
  };
  const Vec3 along = line.to - line.from;
  for (const Vec3& n : ways_from_line(solid, line.from, along.normalized())) offer(n, -1, 0);
  for (const int end : {0, 1}) {
    for (const Vec3& n : ways_from_point(solid, end == 0 ? line.from : line.to)) offer(n, end, -1);
  }
  if (solid.is_cylinder) {
    for (const Vec3& n : {solid.axis(), Vec3(-solid.axis())}) offer(n, n.dot(along) > 0 ? 1 : 0, -1);
  }
  return best;
}

CurvedAxis best_axis(const CurvedSolid& solid, const CurvedSolid& other, double far) {
  return FromCurved(solid, other).find(far);
}

}  // namespace rigor::inline dynamics
