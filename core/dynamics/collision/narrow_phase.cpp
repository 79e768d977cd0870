#include "core/dynamics/collision/narrow_phase.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/dynamics/collision/curved/collide_curved.h"
#include "core/dynamics/collision/side_by_side.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline dynamics {
namespace {

// Two balls; every pair of round shapes reduces to them. If the centres coincide, any direction is used.
void add_balls(const Vec3& a, double radius_a, const Vec3& b, double radius_b, std::uint32_t feature, Manifold& out) {
  const Vec3 line = a - b;
  const double distance = line.norm();
  const Vec3 n = distance > 0 ? Vec3(line / distance) : Vec3::UnitZ();
  const double gap = distance - radius_a - radius_b;
  out.add(n, b + (radius_b + 0.5 * gap) * n, gap, feature);
}

void add_ball_on_plane(const Vec3& centre, double radius, const Plane& plane, std::uint32_t feature, Manifold& out) {
  const double gap = plane.normal.dot(centre) - plane.offset - radius;
  out.add(plane.normal, centre - (radius + 0.5 * gap) * plane.normal, gap, feature);
}

Vec3 axis_of(const Pose& pose) { return pose.R.col(2); }

double nearest_on_axis(const Vec3& point, const Capsule& capsule, const Pose& pose) {
  return std::clamp(axis_of(pose).dot(point - pose.p), -0.5 * capsule.length, 0.5 * capsule.length);
}

RoundLine line_of(const Capsule& capsule, const Pose& pose) {
  return {pose.p, axis_of(pose), 0.5 * capsule.length, capsule.radius};
}

template <typename Type>
constexpr bool kIsCurved = std::is_same_v<Type, Cylinder> || std::is_same_v<Type, Ellipsoid>;
template <typename Type>
constexpr bool kIsPolyhedron = std::is_same_v<Type, Box> || std::is_same_v<Type, Convex>;

// Each pair in one order of its shapes; the normal points from the second to the first.
struct Exact {
  const Pose& a;
  const Pose& b;
  Manifold& out;
  double far;

  void operator()(const Sphere& sphere, const Sphere& other) const {
    add_balls(a.p, sphere.radius, b.p, other.radius, 0, out);
  }

  void operator()(const Plane& plane, const Sphere& sphere) const {
    add_ball_on_plane(b.p, sphere.radius, plane, 0, out);
    out[0].normal *= -1;
  }

  void operator()(const Capsule& capsule, const Sphere& sphere) const {
    const Vec3 nearest = a.p + nearest_on_axis(b.p, capsule, a) * axis_of(a);
    add_balls(nearest, capsule.radius, b.p, sphere.radius, 0, out);
  }

  void operator()(const Capsule& capsule, const Plane& plane) const {
    for (const std::uint32_t end : {0u, 1u}) {
      const Vec3 centre = a.p + (end ? 0.5 : -0.5) * capsule.length * axis_of(a);
      add_ball_on_plane(centre, capsule.radius, plane, end, out);
    }
  }

  void operator()(const Capsule& capsule, const Capsule& other) const {
    const RoundLine one = line_of(capsule, a), beside = line_of(other, b);
    if (add_side_by_side(one, beside, out)) return;
    const auto [s, t] = nearest_on_lines(one, beside);
    add_on_lines(one, s, beside, t, 2, out);
  }

  void operator()(const Box& box, const Plane& plane) const {
    const Vec3 half = 0.5 * box.size;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
      const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      add_ball_on_plane(a.p + a.R * sign.cwiseProduct(half), 0, plane, corner, out);
    }
  }

  void operator()(const Box& box, const Sphere& sphere) const {
    const Vec3 half = 0.5 * box.size, centre = a.R.transpose() * (b.p - a.p);
    const Vec3 nearest = centre.cwiseMax(-half).cwiseMin(half), line = nearest - centre;
    const double distance = line.norm();
    Vec3 n_B;
    double depth;  // of the centre below the box's surface
    if (distance > 0) {
      n_B = line / distance, depth = -distance;
    } else {
      int axis = 0;
      depth = (half - centre.cwiseAbs()).minCoeff(&axis);
      n_B = (centre[axis] < 0 ? 1.0 : -1.0) * Vec3::Unit(axis);
    }
    const double gap = -depth - sphere.radius;
    const Vec3 n = a.R * n_B;
    out.add(n, b.p + (sphere.radius + 0.5 * gap) * n, gap, 0);
  }

  void operator()(const Box& box, const Box& other) const { collide_boxes(box, a, other, b, out); }
  void operator()(const Box& box, const Capsule& capsule) const { collide_box_capsule(box, a, capsule, b, out); }

  void operator()(const Box& box, const Convex& convex) const { collide_hulls(box, a, convex, b, out); }
  void operator()(const Capsule& capsule, const Convex& convex) const {
    collide_capsule_hull(capsule, a, convex, b, out);
  }
  void operator()(const Convex& convex, const Convex& other) const { collide_hulls(convex, a, other, b, out); }
  void operator()(const Convex& convex, const Plane& plane) const { collide_hull_plane(convex, a, plane, out); }
  void operator()(const Convex& convex, const Sphere& sphere) const { collide_hull_sphere(convex, a, sphere, b, out); }
  void operator()(const Cylinder& cylinder, const Plane& plane) const {
    collide_cylinder_plane(cylinder, a, plane, out);
  }
  void operator()(const Cylinder& cylinder, const Sphere& sphere) const {
    collide_cylinder_sphere(cylinder, a, sphere, b, out);
  }
  void operator()(const Ellipsoid& ellipsoid, const Plane& plane) const {
    collide_ellipsoid_plane(ellipsoid, a, plane, out);
  }
  void operator()(const Ellipsoid& ellipsoid, const Sphere& sphere) const {
    collide_ellipsoid_sphere(ellipsoid, a, sphere, b, out);
  }

