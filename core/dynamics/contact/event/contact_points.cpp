#include "core/dynamics/contact/event/contact_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/dynamics/collision/coincident.h"

namespace rigor {
namespace {

constexpr double kAtOnce = 1e-9;  // units of gaps: more than any gap that counts as closed

Aabb joined(const Aabb& a, const Aabb& b) { return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)}; }

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
  return manifold_;
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
      if (!(point.gap <= gap * scales_.gap())) continue;
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

}  // namespace rigor
