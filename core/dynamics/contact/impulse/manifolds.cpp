#include "core/dynamics/contact/impulse/manifolds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/dynamics/collision/coincident.h"

namespace rigor {
namespace {

// In inradii of the body, or of the smaller of two.
constexpr double kFatMargin = 0.2;           // by so much its fat box is wider than itself,
constexpr double kStepsAhead = 12;           // and by its displacement in so many steps,
constexpr double kFarthest = 1.5;            // but not by more than this
constexpr double kSpeculativeMargin = 0.02;  // points closer than this are kept even if they do not approach
constexpr double kMatchRadius = 0.1;         // a point this near to one of the last update is the same
constexpr double kDeep = 0.02;               // an overlap of more at the start is parted, and no contact
constexpr double kSunk = 0.5;                // one of more is no contact any longer
constexpr double kTurnsFar = 0.25;           // a surface that turns farther is followed on its way
constexpr int kMostOfPair = 4;

double smaller_inradius(const Collider& a, const Collider& b) { return std::min(a.inradius, b.inradius); }

// How far its turning within dt can take a body's surface; what is round shows none of it.
double rotational_displacement(const Collider& collider, BodyColumns state, double dt) {
  if (collider.fixed || std::holds_alternative<Sphere>(collider.shape)) return 0;
  return std::min(1.0, dt * state.angular_velocity(collider.body).norm()) * collider.bounding_radius;
}

double rotational_speed(const Collider& collider, BodyColumns state) {
  if (collider.fixed || std::holds_alternative<Sphere>(collider.shape)) return 0;
  return state.angular_velocity(collider.body).norm() * collider.bounding_radius;
}

// What a body fills in the next dt.
Aabb swept_box(const Collider& collider, const Pose& pose, const Vec3& displacement, double margin) {
  Aabb box = aabb_of(collider.shape, pose, margin);
  box.low += displacement.cwiseMin(Vec3::Zero());
  box.high += displacement.cwiseMax(Vec3::Zero());
  return box;
}

// What a body with this displacement in a step will not leave for some steps.
Aabb fattened(Aabb box, const Collider& collider, const Vec3& displacement) {
  if (!std::isfinite(collider.inradius)) return box;
  const Vec3 most = Vec3::Constant(kFarthest * collider.inradius);
  const Vec3 ahead = (kStepsAhead * displacement).cwiseMin(most).cwiseMax(-most);
  const Vec3 margin = Vec3::Constant(kFatMargin * collider.inradius);
  box.low += ahead.cwiseMin(Vec3::Zero()) - margin;
  box.high += ahead.cwiseMax(Vec3::Zero()) + margin;
  return box;
}

bool lies_within(const Aabb& inner, const Aabb& outer) {
  return (inner.low.array() >= outer.low.array()).all() && (inner.high.array() <= outer.high.array()).all();
}

// Of a body that nothing touches.
struct FreeMotion {
  Pose pose;
  Vec3 v, w;  // m/s, rad/s in W
  Vec3 velocity_at(const Vec3& point) const { return v + w.cross(point - pose.p); }
  FreeMotion after(double t) const {
    FreeMotion out = *this;
    out.advance(t);
    return out;
  }
  void advance(double t) { pose = {pose.p + t * v, rotation_by(t * w).toRotationMatrix() * pose.R}; }
};
FreeMotion free_motion_of(BodyColumns state, const Collider& collider, const Pose& pose) {
  if (collider.fixed) return {pose, Vec3::Zero(), Vec3::Zero()};
  return {pose, state.velocity(collider.body), state.angular_velocity(collider.body)};
}

double approach(const ManifoldPoint& point, const FreeMotion& a, const FreeMotion& b) {
  return -point.normal.dot(a.velocity_at(point.point) - b.velocity_at(point.point));
}

// When the first of these points closes its gap: 0 if one is closed, or if none does within dt.
double time_of_impact(const Manifold& points, const FreeMotion& a, const FreeMotion& b, double dt) {
  double first = dt;
  for (const ManifoldPoint& point : points) {
    if (point.gap <= 0) return 0;
    const double speed = approach(point, a, b);
    if (point.gap < first * speed) first = point.gap / speed;
  }
  return first < dt ? first : 0;
}

// The same for what turns so far that its surface is not where its velocity now takes it: by steps that no point can
// outrun (conservative advancement). `turning`: m/s, of the fastest points.
double time_of_turning_impact(const Collider& a, const Collider& b, const FreeMotion& motion_a,
                              const FreeMotion& motion_b, double turning, double margin, double dt) {
  constexpr int kMostLooks = 40;
  Manifold points;
  double t = 0;
  for (int look = 0; look < kMostLooks; ++look) {
    const FreeMotion there_a = motion_a.after(t), there_b = motion_b.after(t);
    collide(a.shape, there_a.pose, b.shape, there_b.pose, points);
    const auto nearest = std::min_element(points.begin(), points.end(),
                                          [](const ManifoldPoint& p, const ManifoldPoint& q) { return p.gap < q.gap; });
    if (nearest == points.end() || nearest->gap <= margin) break;
    const double fastest = turning - nearest->normal.dot(motion_a.v - motion_b.v);
    if (!(fastest > 0) || t + nearest->gap / fastest >= dt) return 0;
    t += nearest->gap / fastest;
  }
  return t;
}

// Four points hold a face as well as eight: the deepest, the one furthest from it, and the two furthest to either side
// of the line between these.
void reduce_to_four(Manifold& points) {
  if (points.size() <= kMostOfPair) return;
  const auto take = [&](int at, const auto& score) {
    const auto best = std::max_element(points.begin() + at, points.end(),
                                       [&](const auto& p, const auto& q) { return score(p) < score(q); });
    std::swap(points[at], *best);
  };
  take(0, [](const ManifoldPoint& p) { return -p.gap; });
  const ManifoldPoint first = points[0];
  take(1, [&](const ManifoldPoint& p) { return (p.point - first.point).squaredNorm(); });
  const Vec3 side = first.normal.cross(points[1].point - first.point);
  take(2, [&](const ManifoldPoint& p) { return side.dot(p.point - first.point); });
  take(3, [&](const ManifoldPoint& p) { return -side.dot(p.point - first.point); });
  points.keep(kMostOfPair);
}

}  // namespace

void Manifolds::place_bodies(BodyColumns state, double dt) {
  for (std::size_t i = 0; i < colliders_.size(); ++i) {
    const Collider& collider = colliders_[i];
    const bool round = std::holds_alternative<Sphere>(collider.shape);
    poses_[i] = {state.position(collider.body), round ? Mat3::Identity() : state.rotation(collider.body)};
    const Vec3 displacement = dt * state.velocity(collider.body);
    const double margin = kSpeculativeMargin * collider.inradius + rotational_displacement(collider, state, dt);
    boxes_[i] = swept_box(collider, poses_[i], displacement, margin);
    bounding_radii_[i] = collider.bounding_radius + margin + displacement.norm();
  }
}

// Fat boxes hold for some steps; only those of bodies that leave theirs are chosen and searched anew.
void Manifolds::update_pairs(BodyColumns state, double dt) {
  place_bodies(state, dt);
  const bool is_first = fat_boxes_.empty();
  if (is_first) fat_boxes_ = boxes_;
  moved_.clear();
  for (std::size_t i = 0; i < colliders_.size(); ++i) {
    if (!is_first && lies_within(boxes_[i], fat_boxes_[i])) continue;
    moved_.push_back(static_cast<int>(i));
    fat_boxes_[i] = fattened(boxes_[i], colliders_[i], dt * state.velocity(colliders_[i].body));
  }
  if (is_first) {
    pairs_ = &broad_phase_.overlaps(fat_boxes_);
  } else if (!moved_.empty()) {
    pairs_ = &broad_phase_.overlaps(fat_boxes_, moved_);
  }
}

// Whether two bodies stay apart within dt, by their bounding spheres or by their boxes. Written so that what is not a
// number does not.
bool Manifolds::stay_apart(int a, int b) const {
  if (const auto* plane = std::get_if<Plane>(&colliders_[a].shape))
    return plane->normal.dot(poses_[b].p) - plane->offset > bounding_radii_[b];
  if (std::holds_alternative<Plane>(colliders_[b].shape)) return stay_apart(b, a);
  const double distance = bounding_radii_[a] + bounding_radii_[b];
  if ((poses_[a].p - poses_[b].p).squaredNorm() > distance * distance) return true;
  return (boxes_[a].low.array() > boxes_[b].high.array()).any() ||
         (boxes_[b].low.array() > boxes_[a].high.array()).any();
}

void Manifolds::add_pair(BodyColumns state, double dt, const Collider& a, const Collider& b) {
  const double margin = kSpeculativeMargin * smaller_inradius(a, b),
               turning = rotational_displacement(a, state, dt) + rotational_displacement(b, state, dt);
  FreeMotion motion_a = free_motion_of(state, a, poses_[&a - colliders_.data()]);
  FreeMotion motion_b = free_motion_of(state, b, poses_[&b - colliders_.data()]);
  const Vec3 v = motion_a.v - motion_b.v;
  motion_a.pose.p += aside_of(a, motion_a.pose.p, b, motion_b.pose.p);
  collide(a.shape, motion_a.pose, b.shape, motion_b.pose, manifold_);
  // What comes fast touches elsewhere, and along another normal, than where it is nearest now.
  const bool turns_far = turning > kTurnsFar * smaller_inradius(a, b);
  const double speed = rotational_speed(a, state) + rotational_speed(b, state);
  const double ahead = turns_far ? time_of_turning_impact(a, b, motion_a, motion_b, speed, margin, dt)
                                 : time_of_impact(manifold_, motion_a, motion_b, dt);
  const bool looks_ahead = ahead * (v.norm() + turning / dt) > margin;
  if (looks_ahead) {
    motion_a.advance(ahead), motion_b.advance(ahead);
    collide(a.shape, motion_a.pose, b.shape, motion_b.pose, manifold_);
    for (ManifoldPoint& point : manifold_) point.gap += ahead * approach(point, motion_a, motion_b);
  }
  int kept = 0;
  for (const ManifoldPoint& point : manifold_) {
    if (point.gap < margin + turning + dt * std::max(0.0, -point.normal.dot(v))) manifold_[kept++] = point;
  }
  manifold_.keep(kept);
  reduce_to_four(manifold_);
  for (const ManifoldPoint& point : manifold_) watch(a, b, point.gap);
  const ContactLaw& law = laws_.of(a.body, b.body);
  for (const ManifoldPoint& point : manifold_) {
    // Between points that are apart `point` is midway; each body will be met on its own surface.
    const Vec3 to_surface = looks_ahead ? Vec3::Zero() : Vec3(0.5 * std::max(0.0, point.gap) * point.normal);
    constraints_.push_back({a.body, b.body, point.feature, point.normal, point.point + to_surface - motion_a.pose.p,
                            point.point - to_surface - motion_b.pose.p, point.gap,
                            is_parted_from_start(a, b, point.gap), law.friction, law.restitution, 0, Vec3::Zero()});
  }
}

bool Manifolds::is_parted_from_start(const Collider& a, const Collider& b, double gap) const {
  const auto was_inside = [&](const Collider& c) { return !c.fixed && overlaps_at_start_[c.body] != 0; };
  return gap < -kDeep * smaller_inradius(a, b) && (was_inside(a) || was_inside(b));
}

// What overlaps from the start is parted; nothing else may come to lie in each other.
void Manifolds::watch(const Collider& a, const Collider& b, double gap) {
  const double size = smaller_inradius(a, b);
  if (is_first_ && gap < -kDeep * size) overlaps_at_start_[a.body] = overlaps_at_start_[b.body] = 1;
  if (gap >= -kSunk * size || is_parted_from_start(a, b, gap) || !failure_.empty()) return;
  failure_ = fmt::format(
      "{} and {} overlap by {:.2g} m, which impulses do not hold (much lighter bodies under heavier ones, or bodies "
      "with "
      "no room between others); contact=event may",
      names_[a.body], names_[b.body], -gap);
}

// Gives the constraints from `first` on, all of one pair, the impulses of that pair's old ones, which start at `old` or
// later.
void Manifolds::match_impulses(std::size_t first, std::size_t& old) {
  const auto pair_of = [](const ContactConstraint& point) { return std::pair(point.a, point.b); };
  const auto pair = pair_of(constraints_[first]);
  while (old < old_constraints_.size() && pair_of(old_constraints_[old]) < pair) ++old;
  std::size_t end = old;
  while (end < old_constraints_.size() && pair_of(old_constraints_[end]) == pair) ++end;
  if (end == old) return;
  unsigned taken = 0;
  for (std::size_t i = first; i < constraints_.size(); ++i) {
    std::size_t best = end;
    double least = match_radius_;
    for (std::size_t k = old; k < end; ++k) {
      if (taken >> (k - old) & 1) continue;
      const double distance = old_constraints_[k].feature == constraints_[i].feature
                                  ? -1
                                  : (old_constraints_[k].arm_a - constraints_[i].arm_a).norm();
      if (distance < least) least = distance, best = k;
    }
    if (best == end) continue;
    taken |= 1u << (best - old);
    constraints_[i].normal_impulse = old_constraints_[best].normal_impulse;
    constraints_[i].friction_impulse = old_constraints_[best].friction_impulse;
  }
}

std::vector<ContactConstraint>& Manifolds::find(BodyColumns state, double dt) {
  update_pairs(state, dt);
  old_constraints_.swap(constraints_);
  constraints_.clear();
  std::size_t old = 0;
  for (const auto& [a, b] : *pairs_) {
    if ((colliders_[a].fixed && colliders_[b].fixed) || stay_apart(a, b)) continue;
    const std::size_t first = constraints_.size();
    add_pair(state, dt, colliders_[a], colliders_[b]);
    match_radius_ = kMatchRadius * smaller_inradius(colliders_[a], colliders_[b]);
    if (constraints_.size() > first) match_impulses(first, old);
  }
  is_first_ = false;
  return constraints_;
}

}  // namespace rigor
