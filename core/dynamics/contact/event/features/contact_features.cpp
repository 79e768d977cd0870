#include "core/dynamics/contact/event/features/contact_features.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "core/dynamics/collision/curved/curved_solid.h"
#include "core/dynamics/collision/side_by_side.h"
#include "core/dynamics/contact/event/features/surface_features.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline dynamics {
namespace {

using Kind = ContactFeature::Kind;

// The sine between edges whose cross product is no normal. If a line has a radius, the radii are the length of the
// common perpendicular, and any angle will do.
constexpr double kParallelEdges = 0.1;

// The rim on the side of a point in B.
ContactFeature rim_of(const Cylinder& cylinder, const Vec3& at) {
  ContactFeature rim{.kind = Kind::round,
                     .at = {0, 0, std::copysign(0.5 * cylinder.length, at.z())},
                     .direction = Vec3(at.x(), at.y(), 0).normalized()};
  rim.half_axes.diagonal() = Vec3(cylinder.radius, cylinder.radius, 0);
  return rim;
}

// A point beside the surface and the outward normal, both in B.
struct SurfacePoint {
  Vec3 at, normal;
  double height;  // m, above the surface

  Choices operator()(const Sphere& sphere) const { return {{}, {}, {.radius = sphere.radius, .is_vertex = true}}; }

  Choices operator()(const Plane& plane) const {
    return {ContactFeature{Kind::plane, plane.offset * plane.normal, plane.normal}, {}, {.at = at}};
  }

  Choices operator()(const Capsule& capsule) const {
    const double half = 0.5 * capsule.length, s = at.z() - (capsule.radius + height) * normal.z();
    const bool is_end = std::abs(s) >= half - kAtEnd * (half + capsule.radius);
    Choices choices{
        {}, {}, {.at = {0, 0, is_end ? std::copysign(half, s) : s}, .radius = capsule.radius, .is_vertex = is_end}};
    if (!is_end) choices.line = ContactFeature{Kind::line, Vec3::Zero(), Vec3::UnitZ(), capsule.radius};
    return choices;
  }

  Choices operator()(const Ellipsoid& ellipsoid) const {
    return {{}, {}, {.kind = Kind::round, .half_axes = ellipsoid.radii.asDiagonal()}};
  }

  // On a plane; what a ball touches follows from its centre.
  Choices operator()(const Cylinder& cylinder) const {
    const ContactFeature rim = rim_of(cylinder, at);
    if (std::hypot(normal.x(), normal.y()) > kUpright) return {{}, {}, rim};
    return {{}, {}, {.at = rim.at + cylinder.radius * rim.direction, .is_vertex = true}};
  }

  Choices operator()(const SurfaceShape& on) const { return choices_on_surface(*on.surface, at, normal); }

  Choices operator()(const Compound&) const { return {{}, {}, {.at = at}}; }  // its part is asked instead

  template <typename Other>
  requires(!std::is_base_of_v<SurfaceShape, Other>) Choices operator()(const Other&) const {
    throw EngineFailure(FailureKind::unsupported,
                        std::string("contact=event knows no features of a ") + Other::descriptor().word);
  }

  Choices operator()(const Convex& convex) const {
    const Hull& hull = *convex.hull;
    std::vector<int> faces;  // that the point lies on
    Choices choices;
    for (std::size_t f = 0; f < hull.faces.size(); ++f) {
      const Hull::Face& face = hull.faces[f];
      if (face.normal.dot(at) < face.offset - kOnEdge * hull.bounding_radius) continue;
      faces.push_back(static_cast<int>(f));
      if (face.normal.dot(normal) > 1 - kAligned)
        choices.plane = ContactFeature{Kind::plane, face.offset * face.normal, face.normal};
    }
    choices.point.at = at;
    choices.point.is_vertex = faces.size() > 2;
    if (choices.point.is_vertex) choices.point.at = *nearest_corner(hull);
    if (faces.size() != 2) return choices;
    for (const Hull::Edge& edge : hull.edges) {
      if (std::minmax(edge.left, edge.right) != std::minmax(faces[0], faces[1])) continue;
      const Vec3 &from = hull.points[static_cast<std::size_t>(edge.from)],
                 along = (hull.points[static_cast<std::size_t>(edge.to)] - from).normalized();
      choices.point.at = from + along.dot(at - from) * along;
      choices.line = ContactFeature{Kind::line, choices.point.at, along};
    }
    return choices;
  }