  template <typename Curved, typename Hull>
  requires(kIsCurved<Curved>&& kIsPolyhedron<Hull>) void operator()(const Curved& curved, const Hull& hull) const {
    collide_curved(CurvedSolid(curved, a), hull, b, out, far);
  }
  template <typename Curved>
  requires(kIsCurved<Curved>) void operator()(const Capsule& capsule, const Curved& curved) const {
    collide_curved(capsule, a, CurvedSolid(curved, b), out);
  }
  template <typename Curved, typename Other>
  requires(kIsCurved<Curved>&& kIsCurved<Other>) void operator()(const Curved& curved, const Other& other) const {
    collide_curved(CurvedSolid(curved, a), CurvedSolid(other, b), out, far);
  }
  template <typename Curved>
  requires(kIsCurved<Curved>) void operator()(const Curved& curved, const SurfaceShape& on) const {
    collide_curved(CurvedSolid(curved, a), *on.surface, b, out);
  }

  template <typename Convexes>
  requires requires(const Convexes& it, const TriangleSurface& on, const Pose& at, Manifold& m) {
    collide_surface(it, at, on, at, m);
  }
  void operator()(const Convexes& convex, const SurfaceShape& on) const {
    collide_surface(convex, a, *on.surface, b, out);
  }

  void operator()(const Plane&, const Plane&) const {}
};

template <typename A, typename B>
constexpr bool kIsExact = std::is_invocable_v<Exact, const A&, const B&>;

void reverse(Manifold& points) {
  for (ManifoldPoint& point : points) point.normal *= -1, std::swap(point.part_a, point.part_b);
}

struct Collide {
  const Shape& of_a;
  const Shape& of_b;
  const Pose& a;
  const Pose& b;
  Manifold& out;
  double far;

  template <typename A, typename B>
  void operator()(const A& first, const B& second) const {
    if constexpr (std::is_same_v<A, Compound> || std::is_same_v<B, Compound>) {
      collide_parts();
    } else if constexpr (kIsExact<A, B>) {
      Exact{a, b, out, far}(first, second);
    } else if constexpr (kIsExact<B, A>) {
      Exact{b, a, out, far}(second, first);
      reverse(out);
    } else {
      // Two that stand still never meet. Of others, no method has the feature (contacts_in_collision).
      if (!(kStandsStill<A> && kStandsStill<B>))
        throw EngineFailure(FailureKind::unsupported,
                            "the core has no contacts of " + shape_name(of_a) + " with " + shape_name(of_b));
    }
  }

  // The points of each two parts. Their features differ by the numbers of the parts.
  void collide_parts() const {
    Manifold points;
    std::uint16_t part_a = 0;
    for_each_part(of_a, [&](const Shape& shape_a, const BodyPose& pose_a) {
      std::uint16_t part_b = 0;
      for_each_part(of_b, [&](const Shape& shape_b, const BodyPose& pose_b) {
        const bool a_is_placed = std::holds_alternative<Compound>(of_a),
                   b_is_placed = std::holds_alternative<Compound>(of_b);
        collide(shape_a, a_is_placed ? a * pose_a : a, shape_b, b_is_placed ? b * pose_b : b, points, far);
        for (ManifoldPoint point : points) {
          // A surface has numbers of its own: those of the regions that are touched.
          if (a_is_placed) point.part_a = part_a;
          if (b_is_placed) point.part_b = part_b;
          point.feature ^= 0x9E3779B1u * part_a + 0x85EBCA77u * part_b;
          add_nearest(point);
        }
        ++part_b;
      });
      ++part_a;
    });
  }

  void add_nearest(const ManifoldPoint& point) const {
    if (out.size() < Manifold::kMost) return out.add(point);
    const auto furthest =
        std::max_element(out.begin(), out.end(), [](const auto& x, const auto& y) { return x.gap < y.gap; });
    if (point.gap < furthest->gap) *furthest = point;
  }
};

template <typename A, typename... Types>
void insert_contacts_of(const std::variant<Types...>*, Features& out) {
  constexpr bool is_exact[] = {kIsExact<A, Types> || kIsExact<Types, A>...};
  constexpr Feature contacts[] = {contact_feature<A, Types>()...};
  for (std::size_t k = 0; k < sizeof...(Types); ++k)
    if (is_exact[k] && can_meet(index_among<A>(static_cast<const Shape*>(nullptr)), static_cast<int>(k)))
      out.insert(contacts[k]);
}

template <typename... Types>
Features contacts_of(const std::variant<Types...>* shapes) {
  Features contacts;
  (insert_contacts_of<Types>(shapes, contacts), ...);
  return contacts;
}

}  // namespace

Features contacts_in_collision() { return contacts_of(static_cast<const Shape*>(nullptr)); }

bool put_crossing(const ManifoldPoint& crossing, double reach, int first, Manifold& out) {
  ManifoldPoint* nearest = std::min_element(out.begin() + first, out.end(), [&](const auto& one, const auto& other) {
    return (one.point - crossing.point).squaredNorm() < (other.point - crossing.point).squaredNorm();
  });
  if (nearest == out.end() || (nearest->point - crossing.point).norm() > reach) return out.keep(first), false;
  nearest->normal = crossing.normal, nearest->point = crossing.point, nearest->gap = crossing.gap;
  return true;
}

void collide(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Manifold& out, double far) {
  out.clear();
  std::visit(Collide{a, b, pose_a, pose_b, out, far}, a, b);
}

}  // namespace rigor::inline dynamics
