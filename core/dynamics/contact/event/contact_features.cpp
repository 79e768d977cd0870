#include "core/dynamics/contact/event/contact_features.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/dynamics/collision/side_by_side.h"

namespace rigor {
namespace {

using Kind = ContactFeature::Kind;

constexpr double kOnEdge = 1e-7;    // of a body's size: how near an edge a point counts as on it
constexpr double kAligned = 1e-12;  // 1 - the cosine between a normal and a side's: 1.4e-6 rad
// The sine between edges whose cross product is no normal. If a line has a radius, the radii are the length of the
// common perpendicular, and any angle will do.
constexpr double kParallelEdges = 0.1;

// What a shape may touch with at one of its surface's points.
struct Choices {
  std::optional<ContactFeature> plane, line;
  ContactFeature point;
};

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

  // A curved rim or surface is no feature of this method; no scene with one gets here, nor one with triangles.
  Choices operator()(const Cylinder&) const { return {{}, {}, {.at = at}}; }
  Choices operator()(const Ellipsoid&) const { return {{}, {}, {.at = at}}; }
  Choices operator()(const SurfaceShape&) const { return {{}, {}, {.at = at}}; }
  Choices operator()(const Compound&) const { return {{}, {}, {.at = at}}; }  // its part is asked instead

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
  return feature;
}

Choices placed(Choices choices, const BodyPose& pose) {
  if (choices.plane) choices.plane = placed(*choices.plane, pose);
  if (choices.line) choices.line = placed(*choices.line, pose);
  choices.point = placed(choices.point, pose);
  return choices;
}

// The feature of a box that a ball touches follows from its centre. It lies outside of one, two or three sides.
Choices beside_ball(const Box& box, const Vec3& centre) {
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
  return choices;
}

struct Moving {  // a feature in W
  Vec3 p, v;     // of `at`
  Vec3 d, rate;  // `direction`
  double radius;
};

Moving moving(const ContactFeature& feature, const RigidMotion& body) {
  const Vec3 arm = body.pose.R * feature.at, d = body.pose.R * feature.direction;
  return {body.pose.p + arm, body.v + body.w.cross(arm), d, body.w.cross(d), feature.radius};
}

// A unit vector along `line`, and its rate of change.
struct Direction {
  Vec3 n, rate;
  double length;
};
Direction direction_of(const Vec3& line, const Vec3& rate) {
  const double length = line.norm();
  const Vec3 n = line / length;
  return {n, (rate - n * n.dot(rate)) / length, length};
}

ContactKinematics point_on_plane(const Moving& point, const Moving& plane) {
  const Vec3& n = plane.d;
  const double gap = n.dot(point.p - plane.p) - point.radius;
  return {n, point.p - (point.radius + 0.5 * gap) * n, gap, plane.rate, point.v - point.radius * plane.rate};
}

ContactKinematics point_on_point(const Moving& a, const Moving& b) {
  const Direction line = direction_of(a.p - b.p, a.v - b.v);
  const double gap = line.length - a.radius - b.radius;
  return {line.n, b.p + (b.radius + 0.5 * gap) * line.n, gap, line.rate, b.v + b.radius * line.rate};
}

ContactKinematics point_on_line(const Moving& point, const Moving& line) {
  const Vec3 from = point.p - line.p;
  const double s = line.d.dot(from), s_rate = line.rate.dot(from) + line.d.dot(point.v - line.v);
  const Moving foot{line.p + s * line.d, line.v + s_rate * line.d + s * line.rate, {}, {}, line.radius};
  return point_on_point(point, foot);
}

// From a + s ea = b + t eb + D n and its derivative.
ContactKinematics line_on_line(const Moving& a, const Moving& b, double side) {
  const Direction across = direction_of(side * a.d.cross(b.d), side * (a.rate.cross(b.d) + a.d.cross(b.rate)));
  const Vec3& n = across.n;
  Mat3 directions;
  directions << a.d, -b.d, -n;
  const Mat3 inverse = directions.inverse();
  const Vec3 at = inverse * (b.p - a.p);
  const Vec3 rate = inverse * (b.v - a.v - at[0] * a.rate + at[1] * b.rate + at[2] * across.rate);
  const double gap = at[2] - a.radius - b.radius;
  return {n, b.p + at[1] * b.d + (b.radius + 0.5 * gap) * n, gap, across.rate,
          b.v + rate[1] * b.d + at[1] * b.rate + b.radius * across.rate};
}

ContactKinematics reversed(ContactKinematics kinematics) {
  kinematics.normal *= -1, kinematics.normal_rate *= -1;
  return kinematics;
}

constexpr double kEndless = std::numeric_limits<double>::infinity();

// m, from the ends of a shape's own feature, with `q` the point in B at which the other feature touches it: the centre
// of its ball, the foot on its axis, or its surface.
struct EndsOf {
  const ContactFeature &own, &other;
  Vec3 q;

  double operator()(const Sphere&) const { return kEndless; }
  double operator()(const Plane&) const { return kEndless; }

  double operator()(const Capsule& capsule) const {
    const double half = 0.5 * capsule.length;
    if (own.kind == Kind::line) return half - std::abs(q.z());
    return own.is_vertex && other.kind != Kind::plane ? std::copysign(q.z(), q.z() * own.at.z()) - half : kEndless;
  }

