#include "cases/metrics/measures/shape_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "cases/metrics/measures/convex_distance.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A sphere is a capsule without length: both are the points within a radius of a segment.
struct Rod {
  Vec3 middle, half;  // m, in W: its ends are middle ± half
  double radius;      // m
};

struct Cuboid {
  Vec3 centre;
  Mat3 axes;  // its columns, in W
  Vec3 half;  // m, along them
};

Rod rod_of(const Sphere& s, const BodyPose& pose) { return {pose.position, Vec3::Zero(), s.radius}; }
Rod rod_of(const Capsule& c, const BodyPose& pose) {
  return {pose.position, pose.orientation * Vec3(0, 0, c.length / 2), c.radius};
}
Cuboid cuboid_of(const Box& b, const BodyPose& pose) {
  return {pose.position, pose.orientation.toRotationMatrix(), b.size / 2};
}

double point_to_rod(const Vec3& p, const Rod& rod) {
  const double square = rod.half.squaredNorm();
  const double share = square > 0 ? std::clamp((p - rod.middle).dot(rod.half) / square, -1.0, 1.0) : 0;
  return (p - rod.middle - share * rod.half).norm();
}

// The nearest points of two segments lie inside both, or one of them is an end.
double between(const Rod& a, const Rod& b) {
  double least = std::min({point_to_rod(a.middle + a.half, b), point_to_rod(a.middle - a.half, b),
                           point_to_rod(b.middle + b.half, a), point_to_rod(b.middle - b.half, a)});
  const double aa = a.half.squaredNorm(), bb = b.half.squaredNorm(), ab = a.half.dot(b.half), both = aa * bb - ab * ab;
  if (both > 1e-14 * aa * bb) {  // else they are parallel, and an end is as near as any point
    const Vec3 apart = b.middle - a.middle;
    const double s = (bb * a.half.dot(apart) - ab * b.half.dot(apart)) / both,
                 t = (ab * a.half.dot(apart) - aa * b.half.dot(apart)) / both;
    if (std::abs(s) <= 1 && std::abs(t) <= 1) least = std::min(least, (apart + t * b.half - s * a.half).norm());
  }
  return least - a.radius - b.radius;
}

