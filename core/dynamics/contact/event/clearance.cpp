#include "core/dynamics/contact/event/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rigor {
namespace {

constexpr double kNothingNear = std::numeric_limits<double>::infinity();
// In the scene's units of gaps.
constexpr double kRounding = 1e-14;                      // of the gap of bodies that touched at the start
constexpr double kMissed = 0.1 * ContactPoint::kClosed;  // an overlap that is overlooked

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
    if (std::any_of(persistent_contact_.points().begin(), persistent_contact_.points().end(), is_of_pair)) return true;
    if (stays(a) && stays(b)) return true;
    if (has_just_parted(a, b, touching, to.since - from.since)) return goes_on_to_part(a, b, from, to);
    const Collider &first = contact_points_.colliders()[a], &second = contact_points_.colliders()[b];
    return stay_apart(first, second, {from.state, contact_points_.separating_axis(from.state, a, b)},
                      {to.state, contact_points_.separating_axis(to.state, a, b)}, bend_of(first), bend_of(second),
                      to.since - from.since, kMissed * contact_points_.scales().gap());
  });
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
    for (const ManifoldPoint& point : contact_points_.manifold(at.state, a, b)) {
      const bool is_known = std::any_of(known.begin(), known.end(), [&](const PersistentPoint& h) {
        return is_of_pair(h.contact) && h.contact.feature == point.feature;
      });
      if (!is_known) least = std::min(least, (point.gap + drift) / unit);
    }
  }
  return std::min(least, least_gap_of_limits(touching, at));
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

}  // namespace rigor
