#include "core/dynamics/contact/event/clearance/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/contact/event/clearance/ground_gap.h"
#include "core/dynamics/contact/event/clearance/surface_clearance.h"
#include "core/dynamics/contact/event/features/surface_features.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kNothingNear = std::numeric_limits<double>::infinity();
// In the scene's units of gaps.
constexpr double kRounding = 1e-14;                      // of the gap of bodies that touched at the start
constexpr double kMissed = 0.1 * ContactPoint::kClosed;  // an overlap that is overlooked
constexpr double kSamePlace = 1e-6;                      // units of length: one point of a rim
constexpr double kAtSurface = 1e-6;                      // above a surface: too near to be seen to stay off it

}  // namespace

bool Clearance::find_bounds(BodyColumns from, BodyColumns to, double t, double h) {
  return bounds_.find(from, to, t, h, persistent_contact_.largest_loads());
}

bool Clearance::all_stay_apart(const Pairs& pairs, const std::vector<ContactPoint>& touching, const Instant& from,
                               const Instant& to) {
  if (may_have_touched_limit(from, to)) return false;
  return std::all_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
    const auto [a, b] = pair;
    const auto is_of_pair = [a = a, b = b](const PersistentPoint& point) {
      return point.contact.a == a && point.contact.b == b;
    };
    if (surface_of(contact_points_.colliders()[a]) || surface_of(contact_points_.colliders()[b]))
      return stays_off_surface(a, b, touching, from, to);
    if (std::any_of(persistent_contact_.points().begin(), persistent_contact_.points().end(), is_of_pair)) return true;
    if (stays(a) && stays(b)) return true;
    if (has_just_parted(a, b, touching, to.since - from.since)) return goes_on_to_part(a, b, from, to);
    const Collider &first = contact_points_.colliders()[a], &second = contact_points_.colliders()[b];
    return stay_apart(first, second, {from.state, contact_points_.separating_axis(from.state, a, b)},
                      {to.state, contact_points_.separating_axis(to.state, a, b)}, bend_of(first), bend_of(second),
                      to.since - from.since, kMissed * contact_points_.scales().gap());
  });
}

// Where the body touches the surface, or has just parted from it, the other regions are looked at.
bool Clearance::stays_off_surface(int a, int b, const std::vector<ContactPoint>& touching, const Instant& from,
                                  const Instant& to) {
  const bool is_first = surface_of(contact_points_.colliders()[a]) != nullptr;
  const int body = is_first ? b : a, surface = is_first ? a : b;
  const Collider &of = contact_points_.colliders()[body], &ground = contact_points_.colliders()[surface];
  if (stays(body)) return true;
  const double h = to.since - from.since;
  touched_.clear(), normals_.clear();
  for (const PersistentPoint& point : persistent_contact_.points())
    if (point.contact.a == a && point.contact.b == b) note_touched(point.contact, ground, from.state);
  if (touched_.empty() && has_just_parted(a, b, touching, h)) {
    if (!goes_on_to_part(a, b, from, to)) return false;
    for (const ContactPoint& point : touching)
      if (point.a == a && point.b == b) note_touched(point, ground, from.state);
  }
  const AccelerationBound& bound = bounds_.of(of.body);
  const SurfaceClearance clearance(
      of, ground, {from.state, to.state, h, bend_of(of), bound.spin, kMissed * contact_points_.scales().gap()});
  for (const BodyColumns& state : {from.state, to.state}) note_normals(state, a, b, is_first ? -1 : 1);
  const bool is_near =
      !touched_.empty() || gap_above_surface(from.state, a, b) < kAtSurface * contact_points_.scales().gap_unit();
  return clearance.stays_off(touched_, normals_, is_near);
}

void Clearance::note_touched(const ContactPoint& contact, const Collider& ground, BodyColumns state) {
  const Pose pose = pose_of(state, ground.body);
  const Vec3& arm = contact.cone.a == ground.body ? contact.cone.arm_a : contact.cone.arm_b;
  find_patches_at(*surface_of(ground), pose.R.transpose() * arm, touched_);
}

void Clearance::note_normals(BodyColumns state, int a, int b, double side) {
  for (const ManifoldPoint& point : contact_points_.manifold(state, a, b)) {
    const Vec3 n = side * point.normal;
    const auto is_same = [&](const Vec3& other) { return n.dot(other) > 1 - kAligned; };
    if (std::none_of(normals_.begin(), normals_.end(), is_same)) normals_.push_back(n);
  }
}

// Bodies that turn far within the step may come back to each other.
bool Clearance::has_just_parted(int a, int b, const std::vector<ContactPoint>& touching, double h) const {
  constexpr double kTurn = 0.5;  // rad
  for (const int collider : {a, b}) {
    const Collider& of = contact_points_.colliders()[collider];
    if (!of.fixed && bounds_.of(of.body).spin * h > kTurn) return false;
  }
  return std::any_of(touching.begin(), touching.end(),
                     [a, b](const ContactPoint& point) { return point.a == a && point.b == b; });
}

