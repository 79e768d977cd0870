#include "core/dynamics/contact/event/contact_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/dynamics/collision/coincident.h"
#include "core/dynamics/collision/curved/curved_solid.h"
#include "core/dynamics/contact/event/features/feature_ends.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kAtOnce = 1e-9;  // units of gaps: more than any gap that counts as closed
constexpr double kOnAxis = 1e-9;  // of a capsule's radius

Aabb joined(const Aabb& a, const Aabb& b) { return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)}; }

// Where a capsule crosses an edge and lies nearly flat on a triangle, manifolds have too small a gap. `side`: 1 if
// normals point to the capsule.
void sharpen_gaps(const Shape& shape, const Pose& pose, double side, Manifold& points) {
  for (ManifoldPoint& point : points) {
    const auto* compound = std::get_if<Compound>(&shape);
    const std::size_t part = side > 0 ? point.part_a : point.part_b;
    const auto* capsule = std::get_if<Capsule>(compound ? &compound->parts[part].shape : &shape);
    if (!capsule) continue;
    const Pose at = compound ? pose * compound->parts[part].pose : pose;
    const auto on_axis = [&](const Vec3& p) -> Vec3 {
      const double half = 0.5 * capsule->length;
      return at.p + std::clamp(at.R.col(2).dot(p - at.p), -half, half) * at.R.col(2);
    };
    const Vec3 n = side * point.normal, foot = point.point - 0.5 * point.gap * n,
               centre = foot + (point.gap + capsule->radius) * n;
    if ((on_axis(centre) - centre).norm() < kOnAxis * capsule->radius) continue;
    const Vec3 line = on_axis(foot) - foot;
    point.gap = line.norm() - capsule->radius;
    point.normal = side * line.normalized(), point.point = foot + 0.5 * point.gap * line.normalized();
  }
}

// visit(cylinder, its pose in W, the number of its part), of a shape or its parts.
template <typename Visit>
void visit_cylinders(const Collider& of, const Pose& pose, const Visit& visit) {
  if (const auto* alone = std::get_if<Cylinder>(&of.shape)) return visit(*alone, pose, std::size_t{0});
  const auto* compound = std::get_if<Compound>(&of.shape);
  for (std::size_t k = 0; compound && k < compound->parts.size(); ++k) {
    const PlacedShape& part = compound->parts[k];
    if (const auto* cylinder = std::get_if<Cylinder>(&part.shape)) visit(*cylinder, pose * part.pose, k);
  }
}

}  // namespace

const std::vector<std::pair<int, int>>& ContactPoints::candidates(BodyColumns from, BodyColumns to, double dt,
                                                                  const AccelerationBounds& bounds) {
  boxes_.clear();
  for (const Collider& collider : colliders_) {
    const AccelerationBound& bound = bounds.of(collider.body);
    // A path bends away from its chord by at most a dt²/8.
    double margin = kAtOnce * scales_.gap() + 0.125 * dt * dt * bound.linear;
    // A body that turns on its way may reach as far as its furthest point.
    if (bound.spin > 0 && std::isfinite(collider.bounding_radius))
      margin += std::min(1.0, dt * bound.spin) * (collider.bounding_radius - collider.inradius);
    boxes_.push_back(joined(aabb_of(collider.shape, pose_of(from, collider.body), margin),
                            aabb_of(collider.shape, pose_of(to, collider.body), margin)));
  }
  return overlapping_boxes();
}

const std::vector<std::pair<int, int>>& ContactPoints::candidates(BodyColumns state) {
  boxes_.clear();
  for (const Collider& collider : colliders_) {
    boxes_.push_back(aabb_of(collider.shape, pose_of(state, collider.body), kAtOnce * scales_.gap()));
  }
  return overlapping_boxes();
}

const std::vector<std::pair<int, int>>& ContactPoints::overlapping_boxes() {
  pairs_.clear();
  for (const auto& pair : broad_phase_.overlaps(boxes_)) {
    const Collider &a = colliders_[pair.first], &b = colliders_[pair.second];
    if (!(a.fixed && b.fixed) && laws_.may_touch(a.body, b.body)) pairs_.push_back(pair);
  }
  return pairs_;
}