  std::vector<Vec3>::const_iterator nearest_corner(const Hull& hull) const {
    return std::min_element(hull.points.begin(), hull.points.end(), [this](const Vec3& p, const Vec3& q) {
      return (p - at).squaredNorm() < (q - at).squaredNorm();
    });
  }

  Choices operator()(const Box& box) const {
    const Vec3 half = 0.5 * box.size;
    Vec3 snapped = at;
    int count = 0, along = 0;
    Choices choices;
    for (int i = 0; i < 3; ++i) {
      if (std::abs(at[i]) < half[i] - kOnEdge * half.maxCoeff()) {
        along = i;
        continue;
      }
      ++count;
      snapped[i] = std::copysign(half[i], at[i]);
      if (std::copysign(1.0, at[i]) * normal[i] > 1 - kAligned) {
        const Vec3 outward = std::copysign(1.0, at[i]) * Vec3::Unit(i);
        choices.plane = ContactFeature{Kind::plane, half[i] * outward, outward};
      }
    }
    choices.point.at = snapped;
    choices.point.is_vertex = count == 3;
    if (count == 2) choices.line = ContactFeature{Kind::line, snapped, Vec3::Unit(along)};
    return choices;
  }
};

// From the part's frame to B.
ContactFeature placed(ContactFeature feature, const BodyPose& pose) {
  feature.at = pose.position + pose.orientation * feature.at;
  feature.direction = pose.orientation * feature.direction;
  if (feature.kind == Kind::round) feature.half_axes = matrix_of(pose.orientation) * feature.half_axes;
  return feature;
}

Choices placed(Choices choices, const BodyPose& pose) {
  if (choices.plane) choices.plane = placed(*choices.plane, pose);
  if (choices.line) choices.line = placed(*choices.line, pose);
  choices.point = placed(choices.point, pose);
  return choices;
}

// The feature that a ball touches follows from its centre, where the shape has several with one normal.
struct BesideBall {
  Vec3 at, centre;  // m, in B: on the surface, and of the ball

  // It lies outside of one, two or three sides.
  std::optional<Choices> operator()(const Box& box) const {
    const Vec3 half = 0.5 * box.size;
    Choices choices;
    Vec3 nearest = centre, outward = Vec3::Zero();
    int count = 0, along = 0;
    for (int i = 0; i < 3; ++i) {
      if (std::abs(centre[i]) < half[i] - kAtEnd * half.maxCoeff()) {
        along = i;
        continue;
      }
      ++count;
      nearest[i] = std::copysign(half[i], centre[i]), outward = std::copysign(1.0, centre[i]) * Vec3::Unit(i);
    }
    choices.point = {.at = nearest, .is_vertex = count == 3};
    if (count == 1) choices.plane = ContactFeature{Kind::plane, nearest, outward};
    if (count == 2) choices.line = ContactFeature{Kind::line, nearest, Vec3::Unit(along)};
    // The centre of a ball that is deep in the box tells nothing.
    return count > 0 ? std::optional(choices) : std::nullopt;
  }

  std::optional<Choices> operator()(const Cylinder& cylinder) const {
    const double half = 0.5 * cylinder.length, at_end = kAtEnd * std::max(half, cylinder.radius);
    const bool is_beside = std::hypot(centre.x(), centre.y()) > cylinder.radius - at_end,
               is_above = std::abs(centre.z()) > half - at_end;
    if (is_beside && is_above) return Choices{{}, {}, rim_of(cylinder, centre)};
    if (is_beside) return Choices{{}, ContactFeature{Kind::line, Vec3::Zero(), Vec3::UnitZ(), cylinder.radius}, {}};
    const Vec3 up = std::copysign(1.0, centre.z()) * Vec3::UnitZ();
    return Choices{ContactFeature{Kind::plane, half * up, up}, {}, {}};
  }

  std::optional<Choices> operator()(const SurfaceShape& on) const {
    return surface_beside_ball(*on.surface, at, centre);
  }