void Clearance::note_gaps(BodyColumns state, int a, int b, std::vector<PointGap>& out) {
  out.clear();
  const int body_a = contact_points_.colliders()[a].body, body_b = contact_points_.colliders()[b].body;
  const auto velocity = [&](int body, const Vec3& at) -> Vec3 {
    return state.velocity(body) + state.angular_velocity(body).cross(at - state.position(body));
  };
  for (const ManifoldPoint& point : contact_points_.manifold(state, a, b)) {
    const Vec3 u = velocity(body_a, point.point) - velocity(body_b, point.point);
    out.push_back({point.feature, point.gap, point.normal.dot(u)});
  }
}

bool Clearance::goes_on_to_part(int a, int b, const Instant& from, const Instant& to) {
  note_gaps(from.state, a, b, gaps_from_);
  note_gaps(to.state, a, b, gaps_to_);
  const double missed = kMissed * contact_points_.scales().gap(), h = to.since - from.since;
  return std::all_of(gaps_from_.begin(), gaps_from_.end(), [&](const PointGap& first) {
    const auto last = std::find_if(gaps_to_.begin(), gaps_to_.end(),
                                   [&](const PointGap& point) { return point.feature == first.feature; });
    return last == gaps_to_.end() || peak_between(-first.gap, -first.rate, -last->gap, -last->rate, h) <= missed;
  });
}

// And gone back from it.
bool Clearance::may_have_touched_limit(const Instant& from, const Instant& to) const {
  const JointLimits& limits = contact_points_.limits();
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (is_persistent_limit(k)) continue;
    const JointLimits::Value first = limits.at(k, from.state, from.since), last = limits.at(k, to.state, to.since);
    if (peak_between(-first.gap, -first.rate, -last.gap, -last.rate, to.since - from.since) > 0) return true;
  }
  return false;
}

bool Clearance::is_persistent_limit(std::size_t k) const {
  const std::vector<PersistentPoint>& points = persistent_contact_.points();
  return std::any_of(points.begin(), points.end(), [k](const PersistentPoint& point) {
    return point.contact.is_limit() && point.contact.feature == k;
  });
}

// Whether a collider is where it was at the way's start, for a way of any length.
bool Clearance::stays(int collider) const {
  const Collider& of = contact_points_.colliders()[collider];
  return of.fixed || persistent_contact_.rests(of.body);
}

Bend Clearance::bend_of(const Collider& collider) const {
  if (collider.fixed) return {};
  const AccelerationBound& bound = bounds_.of(collider.body);
  return {bound.linear, bound.of_point(collider.bounding_radius)};
}

double Clearance::least_gap(const Pairs& pairs, const std::vector<ContactPoint>& touching, const Instant& at) {
  double least = kNothingNear;
  const double unit = contact_points_.scales().gap_unit();
  const std::vector<PersistentPoint>& known = persistent_contact_.points();
  for (const auto& [a, b] : pairs) {
    if (stays(a) && stays(b)) continue;
    double drift = 0;
    const auto is_of_pair = [one = a, other = b](const ContactPoint& point) {
      return point.a == one && point.b == other;
    };
    for (const ContactPoint& point : touching) {
      if (is_of_pair(point)) drift = std::max(drift, kRounding * unit - point.gap);
    }
    for (const PersistentPoint& point : known) {
      if (is_of_pair(point.contact)) drift = std::max(drift, kRounding * unit + 4 * std::abs(point.kinematics.gap));
    }
    // A flat end keeps one of four points when it turns over; from then on its lowest point has another number.
    const bool may_roll = contact_points_.has_rims(a, b);
    const auto is_same_place = [&](const PersistentPoint& one, const ManifoldPoint& other) {
      return (one.kinematics.point - other.point).norm() < kSamePlace * contact_points_.scales().length;
    };
    for (const ManifoldPoint& point : contact_points_.manifold(at.state, a, b)) {
      const bool is_known = std::any_of(known.begin(), known.end(), [&](const PersistentPoint& h) {
        return is_of_pair(h.contact) && (h.contact.feature == point.feature || (may_roll && is_same_place(h, point)));
      });
      if (!is_known) least = std::min(least, (point.gap + drift) / unit);
    }
    least = std::min(least, gap_above_surface(at.state, a, b) / unit + drift / unit + kMissed);
  }
  return std::min(least, least_gap_of_limits(touching, at));
}

// m, infinite where neither is a surface of triangles.
double Clearance::gap_above_surface(BodyColumns state, int a, int b) const {
  for (const auto& [body, ground] : {std::pair(a, b), {b, a}}) {
    const Collider &of = contact_points_.colliders()[body], &on = contact_points_.colliders()[ground];
    if (const TriangleSurface* surface = surface_of(on))
      return gap_above_ground(of, pose_of(state, of.body), *surface, pose_of(state, on.body));
  }
  return kNothingNear;
}

double Clearance::least_gap_of_limits(const std::vector<ContactPoint>& touching, const Instant& at) const {
  double least = kNothingNear;
  const JointLimits& limits = contact_points_.limits();
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (is_persistent_limit(k)) continue;
    const JointLimits::Value limit = limits.at(k, at.state, at.since);
    const double unit = contact_points_.scales().gap_unit(limit.is_of_turning);
    double drift = 0;
    for (const ContactPoint& point : touching) {
      if (point.is_limit() && point.feature == k) drift = std::max(0.0, kRounding * unit - point.gap);
    }
    least = std::min(least, (limit.gap + drift) / unit);
  }
  return least;
}

}  // namespace rigor::inline dynamics