  double operator()(const Box& box) const {
    const Vec3 half = 0.5 * box.size;
    const bool is_side = own.kind == Kind::plane, is_beside_round = other.radius > 0;
    if (is_side && (!other.is_vertex || own.direction.cwiseAbs().maxCoeff() < 1)) return kEndless;
    double least = kEndless;
    for (int i = 0; i < 3; ++i) {
      const double within = half[i] - std::abs(q[i]);
      const bool is_along = is_side ? own.direction[i] == 0 : own.kind == Kind::line && own.direction[i] != 0;
      if (is_along) least = std::min(least, within);
      // Beside an edge or a corner the ball's centre lies outside of two or three sides.
      if (!is_along && !is_side && is_beside_round)
        least = std::min(least, own.at[i] < 0 ? -q[i] - half[i] : q[i] - half[i]);
    }
    return own.kind == Kind::point && !own.is_vertex ? kEndless : least;
  }

  double operator()(const Convex& convex) const {
    const Hull& hull = *convex.hull;
    double least = kEndless;
    for (const Hull::Edge& edge : hull.edges) {
      const Vec3 &from = hull.points[static_cast<std::size_t>(edge.from)],
                 &to = hull.points[static_cast<std::size_t>(edge.to)], along = (to - from).normalized();
      if (own.kind == Kind::plane && other.is_vertex) {
        // Anticlockwise as seen from outside: the face `left` lies to the left of its edge.
        for (const auto& [face, sign] : {std::pair(edge.left, 1.0), {edge.right, -1.0}}) {
          const Vec3& normal = hull.faces[static_cast<std::size_t>(face)].normal;
          if (normal.dot(own.direction) > 1 - kAligned)
            least = std::min(least, sign * normal.cross(along).dot(q - from));
        }
      } else if (own.kind == Kind::line && is_on(edge, hull)) {
        least = std::min({least, along.dot(q - from), along.dot(to - q)});
      }
    }
    return least;
  }

  // No scene with a curved rim or surface gets here, and a contact of a compound lasts to the end of its step.
  double operator()(const Cylinder&) const { return kEndless; }
  double operator()(const Ellipsoid&) const { return kEndless; }
  double operator()(const SurfaceShape&) const { return kEndless; }
  double operator()(const Compound&) const { return kEndless; }

 private:
  bool is_on(const Hull::Edge& edge, const Hull& hull) const {
    const Vec3& from = hull.points[static_cast<std::size_t>(edge.from)];
    const Vec3 along = (hull.points[static_cast<std::size_t>(edge.to)] - from).normalized();
    return along.cross(own.direction).norm() < kOnEdge &&
           along.cross(own.at - from).norm() < kOnEdge * hull.bounding_radius;
  }
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
    const Box* box = std::get_if<Box>(&part.shape);
    if (!box || !ball.is_vertex || !(ball.radius > 0)) return {};
    const Vec3 centre = pose.R.transpose() * (point.point + (0.5 * point.gap + ball.radius) * outward - pose.p);
    Choices choices = beside_ball(*box, part.pose.orientation.conjugate() * (centre - part.pose.position));
    // The centre of a ball that is deep in the box tells nothing.
    return choices.plane || choices.line || choices.point.is_vertex ? std::optional(placed(choices, part.pose))
                                                                    : std::nullopt;
  };
  of_a = take_ball(part_a, pose_a, outward_a, of_b.point).value_or(of_a);
  of_b = take_ball(part_b, pose_b, outward_b, of_a.point).value_or(of_b);
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

ContactKinematics contact_kinematics(const FeaturePair& features, const RigidMotion& a, const RigidMotion& b) {
  const Moving of_a = moving(features.a, a), of_b = moving(features.b, b);
  const Kind kind_a = features.a.kind, kind_b = features.b.kind;
  if (kind_b == Kind::plane) return point_on_plane(of_a, of_b);
  if (kind_a == Kind::plane) return reversed(point_on_plane(of_b, of_a));
  if (kind_a == Kind::line && kind_b == Kind::line) return line_on_line(of_a, of_b, features.side);
  if (kind_b == Kind::line) return point_on_line(of_a, of_b);
  if (kind_a == Kind::line) return reversed(point_on_line(of_b, of_a));
  return point_on_point(of_a, of_b);
}

double distance_from_ends(const FeaturePair& features, const ContactKinematics& kinematics, const Collider& a,
                          const Pose& pose_a, const Collider& b, const Pose& pose_b) {
  const Vec3 of_a = kinematics.point + (0.5 * kinematics.gap + features.a.radius) * kinematics.normal,
             of_b = kinematics.point - (0.5 * kinematics.gap + features.b.radius) * kinematics.normal;
  const Vec3 in_a = pose_a.R.transpose() * (of_b - pose_a.p), in_b = pose_b.R.transpose() * (of_a - pose_b.p);
  return std::min(std::visit(EndsOf{features.a, features.b, in_a}, a.shape),
                  std::visit(EndsOf{features.b, features.a, in_b}, b.shape));
}

}  // namespace rigor
