#include "core/dynamics/collision/curved/flat_areas.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rigor::inline dynamics {
namespace {

// Numbers of features, so that none is used twice in a manifold.
constexpr std::uint32_t kOfRim = 0, kOfLine = 32, kOfTip = 0x100, kOfCrossing = 0x10000, kOfCorner = 0x1000000;
constexpr std::size_t kMostCornersOfFace = 16;
// Of a radius. A rim that passes a border by less does not cross it: rounding would move these crossings far.
constexpr double kNearBorder = 1e-3;
constexpr double kSteep = 0.5;  // the cosine between an end and n below which the end holds no corners of the other

// The point straight below or above p, along n, in a plane through `in_plane` across `normal`.
Vec3 along_onto(const Vec3& p, const Vec3& n, const Vec3& in_plane, const Vec3& normal) {
  return p + normal.dot(in_plane - p) / normal.dot(n) * n;
}

// A side of a face, as a plane that holds n: a point p is outside if out · p > offset.
struct SidePlane {
  Vec3 out;
  double offset;
};

SidePlane side_of(const FlatFace& face, std::size_t k, const Vec3& n) {
  const Vec3 out = (face.corner(k + 1) - face.corner(k)).cross(n).normalized();
  return {out, out.dot(face.corner(k))};
}

// Whether p lies over the face. A point that lies outside by less than `near` [m] is moved onto the border.
bool is_over(const FlatFace& face, Vec3& p, double near, const AreaPoints& to, std::size_t but = ~std::size_t{0}) {
  for (std::size_t k = 0; k < face.count(); ++k) {
    if (k == but) continue;
    const SidePlane side = side_of(face, k, to.n);
    const double outside = side.out.dot(p) - side.offset;
    if (outside > near) return false;
    if (outside > to.outside) p -= outside * side.out;
  }
  return true;
}

// Adds the points where the rim crosses a side of the face, and that of the rim which lies furthest inside of it.
void add_crossings(const Disc& upper, const FlatFace& lower, std::size_t k, const AreaPoints& to) {
  const SidePlane side = side_of(lower, k, to.n);
  const Vec3 beside = side.out - side.out.dot(upper.out) * upper.out;
  const double length = beside.norm(), distance = side.offset - side.out.dot(upper.centre);
  if (!(std::abs(distance) < length * upper.radius * (1 - kNearBorder))) return;
  const Vec3 outward = beside / length, aside = upper.out.cross(outward);
  const double share = distance / (length * upper.radius), rest = std::sqrt(1 - share * share);
  const auto add = [&](const Vec3& direction, std::uint32_t feature) {
    Vec3 on_rim = upper.centre + upper.radius * direction;
    if (is_over(lower, on_rim, kNearBorder * upper.radius, to, k))
      to.add(on_rim, along_onto(on_rim, to.n, lower.corner(0), lower.normal()),
             feature + static_cast<std::uint32_t>(k));
  };
  add(share * outward + rest * aside, kOfCrossing), add(share * outward - rest * aside, 2 * kOfCrossing);
  add(-outward, kOfTip);
}

// The part of a line inside of a border, from 0 to 1. Each cut leaves at + share * rate <= 0.
struct PartOfLine {
  double low = 0, high = 1;