  template <typename Other>
  requires(!std::is_base_of_v<SurfaceShape, Other>) std::optional<Choices>
  operator()(const Other&) const { return {}; }
};

PlacedShape part_of(const Collider& collider, std::size_t part) {
  const auto* compound = std::get_if<Compound>(&collider.shape);
  return compound ? compound->parts[part] : PlacedShape{collider.shape, {}};
}

}  // namespace

RigidMotion motion_of(BodyColumns state, const Collider& collider) {
  if (std::holds_alternative<Plane>(collider.shape)) return {};
  const int i = collider.body;
  const Mat3 R = state.has_rotation() ? state.rotation(i) : matrix_of(state.orientation(i).normalized());
  return {{state.position(i), R}, state.velocity(i), state.angular_velocity(i)};
}

FeaturePair features_at(const ManifoldPoint& point, const Collider& a, const Pose& pose_a, const Collider& b,
                        const Pose& pose_b) {
  const Vec3 outward_a = -point.normal, outward_b = point.normal;
  const PlacedShape part_a = part_of(a, point.part_a), part_b = part_of(b, point.part_b);
  const auto choices_of = [&](const PlacedShape& part, const Pose& pose, const Vec3& outward) {
    if (std::holds_alternative<Plane>(part.shape)) return std::visit(SurfacePoint{point.point, outward, 0}, part.shape);
    const Mat3 to_B = pose.R.transpose();
    const Quat to_part = part.pose.orientation.conjugate();
    const Vec3 at = to_part * (to_B * (point.point - pose.p) - part.pose.position);
    return placed(std::visit(SurfacePoint{at, to_part * (to_B * outward), 0.5 * point.gap}, part.shape), part.pose);
  };
  Choices of_a = choices_of(part_a, pose_a, outward_a), of_b = choices_of(part_b, pose_b, outward_b);
  const auto take_ball = [&](const PlacedShape& part, const Pose& pose, const Vec3& outward,
                             const ContactFeature& ball) -> std::optional<Choices> {
    if (!ball.is_vertex || !(ball.radius > 0)) return {};
    const auto in_part = [&](const Vec3& p) -> Vec3 {
      return part.pose.orientation.conjugate() * (pose.R.transpose() * (p - pose.p) - part.pose.position);
    };
    const Vec3 on = point.point + 0.5 * point.gap * outward;
    std::optional<Choices> choices =
        std::visit(BesideBall{in_part(on), in_part(on + ball.radius * outward)}, part.shape);
    if (choices) choices = placed(*choices, part.pose);
    return choices;
  };
  of_a = take_ball(part_a, pose_a, outward_a, of_b.point).value_or(of_a);
  of_b = take_ball(part_b, pose_b, outward_b, of_a.point).value_or(of_b);
  for (auto& [choices, pose] : {std::pair(&of_a, &pose_a), {&of_b, &pose_b}})
    if (choices->point.kind == Kind::round) choices->point.direction = pose->R * choices->point.direction;
  if (of_a.line && of_b.line) {
    const Vec3 across = (pose_a.R * of_a.line->direction).cross(pose_b.R * of_b.line->direction);
    const double parallel = of_a.line->radius + of_b.line->radius > 0 ? kParallelLines : kParallelEdges;
    if (across.norm() > parallel) return {*of_a.line, *of_b.line, across.dot(point.normal) < 0 ? -1.0 : 1.0};
  }
  // If two sides lie on each other, the one with a corner there gives the point.
  if (of_b.plane && !(of_a.plane && of_b.point.is_vertex && !of_a.point.is_vertex)) return {of_a.point, *of_b.plane};
  if (of_a.plane) return {*of_a.plane, of_b.point};
  if (of_a.point.radius + of_b.point.radius > 0) {
    if (of_b.line) return {of_a.point, *of_b.line};
    if (of_a.line) return {*of_a.line, of_b.point};
    return {of_a.point, of_b.point};
  }
  // Two corners, a corner on an edge, or two edges side by side: no normal is theirs but the one found here.
  return {of_a.point, {Kind::plane, of_b.point.at, pose_b.R.transpose() * point.normal}};
}

}  // namespace rigor::inline dynamics
