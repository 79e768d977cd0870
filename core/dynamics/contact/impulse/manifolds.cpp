#include "core/dynamics/contact/impulse/manifolds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/dynamics/collision/coincident.h"
#include "core/dynamics/contact/impulse/free_motion.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

// In inradii of the body, or of the smaller of two.
constexpr double kFatMargin = 0.1;           // the margin by which its fat box is larger than the body,
constexpr double kStepsAhead = 20;           // and by its displacement in so many steps,
constexpr double kFarthest = 1.5;            // but not by more than this
constexpr double kSpeculativeMargin = 0.02;  // points closer than this are kept even if they do not approach
constexpr double kMatchRadius = 0.1;         // a point this near to one of the last update is the same
constexpr double kDeep = 0.02;               // an overlap of more at the start is parted, and no contact
constexpr double kSunk = 0.5;                // one of more is no contact any longer
constexpr double kTurnsFar = 0.25;           // a surface that turns farther is followed on its way
constexpr double kNearlyCoincident = 0.999;  // an overlap of so much of both radii may have no direction
constexpr int kMostOfPair = 4;               // points of two shapes
constexpr int kMostOfBodies = 32;            // points of two bodies of several shapes: one bit each in match_impulses()
constexpr double kEqualScores = 1e-6;        // of a manifold's width: points that differ by less are equally good

double smaller_inradius(const Collider& a, const Collider& b) { return std::min(a.inradius, b.inradius); }

// The largest distance by which its rotation within dt can move a body's surface; zero for a round body.
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

// Four points hold a face as well as eight. The first is the deepest, the second the one furthest from it. The third
// and fourth are furthest from the line between these, one on each side. Several points can be equally deep but for
// rounding. The one furthest from the centre of all is then the first. Edges that are nearly parallel cross far from
// their ends. A crossing in place of a corner would leave the face without support there. In a tie the earlier point
// counts. Returns the end of those kept of [begin, end).
int reduce_to_four(Manifold& points, int begin, int end) {
  if (end - begin <= kMostOfPair) return end;
  const double equal = kEqualScores * (points[begin + kMostOfPair].point - points[begin].point).norm();
  const auto take = [&](int at, const auto& score) {
    int best = begin + at;
    for (int i = begin + at + 1; i < end; ++i) {
      if (score(points[i]) > score(points[best]) + equal) best = i;
    }
    std::swap(points[begin + at], points[best]);
  };
  double least = points[begin].gap;
  Vec3 centre = Vec3::Zero();
  for (int i = begin; i < end; ++i) least = std::min(least, points[i].gap), centre += points[i].point / (end - begin);
  take(0, [&](const ManifoldPoint& p) { return p.gap > least + equal ? -1 : (p.point - centre).norm(); });
  const ManifoldPoint first = points[begin];
  take(1, [&](const ManifoldPoint& p) { return (p.point - first.point).norm(); });
  const Vec3 side = first.normal.cross(points[begin + 1].point - first.point).normalized();
  take(2, [&](const ManifoldPoint& p) { return std::abs(side.dot(p.point - first.point)); });
  const double sign = side.dot(points[begin + 2].point - first.point) < 0 ? 1 : -1;
  take(3, [&](const ManifoldPoint& p) { return sign * side.dot(p.point - first.point); });
  return begin + kMostOfPair;
}

// Four points of each two parts that touch, of kMostOfBodies at most.
void reduce(Manifold& points) {
  if (points.size() <= kMostOfPair) return;
  const auto same_parts = [](const ManifoldPoint& x, const ManifoldPoint& y) {
    return x.part_a == y.part_a && x.part_b == y.part_b;
  };
  int kept = 0;
  for (int begin = 0, end = 0; begin < points.size(); begin = end) {
    for (end = begin; end < points.size() && same_parts(points[begin], points[end]);) ++end;
    const int last = reduce_to_four(points, begin, end);
    for (int i = begin; i < last && kept < kMostOfBodies; ++i) points[kept++] = points[i];
  }
  points.keep(kept);
}

}  // namespace