  void cut(double at, double rate) {
    if (rate == 0 && at > 0) high = -1;
    if (rate > 0) high = std::min(high, -at / rate);
    if (rate < 0) low = std::max(low, -at / rate);
  }
};

template <typename Onto>
void add_part(const Line& line, const PartOfLine& part, const AreaPoints& to, const Onto& onto) {
  if (!(part.low <= part.high)) return;
  for (const std::uint32_t end : {0u, 1u}) {
    if (end == 1 && part.low == part.high) return;
    const Vec3 p = line.from + (end == 0 ? part.low : part.high) * (line.to - line.from);
    to.add(p, onto(p), kOfLine + (line.is_from_top ? 1 - end : end));
  }
}

bool is_inside(const Disc& disc, const Vec3& in_plane) { return (in_plane - disc.centre).norm() <= disc.radius; }

// Adds the points where two rims cross, seen along n, and those of each that lie furthest inside of the other. Returns
// false if they do not cross.
bool add_lens(const Disc& upper, const Disc& lower, const AreaPoints& to) {
  const Vec3 line = along_onto(upper.centre, to.n, lower.centre, lower.out) - lower.centre;
  const double distance = line.norm(), R = lower.radius, r = upper.radius;
  if (!(distance > std::abs(R - r) + kNearBorder * std::min(R, r) && distance < R + r)) return false;
  const Vec3 along = line / distance, aside = lower.out.cross(along);
  const double x = (distance * distance + R * R - r * r) / (2 * distance), y = std::sqrt(std::max(0.0, R * R - x * x));
  const auto add = [&](const Vec3& on_lower, std::uint32_t feature) {
    to.add(along_onto(on_lower, to.n, upper.centre, upper.out), on_lower, feature);
  };
  add(lower.centre + x * along + y * aside, kOfCrossing), add(lower.centre + x * along - y * aside, 2 * kOfCrossing);
  // Either of two cylinders may count as the upper one: its features must be the same.
  const std::uint32_t of_lower = to.is_reversed ? 0 : 1;
  add(lower.centre + R * along, kOfTip + of_lower), add(lower.centre + (distance - r) * along, kOfTip + 1 - of_lower);
  return true;
}

// The deepest point of a tilted rim is known from the line on the side.
template <typename Add>
void for_each_rim_point(const Disc& disc, const AreaPoints& to, const Add& add) {
  const RimPoints points(disc, to.n);
  const bool is_tilted = !lies_flat(disc, to.n);
  for (const RimPoint& point : points) {
    if (!is_tilted || &point != points.begin()) add(point);
  }
}

// Of an end that lies flat, keeps the four points from `first` on that hold the area best, and the deepest one if that
// lies deeper. The choice follows from places alone: with gaps, rounding would choose anew in each step.
void keep_spread(int first, Manifold& out) {
  constexpr double kEqual = 1e-6, kDeeper = 1e-5;  // of the area's width
  constexpr int kMostOfArea = 4;
  const int count = out.size() - first;
  if (count <= kMostOfArea) return;
  ManifoldPoint* points = out.begin() + first;
  const ManifoldPoint deepest =
      *std::min_element(points, out.end(), [](const auto& p, const auto& q) { return p.gap < q.gap; });
  Vec3 centre = Vec3::Zero();
  for (int i = 0; i < count; ++i) centre += points[i].point / count;
  double width = 0;
  for (int i = 0; i < count; ++i) width = std::max(width, (points[i].point - centre).norm());
  const auto take = [&](int at, const auto& score) {
    int best = at;
    for (int i = at + 1; i < count; ++i) {
      if (score(points[i].point) > score(points[best].point) + kEqual * width) best = i;
    }
    std::swap(points[at], points[best]);
  };
  take(0, [&](const Vec3& p) { return (p - centre).norm(); });
  take(1, [&](const Vec3& p) { return (p - points[0].point).norm(); });
  const Vec3 side = points[0].normal.cross(points[1].point - points[0].point).normalized();
  take(2, [&](const Vec3& p) { return std::abs(side.dot(p - points[0].point)); });
  const double sign = side.dot(points[2].point - points[0].point) < 0 ? 1 : -1;
  take(3, [&](const Vec3& p) { return sign * side.dot(p - points[0].point); });
  double least = points[0].gap;
  for (int i = 1; i < kMostOfArea; ++i) least = std::min(least, points[i].gap);
  out.keep(first + kMostOfArea);
  if (deepest.gap < least - kDeeper * width) out.add(deepest);
}

void add_end(const Disc& upper, const FlatFace& lower, const AreaPoints& to) {
  for_each_rim_point(upper, to, [&](const RimPoint& point) {
    Vec3 at = point.at;
    if (is_over(lower, at, kNearBorder * upper.radius, to))
      to.add(at, along_onto(at, to.n, lower.corner(0), lower.normal()), kOfRim + point.feature);
  });
  for (std::size_t k = 0; k < lower.count(); ++k) add_crossings(upper, lower, k, to);
  if (std::abs(upper.out.dot(to.n)) < kSteep) return;
  const std::size_t step = (lower.count() + kMostCornersOfFace - 1) / kMostCornersOfFace;
  for (std::size_t k = 0; k < lower.count(); k += step) {
    const Vec3 on_end = along_onto(lower.corner(k), to.n, upper.centre, upper.out);
    if (is_inside(upper, on_end)) to.add(on_end, lower.corner(k), kOfCorner + static_cast<std::uint32_t>(k));
  }
}

// The point of a rim over or below a disc. One that lies outside by less than kNearBorder is moved onto its rim.
std::optional<Vec3> opposite(const Vec3& on_rim, const Disc& disc, const AreaPoints& to) {
  const Vec3 at = along_onto(on_rim, to.n, disc.centre, disc.out);
  const double distance = (at - disc.centre).norm();
  if (distance <= disc.radius) return at;
  if (distance > disc.radius * (1 + kNearBorder)) return std::nullopt;
  return disc.centre + disc.radius / distance * (at - disc.centre);
}

// Two ends that lie flat on each other: the smaller one, or both where they cross.
void add_end(const Disc& upper, const Disc& lower, const AreaPoints& to) {
  const bool is_flat = lies_flat(upper, to.n), has_lens = is_flat && add_lens(upper, lower, to);
  const double larger = (upper.radius - lower.radius) / lower.radius;
  const bool is_lower_smaller = larger > kNearBorder || (larger > -kNearBorder && to.is_reversed);
  if (is_flat && !has_lens && is_lower_smaller) {
    for (const RimPoint& point : RimPoints(lower, -to.n)) {
      if (const auto above = opposite(point.at, upper, to)) to.add(*above, point.at, kOfRim + point.feature);
    }
    return;
  }
  for_each_rim_point(upper, to, [&](const RimPoint& point) {
    if (has_lens && point.feature % 8 != RimPoints::kDeepest) return;
    if (const auto below = opposite(point.at, lower, to)) to.add(point.at, *below, kOfRim + point.feature);
  });
}

void add_line(const Line& upper, const FlatFace& lower, const AreaPoints& to) {
  PartOfLine part;
  for (std::size_t k = 0; k < lower.count(); ++k) {
    const SidePlane side = side_of(lower, k, to.n);
    part.cut(side.out.dot(upper.from) - side.offset - to.outside, side.out.dot(upper.to - upper.from));
  }
  add_part(upper, part, to, [&](const Vec3& p) { return along_onto(p, to.n, lower.corner(0), lower.normal()); });
}

void add_line(const Line& upper, const Disc& lower, const AreaPoints& to) {
  const auto onto = [&](const Vec3& p) { return along_onto(p, to.n, lower.centre, lower.out); };
  const Vec3 from = onto(upper.from) - lower.centre, along = onto(upper.to) - lower.centre - from;
  const double radius = lower.radius + to.outside, aa = along.squaredNorm(), ab = along.dot(from),
               bb = from.squaredNorm() - radius * radius, square = ab * ab - aa * bb;
  PartOfLine part;
  if (square < 0 || (aa == 0 && bb > 0)) return;
  if (aa > 0) {
    const double root = std::sqrt(square);
    part.low = std::max(part.low, (-ab - root) / aa), part.high = std::min(part.high, (-ab + root) / aa);
  }
  add_part(upper, part, to, onto);
}

template <typename Lower>
void add_reduced_end(const Disc& upper, const Lower& lower, const AreaPoints& to) {
  const int first = to.out.size();
  add_end(upper, lower, to);
  if (lies_flat(upper, to.n)) keep_spread(first, to.out);
}

template <typename Lower>
void add_cylinder(const CurvedSolid& upper, const Lower& lower, const AreaPoints& to) {
  const Disc end = end_against(upper, to.n);
  if (!lies_flat(end, to.n)) add_line(deepest_line(upper, to.n), lower, to);
  add_reduced_end(end, lower, to);
}

}  // namespace

void add_area(const CurvedSolid& upper, const FlatFace& lower, const AreaPoints& to) { add_cylinder(upper, lower, to); }
void add_area(const CurvedSolid& upper, const Disc& lower, const AreaPoints& to) { add_cylinder(upper, lower, to); }
void add_area(const Disc& upper, const FlatFace& lower, const AreaPoints& to) { add_reduced_end(upper, lower, to); }
void add_area(const Line& upper, const Disc& lower, const AreaPoints& to) { add_line(upper, lower, to); }

}  // namespace rigor::inline dynamics