const Manifold& ContactPoints::manifold(BodyColumns state, int a, int b) {
  const Collider &first = colliders_[a], &second = colliders_[b];
  Pose pose_of_first = pose_of(state, first.body);
  const Pose pose_of_second = pose_of(state, second.body);
  pose_of_first.p += aside_of(first, pose_of_first.p, second, pose_of_second.p);
  collide(first.shape, pose_of_first, second.shape, pose_of_second, manifold_);
  if (surface_in(second.shape)) sharpen_gaps(first.shape, pose_of_first, 1, manifold_);
  if (surface_in(first.shape)) sharpen_gaps(second.shape, pose_of_second, -1, manifold_);
  if (surface_in(first.shape) || surface_in(second.shape)) sharpen_normals(state, first, second);
  if (const auto* ground = std::get_if<Plane>(&second.shape)) sharpen_rims(state, first, *ground, 1);
  if (const auto* ground = std::get_if<Plane>(&first.shape)) sharpen_rims(state, second, *ground, -1);
  return manifold_;
}

// Manifolds have fixed points where a cylinder's end lies nearly flat. Here it touches with its lowest point, until it
// lies flat to rounding. While it turns over, two of the four points are those that rise and fall fastest. `side`: 1 if
// normals point to the cylinder.
void ContactPoints::sharpen_rims(BodyColumns state, const Collider& of, const Plane& ground, double side) {
  constexpr double kTurns = 1e-8;  // units of speed, of a point of the rim
  const Vec3& n = ground.normal;
  const Vec3 falls = state.angular_velocity(of.body).cross(n);  // 1/s, times the radius: how fast a rim's lowest point
  visit_cylinders(of, pose_of(state, of.body), [&](const Cylinder& cylinder, const Pose& at, std::size_t number) {
    const CurvedSolid solid(cylinder, at);
    Disc end = end_against(solid, n);
    const bool is_flat = lies_flat(end, n, kUpright), turns = falls.norm() * end.radius > kTurns * scales_.speed();
    if (!lies_flat(end, n) || (is_flat && !turns)) return;
    if (is_flat) end.along = (falls - falls.dot(end.axis) * end.axis).normalized();
    const auto is_of_part = [&](const ManifoldPoint& point) {
      return (side > 0 ? point.part_a : point.part_b) == number;
    };
    manifold_.keep(
        static_cast<int>(std::remove_if(manifold_.begin(), manifold_.end(), is_of_part) - manifold_.begin()));
    const int first = manifold_.size();
    collide_end_plane(solid, end, ground, kUpright, manifold_);
    for (int i = first; i < manifold_.size(); ++i) {
      manifold_[i].normal *= side;
      (side > 0 ? manifold_[i].part_a : manifold_[i].part_b) = static_cast<std::uint16_t>(number);
    }
  });
}

bool ContactPoints::is_of_flat_end(BodyColumns state, const ContactPoint& contact) const {
  if (contact.is_limit()) return false;
  bool is_flat = false;
  const auto look = [&](int of, std::size_t part, int on) {
    const auto* ground = std::get_if<Plane>(&colliders_[on].shape);
    if (!ground) return;
    visit_cylinders(colliders_[of], pose_of(state, colliders_[of].body),
                    [&](const Cylinder& cylinder, const Pose& at, std::size_t number) {
                      const Disc end = end_against(CurvedSolid(cylinder, at), ground->normal);
                      is_flat = is_flat || (number == part && lies_flat(end, ground->normal, kUpright));
                    });
  };
  look(contact.a, contact.part_a, contact.b), look(contact.b, contact.part_b, contact.a);
  return is_flat;
}

bool ContactPoints::has_rims(int a, int b) const {
  const auto stands = [this](int of, int on) {
    bool has_cylinder = false;
    visit_cylinders(colliders_[of], Pose(), [&](const auto&...) { has_cylinder = true; });
    return has_cylinder && std::holds_alternative<Plane>(colliders_[on].shape);
  };
  return stands(a, b) || stands(b, a);
}

// Where edges cross over a triangle that lies nearly flat against both, manifolds have the triangle's normal.
void ContactPoints::sharpen_normals(BodyColumns state, const Collider& a, const Collider& b) {
  constexpr double kNear = 1e-6;  // units of length: both edges pass through the point
  for (ManifoldPoint& point : manifold_) {
    if (!(std::abs(point.gap) < kNear * scales_.length)) continue;
    const RigidMotion of_a = motion_of(state, a), of_b = motion_of(state, b);
    const FeaturePair features = features_at(point, a, of_a.pose, b, of_b.pose);
    if (features.a.kind != ContactFeature::Kind::line || features.b.kind != ContactFeature::Kind::line) continue;
    const ContactKinematics exact = contact_kinematics(features, of_a, of_b);
    point.normal = exact.normal, point.point = exact.point, point.gap = exact.gap;
  }
}