void Manifolds::place_body(std::size_t i, BodyColumns state, double dt) {
  const Collider& collider = colliders_[i];
  poses_[i].p = state.position(collider.body);
  if (kinds_[i] != Kind::ball) poses_[i].R = state.rotation(collider.body) * axes_[i].asDiagonal();
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

// Whether two bodies stay apart within dt: one and a plane, or two by their boxes. Written so that NaN returns false.
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
  // A fast body touches at another place, and along another normal, than those of its present nearest point.
  const bool turns_far = turning > kTurnsFar * smaller_inradius(a, b);
  collide(a.shape, motion_a.pose, b.shape, motion_b.pose, manifold, margin + turning + dt * v.norm());
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
  reduce(manifold);
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

// As add_pair(), for pairs in which rotation has no effect and the line between the centres determines everything.
void Manifolds::add_balls(int at_a, int at_b, const BallContacts& contacts, std::size_t k, Part& part) {
  if (!(contacts.excess[k] < 0)) return;
  const Vec3 normal(contacts.normal[0][k], contacts.normal[1][k], contacts.normal[2][k]);
  const double middle = 0.5 * contacts.overlap[k];
  add_round(colliders_[at_a], colliders_[at_b], normal, -(places_[at_a].inradius + middle) * normal,
            (places_[at_b].inradius + middle) * normal, contacts.gap[k], part);
}

void Manifolds::add_coincident_balls(double dt, int at_a, int at_b, Part& part) {
  std::array<Place, 2> places = {places_[at_a], places_[at_b]};
  places[0].p += aside_of(colliders_[at_a], places[0].p, colliders_[at_b], places[1].p);
  const std::pair<int, int> pair(0, 1);
  const std::int32_t near = 0;
  BallContacts contacts;
  contact_kernels().ball_contacts(places[0].p.data(), &pair, &near, 1, dt, kSpeculativeMargin, &contacts);
  add_balls(at_a, at_b, contacts, 0, part);
}

void Manifolds::add_ball_on_plane(double dt, int ball, int plane, Part& part) {
  const Plane& below = std::get<Plane>(colliders_[plane].shape);
  const Place& place = places_[ball];
  const double gap = below.normal.dot(place.p) - below.offset - place.inradius;
  if (!(gap < kSpeculativeMargin * place.inradius + dt * std::max(0.0, -below.normal.dot(place.v)))) return;
  const Vec3 arm = -(place.inradius + 0.5 * std::min(0.0, gap)) * below.normal;
  if (ball < plane) {
    add_round(colliders_[ball], colliders_[plane], below.normal, arm, Vec3::Zero(), gap, part);
  } else {
    add_round(colliders_[plane], colliders_[ball], -below.normal, Vec3::Zero(), arm, gap, part);
  }
}

void Manifolds::add_round(const Collider& a, const Collider& b, const Vec3& normal, const Vec3& arm_a,
                          const Vec3& arm_b, double gap, Part& part) {
  watch(a, b, gap, part);
  const ContactLaw& law = laws_.of(a.body, b.body);
  part.constraints.push_back({a.body, b.body, 0, is_parted_from_start(a, b, gap), law.friction, law.restitution, normal,
                              arm_a, arm_b, gap, 0, Vec3::Zero()});
}

bool Manifolds::is_parted_from_start(const Collider& a, const Collider& b, double gap) const {
  const auto was_inside = [&](const Collider& c) { return !c.fixed && overlaps_at_start_[c.body] != 0; };
  return gap < -kDeep * smaller_inradius(a, b) && (was_inside(a) || was_inside(b));
}

// Overlap of the start is removed; no other bodies may come to overlap deeply.
void Manifolds::watch(const Collider& a, const Collider& b, double gap, Part& part) {
  const double size = smaller_inradius(a, b);
  if (is_first_ && gap < -kDeep * size) overlaps_at_start_[a.body] = overlaps_at_start_[b.body] = 1;
  if (gap >= -kSunk * size || is_parted_from_start(a, b, gap) || !part.failure.empty()) return;
  part.failure = fmt::format(
      "{} and {} overlap by {:.2g} m, which impulses cannot hold: a light body under a heavy one, or no room between "
      "others; try contact=event",
      names_[a.body], names_[b.body], -gap);
}

// Gives a pair's constraints, which start at `first`, the impulses of its old ones, which start at `old` or later.
void Manifolds::match_impulses(const std::pair<int, int>& at, std::size_t first, Part& part, std::size_t& old) const {
  const auto before = [&](const ContactConstraint& x, const std::pair<int, int>& y) { return ranks_of(x) < y; };
  const std::pair<int, int> pair = ranks_of(part.constraints[first]);
  if (first == 0) {
    const auto begin = std::lower_bound(old_constraints_.begin(), old_constraints_.end(), pair, before);
    old = static_cast<std::size_t>(begin - old_constraints_.begin());
  }
  while (old < old_constraints_.size() && before(old_constraints_[old], pair)) ++old;
  std::size_t end = old;
  while (end < old_constraints_.size() && ranks_of(old_constraints_[end]) == pair) ++end;
  const double radius = kMatchRadius * smaller_inradius(colliders_[at.first], colliders_[at.second]);
  unsigned taken = 0;
  for (std::size_t i = first; i < part.constraints.size() && end > old; ++i) {
    ContactConstraint& point = part.constraints[i];
    std::size_t best = end;
    double least = radius;
    for (std::size_t k = old; k < end; ++k) {
      if (taken >> (k - old) & 1) continue;
      const double distance =
          old_constraints_[k].feature == point.feature ? -1 : (old_constraints_[k].arm_a - point.arm_a).norm();
      if (distance < least) least = distance, best = k;
    }
    if (best == end) continue;
    taken |= 1u << (best - old);
    point.normal_impulse = old_constraints_[best].normal_impulse;
    point.friction_impulse = old_constraints_[best].friction_impulse;
    point.rest_overlap = old_constraints_[best].rest_overlap;
  }
}

void Manifolds::add_points_of(std::size_t i, const std::pair<int, int>& pair, BodyColumns state, double dt,
                              Part& part) {
  const auto [a, b] = pair;
  const Kind kind_a = kinds_[a], kind_b = kinds_[b];
  if (kind_a == Kind::ball && kind_b == Kind::ball) {
    const BallContacts& contacts = part.ball_contacts[i / kRowsPerBlock];
    const double gap = contacts.gap[i % kRowsPerBlock], least = places_[a].inradius + places_[b].inradius;
    if (!(gap > -kNearlyCoincident * least)) return add_coincident_balls(dt, a, b, part);
    return add_balls(a, b, contacts, i % kRowsPerBlock, part);
  }
  if (kind_a == Kind::ball && kind_b == Kind::plane) return add_ball_on_plane(dt, a, b, part);
  if (kind_a == Kind::plane && kind_b == Kind::ball) return add_ball_on_plane(dt, b, a, part);
  if (!stay_apart(a, b)) add_pair(state, dt, colliders_[a], colliders_[b], part);
}

void Manifolds::add_pairs(std::size_t first_pair, std::size_t last_pair, BodyColumns state, double dt, Part& part) {
  std::size_t old = 0;
  for (std::size_t begin = first_pair; begin < last_pair; begin += kBatch) {
    const double* places = places_.front().p.data();
    const std::pair<int, int>* pairs = pairs_->data() + begin;
    const std::size_t near =
        contact_kernels().near_pairs(places, pairs, std::min(kBatch, last_pair - begin), part.near.data());
    contact_kernels().ball_contacts(places, pairs, part.near.data(), near, dt, kSpeculativeMargin,
                                    part.ball_contacts.data());
    for (std::size_t i = 0; i < near; ++i) {
      const auto& pair = pairs[part.near[i]];
      const std::size_t first = part.constraints.size();
      const Collider &a = colliders_[pair.first], &b = colliders_[pair.second];
      if (!(a.fixed && b.fixed) && laws_.may_touch(a.body, b.body)) add_points_of(i, pair, state, dt, part);
      if (part.constraints.size() > first) match_impulses(pair, first, part, old);
    }
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

// Overlap of the start is noted while one thread goes through the pairs.
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

// The pairs follow from the fat boxes. Only the constraints of the last update hand their impulses on.
void Manifolds::archive_state(StateArchive& archive) {
  std::string failure = this->failure();
  archive(is_first_, overlaps_at_start_, constraints_, failure);
  for (Part& part : parts_) part.failure.clear();
  parts_.front().failure = failure;
  if (is_first_) return;
  fat_boxes_.resize(colliders_.size());
  archive.each(fat_boxes_, [&](Aabb& box) { archive(box.low, box.high); });
  if (archive.restores()) pairs_ = &broad_phase_.overlaps(fat_boxes_);
}

std::string Manifolds::failure() const {
  for (const Part& part : parts_) {
    if (!part.failure.empty()) return part.failure;
  }
  return "";
}

}  // namespace rigor::inline dynamics
