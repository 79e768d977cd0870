#include "core/dynamics/contact/impulse/manifolds.h"

#include <algorithm>
#include <cmath>

namespace rigor {
namespace {

constexpr double kWider = 0.2;     // of a body's thickness: by so much its search box is wider than itself,
constexpr double kAhead = 12;      // and by its way in so many steps,
constexpr double kFarthest = 1.5;  // but not by more than so many times its thickness
constexpr double kNear = 0.02;  // of the thinner body's thickness: closer points are kept even if they do not approach
constexpr double kSame = 0.1;   // of the thinner body's thickness: a point this near is the one of last time
constexpr int kMostOfPair = 4;

double thinner(const Collider& a, const Collider& b) { return std::min(a.thickness, b.thickness); }

// How far its turning within dt can take a body's surface; what is round shows none of it.
double turn_way(const Collider& collider, BodyColumns state, double dt) {
  if (collider.fixed || std::holds_alternative<Sphere>(collider.shape)) return 0;
  return std::min(1.0, dt * state.angular_velocity(collider.body).norm()) * collider.reach;
}

// What a body fills in the next dt.
Aabb swept_box(const Collider& collider, const Pose& pose, const Vec3& way, double margin) {
  Aabb box = aabb_of(collider.shape, pose, margin);
  box.low += way.cwiseMin(Vec3::Zero());
  box.high += way.cwiseMax(Vec3::Zero());
  return box;
}

// What a body whose way in a step is `way` will not leave for some steps.
Aabb widened(Aabb box, const Collider& collider, const Vec3& way) {
  if (!std::isfinite(collider.thickness)) return box;
  const Vec3 most = Vec3::Constant(kFarthest * collider.thickness);
  const Vec3 ahead = (kAhead * way).cwiseMin(most).cwiseMax(-most);
  const Vec3 margin = Vec3::Constant(kWider * collider.thickness);
  box.low += ahead.cwiseMin(Vec3::Zero()) - margin;
  box.high += ahead.cwiseMax(Vec3::Zero()) + margin;
  return box;
}

bool lies_within(const Aabb& inner, const Aabb& outer) {
  return (inner.low.array() >= outer.low.array()).all() && (inner.high.array() <= outer.high.array()).all();
}

// A body that nothing touches.
struct Flight {
  Pose pose;
  Vec3 v, w;  // m/s, rad/s in W
  Vec3 velocity_at(const Vec3& point) const { return v + w.cross(point - pose.p); }
  void go_on(double t) { pose = {pose.p + t * v, rotation_by(t * w).toRotationMatrix() * pose.R}; }
};
Flight flight_of(BodyColumns state, const Collider& collider, const Pose& pose) {
  if (collider.fixed) return {pose, Vec3::Zero(), Vec3::Zero()};
  return {pose, state.velocity(collider.body), state.angular_velocity(collider.body)};
}

double approach(const ContactPoint& point, const Flight& a, const Flight& b) {
  return -point.normal.dot(a.velocity_at(point.point) - b.velocity_at(point.point));
}

// When the first of these points closes its gap: 0 if one is closed, or if none does within dt.
double time_of_touch(const Manifold& points, const Flight& a, const Flight& b, double dt) {
  double first = dt;
  for (const ContactPoint& point : points) {
    if (point.gap <= 0) return 0;
    const double speed = approach(point, a, b);
    if (point.gap < first * speed) first = point.gap / speed;
  }
  return first < dt ? first : 0;
}

// Four points hold a face as well as eight: the deepest, the one furthest from it, and the two furthest to either side
// of the line between these.
void keep_four(Manifold& points) {
  if (points.size() <= kMostOfPair) return;
  const auto take = [&](int at, const auto& score) {
    const auto best = std::max_element(points.begin() + at, points.end(),
                                       [&](const auto& p, const auto& q) { return score(p) < score(q); });
    std::swap(points[at], *best);
  };
  take(0, [](const ContactPoint& p) { return -p.gap; });
  const ContactPoint first = points[0];
  take(1, [&](const ContactPoint& p) { return (p.point - first.point).squaredNorm(); });
  const Vec3 side = first.normal.cross(points[1].point - first.point);
  take(2, [&](const ContactPoint& p) { return side.dot(p.point - first.point); });
  take(3, [&](const ContactPoint& p) { return -side.dot(p.point - first.point); });
  points.keep(kMostOfPair);
}

}  // namespace

void Manifolds::place_bodies(BodyColumns state, double dt) {
  for (std::size_t i = 0; i < colliders_.size(); ++i) {
    const Collider& collider = colliders_[i];
    const bool round = std::holds_alternative<Sphere>(collider.shape);
    poses_[i] = {state.position(collider.body), round ? Mat3::Identity() : state.rotation(collider.body)};
    const Vec3 way = dt * state.velocity(collider.body);
    const double margin = kNear * collider.thickness + turn_way(collider, state, dt);
    boxes_[i] = swept_box(collider, poses_[i], way, margin);
    bounds_[i] = collider.reach + margin + way.norm();
  }
}

// Boxes wider than the bodies hold for some steps; only those of bodies that leave theirs are chosen and searched anew.
void Manifolds::update_pairs(BodyColumns state, double dt) {
  place_bodies(state, dt);
  const bool is_first = wide_boxes_.empty();
  if (is_first) wide_boxes_ = boxes_;
  left_.clear();
  for (std::size_t i = 0; i < colliders_.size(); ++i) {
    if (!is_first && lies_within(boxes_[i], wide_boxes_[i])) continue;
    left_.push_back(static_cast<int>(i));
    wide_boxes_[i] = widened(boxes_[i], colliders_[i], dt * state.velocity(colliders_[i].body));
  }
  if (is_first) {
    pairs_ = &finder_.overlaps(wide_boxes_);
  } else if (!left_.empty()) {
    pairs_ = &finder_.overlaps(wide_boxes_, left_);
  }
}

// Whether two bodies stay apart within dt, by the balls that they fill at most, or by their boxes. Written so
// that what is not a number does not.
bool Manifolds::stay_apart(int a, int b) const {
  if (const auto* plane = std::get_if<Plane>(&colliders_[a].shape))
    return plane->normal.dot(poses_[b].p) - plane->offset > bounds_[b];
  if (std::holds_alternative<Plane>(colliders_[b].shape)) return stay_apart(b, a);
  const double reach = bounds_[a] + bounds_[b];
  if ((poses_[a].p - poses_[b].p).squaredNorm() > reach * reach) return true;
  return (boxes_[a].low.array() > boxes_[b].high.array()).any() ||
         (boxes_[b].low.array() > boxes_[a].high.array()).any();
}

void Manifolds::add_pair(BodyColumns state, double dt, const Collider& a, const Collider& b) {
  const double near = kNear * thinner(a, b), turning = turn_way(a, state, dt) + turn_way(b, state, dt);
  Flight flight_a = flight_of(state, a, poses_[&a - colliders_.data()]);
  Flight flight_b = flight_of(state, b, poses_[&b - colliders_.data()]);
  const Vec3 v = flight_a.v - flight_b.v;
  collide(a.shape, flight_a.pose, b.shape, flight_b.pose, manifold_);
  // What comes fast touches elsewhere, and along another normal, than where it is nearest now.
  const double ahead = time_of_touch(manifold_, flight_a, flight_b, dt);
  const bool looks_ahead = ahead * (v.norm() + turning / dt) > near;
  if (looks_ahead) {
    flight_a.go_on(ahead), flight_b.go_on(ahead);
    collide(a.shape, flight_a.pose, b.shape, flight_b.pose, manifold_);
    for (ContactPoint& point : manifold_) point.gap += ahead * approach(point, flight_a, flight_b);
  }
  int kept = 0;
  for (const ContactPoint& point : manifold_) {
    if (point.gap < near + turning + dt * std::max(0.0, -point.normal.dot(v))) manifold_[kept++] = point;
  }
  manifold_.keep(kept);
  keep_four(manifold_);
  const ContactLaw& law = laws_.of(a.body, b.body);
  for (const ContactPoint& point : manifold_) {
    // Between points that are apart `point` is midway; each body will be met on its own surface.
    const Vec3 to_surface = looks_ahead ? Vec3::Zero() : Vec3(0.5 * std::max(0.0, point.gap) * point.normal);
    points_.push_back({a.body, b.body, point.feature, point.normal, point.point + to_surface - flight_a.pose.p,
                       point.point - to_surface - flight_b.pose.p, point.gap, law.friction, law.restitution, 0,
                       Vec3::Zero()});
  }
}

// Gives the points from `first` on, all of one pair, the impulses of the old points of that pair, which start at `old`
// or later.
void Manifolds::remember(std::size_t first, std::size_t& old) {
  const auto pair_of = [](const PilePoint& point) { return std::pair(point.a, point.b); };
  const auto pair = pair_of(points_[first]);
  while (old < old_points_.size() && pair_of(old_points_[old]) < pair) ++old;
  std::size_t end = old;
  while (end < old_points_.size() && pair_of(old_points_[end]) == pair) ++end;
  if (end == old) return;
  unsigned taken = 0;
  for (std::size_t i = first; i < points_.size(); ++i) {
    std::size_t best = end;
    double least = same_within_;
    for (std::size_t k = old; k < end; ++k) {
      if (taken >> (k - old) & 1) continue;
      const double distance =
          old_points_[k].feature == points_[i].feature ? -1 : (old_points_[k].arm_a - points_[i].arm_a).norm();
      if (distance < least) least = distance, best = k;
    }
    if (best == end) continue;
    taken |= 1u << (best - old);
    points_[i].normal_impulse = old_points_[best].normal_impulse;
    points_[i].friction_impulse = old_points_[best].friction_impulse;
  }
}

std::vector<PilePoint>& Manifolds::find(BodyColumns state, double dt) {
  update_pairs(state, dt);
  old_points_.swap(points_);
  points_.clear();
  std::size_t old = 0;
  for (const auto& [a, b] : *pairs_) {
    if ((colliders_[a].fixed && colliders_[b].fixed) || stay_apart(a, b)) continue;
    const std::size_t first = points_.size();
    add_pair(state, dt, colliders_[a], colliders_[b]);
    same_within_ = kSame * thinner(colliders_[a], colliders_[b]);
    if (points_.size() > first) remember(first, old);
  }
  return points_;
}

}  // namespace rigor
