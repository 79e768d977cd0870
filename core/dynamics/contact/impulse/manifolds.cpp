#include "core/dynamics/contact/impulse/manifolds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/dynamics/collision/coincident.h"

namespace rigor {
namespace {

// In inradii of the body, or of the smaller of two.
constexpr double kFatMargin = 0.1;           // by so much its fat box is wider than itself,
constexpr double kStepsAhead = 20;           // and by its displacement in so many steps,
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

std::pair<int, int> pair_of(const ContactConstraint& point) { return {point.a, point.b}; }

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

bool is_round(const Collider& collider) {
  return std::holds_alternative<Sphere>(collider.shape) || std::holds_alternative<Plane>(collider.shape);
}

// Where two balls, or a ball and a plane, are nearest.
struct RoundTouch {
  Vec3 normal;  // unit, from b to a
  double gap;   // m
};
RoundTouch touch_of(const Collider& a, const Vec3& p_a, const Collider& b, const Vec3& p_b) {
  if (const auto* plane = std::get_if<Plane>(&b.shape))
    return {plane->normal, plane->normal.dot(p_a) - plane->offset - a.inradius};
  if (const auto* plane = std::get_if<Plane>(&a.shape))
    return {-plane->normal, plane->normal.dot(p_b) - plane->offset - b.inradius};
  const Vec3 line = p_a - p_b;
  const double distance = line.norm();
  return {distance > 0 ? Vec3(line / distance) : Vec3::UnitZ(), distance - a.inradius - b.inradius};
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

void Manifolds::place_body(std::size_t i, BodyColumns state, double dt) {
  const Collider& collider = colliders_[i];
  const bool round = std::holds_alternative<Sphere>(collider.shape);
  poses_[i] = {state.position(collider.body), round ? Mat3::Identity() : state.rotation(collider.body)};
  const Vec3 displacement = dt * state.velocity(collider.body);
  const double margin = kSpeculativeMargin * collider.inradius + rotational_displacement(collider, state, dt);
  boxes_[i] = swept_box(collider, poses_[i], displacement, margin);
  const Vec3 v = collider.fixed ? Vec3::Zero() : state.velocity(collider.body);
  places_[i] = {poses_[i].p, collider.bounding_radius + margin + displacement.norm(), v, collider.inradius};
  has_left_[i] = is_first_ || !lies_within(boxes_[i], fat_boxes_[i]);
  if (has_left_[i]) fat_boxes_[i] = is_first_ ? boxes_[i] : fattened(boxes_[i], collider, displacement);
}

// Fat boxes hold for some steps; only those of bodies that leave theirs are chosen and searched anew.
void Manifolds::update_pairs(BodyColumns state, double dt) {
  fat_boxes_.resize(colliders_.size());
  threads_.run([&](std::size_t thread) {
    const auto [first, last] = threads_.share(colliders_.size(), thread);
    for (std::size_t i = first; i < last; ++i) place_body(i, state, dt);
  });
  if (is_first_) {
    pairs_ = &broad_phase_.overlaps(fat_boxes_);
    return;
  }
  moved_.clear();
  for (std::size_t i = 0; i < colliders_.size(); ++i) {
    if (has_left_[i]) moved_.push_back(static_cast<int>(i));
  }
  if (!moved_.empty()) pairs_ = &broad_phase_.overlaps(fat_boxes_, moved_, &threads_);
}

// Whether two bodies stay apart within dt: one and a plane, or two by their boxes. Written so that what is not a number
// does not.
bool Manifolds::stay_apart(int a, int b) const {
  if (const auto* plane = std::get_if<Plane>(&colliders_[a].shape))
    return plane->normal.dot(poses_[b].p) - plane->offset > places_[b].reach;
  if (std::holds_alternative<Plane>(colliders_[b].shape)) return stay_apart(b, a);
  return (boxes_[a].low.array() > boxes_[b].high.array()).any() ||
         (boxes_[b].low.array() > boxes_[a].high.array()).any();
}

void Manifolds::add_pair(BodyColumns state, double dt, const Collider& a, const Collider& b, Part& part) {
  Manifold& manifold = part.manifold;
  const double margin = kSpeculativeMargin * smaller_inradius(a, b),
               turning = rotational_displacement(a, state, dt) + rotational_displacement(b, state, dt);
  FreeMotion motion_a = free_motion_of(state, a, poses_[&a - colliders_.data()]);
  FreeMotion motion_b = free_motion_of(state, b, poses_[&b - colliders_.data()]);
  const Vec3 v = motion_a.v - motion_b.v;
  motion_a.pose.p += aside_of(a, motion_a.pose.p, b, motion_b.pose.p);
  collide(a.shape, motion_a.pose, b.shape, motion_b.pose, manifold);
  // What comes fast touches elsewhere, and along another normal, than where it is nearest now.
  const bool turns_far = turning > kTurnsFar * smaller_inradius(a, b);
  const double speed = rotational_speed(a, state) + rotational_speed(b, state);
  const double ahead = turns_far ? time_of_turning_impact(a, b, motion_a, motion_b, speed, margin, dt)
                                 : time_of_impact(manifold, motion_a, motion_b, dt);
  const bool looks_ahead = ahead * (v.norm() + turning / dt) > margin;
  if (looks_ahead) {
    motion_a.advance(ahead), motion_b.advance(ahead);
    collide(a.shape, motion_a.pose, b.shape, motion_b.pose, manifold);
    for (ManifoldPoint& point : manifold) point.gap += ahead * approach(point, motion_a, motion_b);
  }
  int kept = 0;
  for (const ManifoldPoint& point : manifold) {
    if (point.gap < margin + turning + dt * std::max(0.0, -point.normal.dot(v))) manifold[kept++] = point;
  }
  manifold.keep(kept);
  reduce_to_four(manifold);
  for (const ManifoldPoint& point : manifold) watch(a, b, point.gap, part);
  const ContactLaw& law = laws_.of(a.body, b.body);
  for (const ManifoldPoint& point : manifold) {
    // Between points that are apart `point` is midway; each body will be met on its own surface.
    const Vec3 to_surface = looks_ahead ? Vec3::Zero() : Vec3(0.5 * std::max(0.0, point.gap) * point.normal);
    part.constraints.push_back({a.body, b.body, point.feature, is_parted_from_start(a, b, point.gap), law.friction,
                                law.restitution, point.normal, point.point + to_surface - motion_a.pose.p,
                                point.point - to_surface - motion_b.pose.p, point.gap, 0, Vec3::Zero()});
  }
}

// What add_pair() does, where a turn shows nothing and a line from centre to centre all.
void Manifolds::add_round_pair(double dt, int at_a, int at_b, Part& part) {
  const Collider &a = colliders_[at_a], &b = colliders_[at_b];
  Vec3 p_a = places_[at_a].p, p_b = places_[at_b].p;
  const Vec3 v_a = places_[at_a].v, v_b = places_[at_b].v, v = v_a - v_b;
  const double margin = kSpeculativeMargin * smaller_inradius(a, b);
  p_a += aside_of(a, p_a, b, p_b);
  RoundTouch touch = touch_of(a, p_a, b, p_b);
  const double speed = -touch.normal.dot(v);
  const double ahead = touch.gap > 0 && touch.gap < dt * speed ? touch.gap / speed : 0;
  double overlap = std::min(0.0, touch.gap);
  if (ahead * v.norm() > margin) {
    p_a += ahead * v_a, p_b += ahead * v_b;
    touch = touch_of(a, p_a, b, p_b);
    overlap = touch.gap;  // at their meeting
    touch.gap -= ahead * touch.normal.dot(v);
  }
  if (!(touch.gap < margin + dt * std::max(0.0, -touch.normal.dot(v)))) return;
  watch(a, b, touch.gap, part);
  const auto to_point = [&](const Collider& c) { return std::isfinite(c.inradius) ? c.inradius + 0.5 * overlap : 0; };
  const Vec3 arm_a = -to_point(a) * touch.normal, arm_b = to_point(b) * touch.normal;
  const ContactLaw& law = laws_.of(a.body, b.body);
  part.constraints.push_back({a.body, b.body, 0, is_parted_from_start(a, b, touch.gap), law.friction, law.restitution,
                              touch.normal, arm_a, arm_b, touch.gap, 0, Vec3::Zero()});
}

bool Manifolds::is_parted_from_start(const Collider& a, const Collider& b, double gap) const {
  const auto was_inside = [&](const Collider& c) { return !c.fixed && overlaps_at_start_[c.body] != 0; };
  return gap < -kDeep * smaller_inradius(a, b) && (was_inside(a) || was_inside(b));
}

// What overlaps from the start is parted; nothing else may come to lie in each other.
void Manifolds::watch(const Collider& a, const Collider& b, double gap, Part& part) {
  const double size = smaller_inradius(a, b);
  if (is_first_ && gap < -kDeep * size) overlaps_at_start_[a.body] = overlaps_at_start_[b.body] = 1;
  if (gap >= -kSunk * size || is_parted_from_start(a, b, gap) || !part.failure.empty()) return;
  part.failure = fmt::format(
      "{} and {} overlap by {:.2g} m, which impulses do not hold (much lighter bodies under heavier ones, or bodies "
      "with "
      "no room between others); contact=event may",
      names_[a.body], names_[b.body], -gap);
}

// Gives these constraints, all of one pair, the impulses of that pair's old ones, which start at `old` or later.
void Manifolds::match_impulses(ContactConstraint* first, ContactConstraint* last, double radius, std::size_t& old) {
  const auto pair = pair_of(*first);
  while (old < old_constraints_.size() && pair_of(old_constraints_[old]) < pair) ++old;
  std::size_t end = old;
  while (end < old_constraints_.size() && pair_of(old_constraints_[end]) == pair) ++end;
  unsigned taken = 0;
  for (ContactConstraint* point = first; point < last && end > old; ++point) {
    std::size_t best = end;
    double least = radius;
    for (std::size_t k = old; k < end; ++k) {
      if (taken >> (k - old) & 1) continue;
      const double distance =
          old_constraints_[k].feature == point->feature ? -1 : (old_constraints_[k].arm_a - point->arm_a).norm();
      if (distance < least) least = distance, best = k;
    }
    if (best == end) continue;
    taken |= 1u << (best - old);
    point->normal_impulse = old_constraints_[best].normal_impulse;
    point->friction_impulse = old_constraints_[best].friction_impulse;
  }
}

void Manifolds::add_pairs(std::size_t first_pair, std::size_t last_pair, BodyColumns state, double dt, Part& part) {
  std::size_t old = 0;
  for (std::size_t i = first_pair; i < last_pair; ++i) {
    const auto& [a, b] = (*pairs_)[i];
    const double reach = places_[a].reach + places_[b].reach;
    if ((places_[a].p - places_[b].p).squaredNorm() > reach * reach) continue;
    const bool are_round = is_round(colliders_[a]) && is_round(colliders_[b]);
    if ((colliders_[a].fixed && colliders_[b].fixed) || (!are_round && stay_apart(a, b))) continue;
    const std::size_t first = part.constraints.size();
    if (are_round) {
      add_round_pair(dt, a, b, part);
    } else {
      add_pair(state, dt, colliders_[a], colliders_[b], part);
    }
    if (part.constraints.size() == first) continue;
    ContactConstraint* points = &part.constraints[first];
    if (first == 0) {
      const auto before = [](const ContactConstraint& x, const ContactConstraint& y) {
        return pair_of(x) < pair_of(y);
      };
      old =
          static_cast<std::size_t>(std::lower_bound(old_constraints_.begin(), old_constraints_.end(), *points, before) -
                                   old_constraints_.begin());
    }
    match_impulses(points, points + (part.constraints.size() - first),
                   kMatchRadius * smaller_inradius(colliders_[a], colliders_[b]), old);
  }
}

// The parts' constraints, one part after another.
void Manifolds::join(std::size_t thread) {
  if (parts_.size() == 1) return constraints_.swap(parts_.front().constraints);
  std::size_t size = 0, first = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (i == thread) first = size;
    size += parts_[i].constraints.size();
  }
  if (thread == 0) constraints_.resize(size);
  threads_.meet();
  std::copy(parts_[thread].constraints.begin(), parts_[thread].constraints.end(),
            constraints_.begin() + static_cast<std::ptrdiff_t>(first));
}

// What overlaps at the start is noted while pairs are gone through, by one thread.
std::vector<ContactConstraint>& Manifolds::find(BodyColumns state, double dt) {
  update_pairs(state, dt);
  old_constraints_.swap(constraints_);
  threads_.run([&](std::size_t thread) {
    parts_[thread].constraints.clear();
    const auto [first, last] =
        is_first_ ? ThreadPool::Share{0, thread == 0 ? pairs_->size() : 0} : threads_.share(pairs_->size(), thread);
    add_pairs(first, last, state, dt, parts_[thread]);
    threads_.meet();
    join(thread);
  });
  is_first_ = false;
  return constraints_;
}

std::string Manifolds::failure() const {
  for (const Part& part : parts_) {
    if (!part.failure.empty()) return part.failure;
  }
  return "";
}

}  // namespace rigor