Vec3 ContactPoints::separating_axis(BodyColumns state, int a, int b) {
  const Manifold& points = manifold(state, a, b);
  assert(points.size() > 0 && "only two planes have none");
  return points[0].normal;
}

void ContactPoints::place(BodyColumns state, const ManifoldPoint& point, ContactPoint& contact) const {
  contact.gap = point.gap;
  contact.cone.arm_a = point.point - state.position(contact.cone.a);
  contact.cone.arm_b = point.point - state.position(contact.cone.b);
}

void ContactPoints::find(BodyColumns state, const std::vector<std::pair<int, int>>& pairs, double gap,
                         std::vector<ContactPoint>& out) {
  for (const auto& [a, b] : pairs) {
    for (const ManifoldPoint& point : manifold(state, a, b)) {
      if (!(point.gap <= gap * scales_.gap()) || is_past_end(state, point, a, b)) continue;
      ContactPoint contact{.a = a,
                           .b = b,
                           .feature = point.feature,
                           .part_a = point.part_a,
                           .part_b = point.part_b,
                           .gap = point.gap,
                           .restitution = 0,
                           .cone = {}};
      contact.cone.a = colliders_[a].body, contact.cone.b = colliders_[b].body;
      const ContactLaw& law = laws_.of(contact.cone.a, contact.cone.b);
      contact.restitution = law.restitution;
      contact.cone.friction = law.friction, contact.static_friction = law.sticking_friction();
      contact.cone.frame = contact_frame(point.normal);
      place(state, point, contact);
      out.push_back(contact);
    }
  }
  for (std::size_t k = 0; k < limits_.size(); ++k) {
    const ContactPoint limit = limit_at(state, k);
    if (limit.gap <= gap * scales_.gap(limit.cone.is_couple)) out.push_back(limit);
  }
}

// A corner of a body counts on a triangle a little way past its border, too. There the body's edges have points.
bool ContactPoints::is_past_end(BodyColumns state, const ManifoldPoint& point, int a, int b) const {
  const Collider &first = colliders_[a], &second = colliders_[b];
  if (!surface_in(first.shape) && !surface_in(second.shape)) return false;
  const RigidMotion of_first = motion_of(state, first), of_second = motion_of(state, second);
  const FeaturePair features = features_at(point, first, of_first.pose, second, of_second.pose);
  if (features.a.radius + features.b.radius > 0) return false;
  return distance_from_ends(features, contact_kinematics(features, of_first, of_second), first, of_first.pose, second,
                            of_second.pose) < -kAtEnd * scales_.length;
}

ContactPoint ContactPoints::limit_at(BodyColumns state, std::size_t k) const {
  const JointLimits::Value at = limits_.at(k, state);
  ContactPoint limit{.a = ContactPoint::kLimit,
                     .b = ContactPoint::kLimit,
                     .feature = static_cast<std::uint32_t>(k),
                     .gap = at.gap,
                     .restitution = limits_.restitution(k),
                     .cone = {}};
  limit.cone.a = limits_.a(k), limit.cone.b = limits_.b(k);
  limit.cone.arm_a = at.arm_a, limit.cone.arm_b = at.arm_b;
  limit.cone.is_couple = at.is_of_turning;
  limit.cone.frame = contact_frame(at.direction);
  return limit;
}

bool ContactPoints::follow(BodyColumns state, ContactPoint& contact) {
  if (contact.is_limit()) {
    const Vec3 impulse = contact.cone.impulse;
    contact = limit_at(state, contact.feature);
    contact.cone.impulse = impulse;
    return true;
  }
  const Manifold& points = manifold(state, contact.a, contact.b);
  if (points.size() == 0) return false;
  const Vec3 before = state.position(contact.cone.a) + contact.cone.arm_a;
  const ManifoldPoint* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const ManifoldPoint& point : points) {
    const double distance = point.feature == contact.feature ? -1 : (point.point - before).norm();
    if (distance < least) least = distance, nearest = &point;
  }
  if (!nearest) return false;
  place(state, *nearest, contact);
  contact.part_a = nearest->part_a, contact.part_b = nearest->part_b;
  Mat3& frame = contact.cone.frame;
  const Vec3 n = nearest->normal, t = frame.col(1) - n * n.dot(frame.col(1));
  if (t.norm() > 0.1)
    frame << n, t.normalized(), n.cross(t.normalized());
  else
    frame = contact_frame(n);
  return true;
}

}  // namespace rigor::inline dynamics