// The signed distance of a point from a box's surface, negative inside.
double point_to_box(const Vec3& p, const Cuboid& box) {
  const Vec3 beyond = (box.axes.transpose() * (p - box.centre)).cwiseAbs() - box.half;
  return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

// A signed distance from a convex body is a convex function of the point: along a segment a golden section finds its
// least value.
double between(const Rod& rod, const Cuboid& box) {
  const auto at = [&](double share) { return point_to_box(rod.middle + share * rod.half, box); };
  if (rod.half.isZero(0)) return at(0) - rod.radius;
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kRounds = 70;  // 0.618^70 is 2e-15
  double low = -1, high = 1;
  for (int n = 0; n < kRounds; ++n) {
    const double width = kGolden * (high - low), one = high - width, other = low + width;
    (at(one) <= at(other) ? high : low) = at(one) <= at(other) ? other : one;
  }
  return std::min({at(0.5 * (low + high)), at(-1), at(1)}) - rod.radius;
}

// Separating axes: the faces' normals and the edges' cross products (Gottschalk, Lin, Manocha, OBBTree, 1996). One of
// them is the direction of least overlap of two boxes.
double between(const Cuboid& a, const Cuboid& b) {
  const Vec3 apart = b.centre - a.centre;
  double widest = -kInfinity;
  const auto try_axis = [&](const Vec3& axis) {
    const double length = axis.norm();
    if (length < 1e-9) return;  // two edges along one line: the faces' axes say it
    const double reach =
        (a.axes.transpose() * axis).cwiseAbs().dot(a.half) + (b.axes.transpose() * axis).cwiseAbs().dot(b.half);
    widest = std::max(widest, (std::abs(apart.dot(axis)) - reach) / length);
  };
  for (const Vec3 of_a : a.axes.colwise()) {
    try_axis(of_a);
    for (const Vec3 of_b : b.axes.colwise()) try_axis(of_a.cross(of_b));
  }
  for (const Vec3 of_b : b.axes.colwise()) try_axis(of_b);
  return widest;
}

double between(const Cuboid& box, const Rod& rod) { return between(rod, box); }

struct Extent {
  double low, high;  // m, along the axis of sorting
  int body;
};

BodyPose pose_of(BodyColumns bodies, int i) { return {bodies.position(i), bodies.orientation(i).normalized()}; }

bool is_plane(const Body& body) { return std::holds_alternative<Plane>(*body.shape); }

bool is_rod_or_box(const Shape& shape) {
  return std::holds_alternative<Sphere>(shape) || std::holds_alternative<Capsule>(shape) ||
         std::holds_alternative<Box>(shape);
}

double gap_of_rods_and_boxes(const Shape& a, const BodyPose& pose_a, const Shape& b, const BodyPose& pose_b) {
  const auto with = [](const auto& shape, const BodyPose& pose, const auto& then) {
    if (const auto* s = std::get_if<Sphere>(&shape)) return then(rod_of(*s, pose));
    if (const auto* c = std::get_if<Capsule>(&shape)) return then(rod_of(*c, pose));
    return then(cuboid_of(std::get<Box>(shape), pose));
  };
  return with(a, pose_a,
              [&](const auto& one) { return with(b, pose_b, [&](const auto& other) { return between(one, other); }); });
}

double over_plane(const Plane& plane, const Shape& shape, const BodyPose& pose) {
  const Vec3 down = -(pose.orientation.conjugate() * plane.normal);
  return plane.normal.dot(pose.position) - down.dot(support(shape, down)) - plane.offset;
}

Pose matrix_pose(const BodyPose& pose) { return {pose.position, matrix_of(pose.orientation)}; }

// m, of a point from a surface, in its frame; negative behind it. Beyond the border of a height field nothing is
// behind.
double point_to_surface(const Vec3& p, const Shape& on) {
  const TriangleSurface& surface = *surface_in(on)->surface;
  const Vec3 nearest = surface.nearest(p, kInfinity), line = p - nearest;
  const double distance = line.norm(), same = 1e-9 * surface.bounding_radius;
  const auto* field = std::get_if<Heightfield>(&on);
  if (field && (std::abs(p.x()) > 0.5 * field->size[0] || std::abs(p.y()) > 0.5 * field->size[1])) return distance;
  std::vector<int> around;
  surface.find_near(nearest - Vec3::Constant(same), nearest + Vec3::Constant(same), around);
  bool is_behind = true;
  for (const int t : around) {
    const auto& triangle = surface.triangles[static_cast<std::size_t>(t)];
    if ((surface.nearest_on(triangle, p) - nearest).norm() <= same)
      is_behind = is_behind && line.dot(triangle.normal) < 0;
  }
  return is_behind ? -distance : distance;
}

// Of the nearest points of both, because a surface is not convex. The search for these leaves out what is far, and a
// body whose centre is behind the surface. The first gets the least gap that it can have, the other the least depth.
double gap_on_surface(const Shape& a, const BodyPose& pose_a, const Shape& b, const BodyPose& pose_b) {
  if (surface_in(a)) return surface_in(b) ? kInfinity : gap_on_surface(b, pose_b, a, pose_a);
  const double centre =
      point_to_surface((inverse(pose_b) * BodyPose{pose_a.position + pose_a.orientation * centre_of(a)}).position, b);
  if (centre < 0) return centre - inradius(a);
  Manifold points;
  collide(a, matrix_pose(pose_a), b, matrix_pose(pose_b), points);
  if (points.size() == 0) return std::max(centre - bounding_radius(a) - centre_of(a).norm(), 0.0);
  double least = kInfinity;
  for (const ManifoldPoint& point : points) least = std::min(least, point.gap);
  return least;
}

// Neither shape is a compound.
double gap_of_parts(const Shape& a, const BodyPose& pose_a, const Shape& b, const BodyPose& pose_b) {
  const auto *plane_a = std::get_if<Plane>(&a), *plane_b = std::get_if<Plane>(&b);
  if (plane_a && plane_b) return kInfinity;  // neither moves
  if (plane_a) return over_plane(*plane_a, b, pose_b);
  if (plane_b) return over_plane(*plane_b, a, pose_a);
  if (surface_in(a) || surface_in(b)) return gap_on_surface(a, pose_a, b, pose_b);
  if (is_rod_or_box(a) && is_rod_or_box(b)) return gap_of_rods_and_boxes(a, pose_a, b, pose_b);
  return convex_distance(a, matrix_pose(pose_a), b, matrix_pose(pose_b)).gap;
}

}  // namespace

double shape_gap(const Shape& a, const BodyPose& pose_a, const Shape& b, const BodyPose& pose_b) {
  double least = kInfinity;
  for_each_part(a, [&](const Shape& part_a, const BodyPose& in_a) {
    for_each_part(b, [&](const Shape& part_b, const BodyPose& in_b) {
      least = std::min(least, gap_of_parts(part_a, pose_a * in_a, part_b, pose_b * in_b));
    });
  });
  return least;
}

void for_each_near_pair(const Scene& scene, BodyColumns bodies, double reach,
                        const std::function<void(int a, int b, double gap)>& visit) {
  std::vector<Extent> extents;
  std::vector<int> planes;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.collides) continue;
    if (is_plane(body)) {
      planes.push_back(i);
      continue;
    }
    const double radius = bounding_radius(*body.shape), x = bodies.column(kPosition)[i];
    extents.push_back({x - radius - reach, x + radius, i});
  }
  std::sort(extents.begin(), extents.end(), [](const Extent& a, const Extent& b) { return a.low < b.low; });
  const ContactLaws laws(scene);
  const auto look = [&](int a, int b) {
    const Body &one = scene.bodies[a], &other = scene.bodies[b];
    if ((one.fixed && other.fixed) || !laws.may_touch(a, b)) return;
    const double gap = shape_gap(*one.shape, pose_of(bodies, a), *other.shape, pose_of(bodies, b));
    if (gap < reach) visit(a, b, gap);
  };
  for (std::size_t i = 0; i < extents.size(); ++i) {
    for (const int plane : planes) {
      const auto [a, b] = std::minmax({extents[i].body, plane});
      look(a, b);
    }
    for (std::size_t j = i + 1; j < extents.size() && extents[j].low <= extents[i].high; ++j) {
      const int a = extents[i].body, b = extents[j].body;
      const double radii = bounding_radius(*scene.bodies[a].shape) + bounding_radius(*scene.bodies[b].shape) + reach;
      if ((bodies.position(a) - bodies.position(b)).squaredNorm() <= radii * radii)
        look(std::min(a, b), std::max(a, b));
    }
  }
}

}  // namespace rigor::inline metric
