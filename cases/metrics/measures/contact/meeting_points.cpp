#include "cases/metrics/measures/contact/meeting_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cases/metrics/measures/contact/pair_wrenches.h"
#include "cases/metrics/measures/contact/touching.h"
#include "cases/metrics/measures/shape_gap.h"
#include "core/base/eigen_of.h"
#include "core/dynamics/collision/narrow_phase.h"

namespace rigor::inline metric {
namespace {

// A point may carry that is farther than the pair's nearest by at most this share of the smallest body's half width.
constexpr double kMayCarry = 1e-3;

Pose middle_of(BodyColumns before, BodyColumns after, int body, double dt) {
  const auto i = static_cast<std::size_t>(body);
  const Quat middle = before.orientation(i).normalized().slerp(0.5, after.orientation(i).normalized());
  return {mean_position(before, after, i, dt), matrix_of(middle)};
}

// How a body's surface moves in a step.
struct Surface {
  double way = 0;        // m: no point moves farther, if both ends' velocities bound those between
  double deviation = 0;  // m: of a point from its straight way with the velocity at the start, likewise
  double kick = 0;       // m/s: by which impacts within the step may change the velocity of a point for a while
};

Surface surface_of(const Body& body, BodyColumns before, BodyColumns after, std::size_t i, double dt) {
  if (body.fixed || !body.shape) return {};
  const double radius = bounding_radius(*body.shape);
  const double turning = std::max(before.angular_velocity(i).norm(), after.angular_velocity(i).norm());
  const double changed = (after.velocity(i) - before.velocity(i)).norm() +
                         radius * (after.angular_velocity(i) - before.angular_velocity(i)).norm();
  const double speed = std::max(before.velocity(i).norm(), after.velocity(i).norm()) + radius * turning;
  return {dt * speed, dt * (changed + dt * radius * turning * turning)};
}

// How two bodies approach, if all points go on with their velocities of the start.
struct Approach {
  double gap_after = std::numeric_limits<double>::infinity();  // m: the least, after the step
  double speed = 0;                                            // m/s: of the fastest point
};

Approach approach_of(const Manifold& points, BodyColumns bodies, int a, int b, double dt) {
  Approach found;
  for (const ManifoldPoint& point : points) {
    const double speed = -point.normal.dot(velocity_at(bodies, a, point.point) - velocity_at(bodies, b, point.point));
    found.speed = std::max(found.speed, speed);
    found.gap_after = std::min(found.gap_after, point.gap - dt * std::max(speed, 0.0));
  }
  return found;
}

// Finds the pairs that may meet within a step. An impact may send a body to another one that takes all of its velocity,
// as in Newton's cradle: the velocities at both ends of the step tell nothing of it. Therefore each pair that meets may
// kick its bodies once, and pairs are asked again with these kicks.
class MeetingPairs {
 public:
  MeetingPairs(const Scene& scene, const ContactLaws& laws, BodyColumns before, BodyColumns after, double dt)
      : scene_(scene), laws_(laws), before_(before), dt_(dt), touching_(touching_gap(scene)) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      surfaces_.push_back(surface_of(scene.bodies[i], before, after, i, dt));
    while (ask_all()) {
    }
    for_each_near_pair(scene, after, touching_, [&](int a, int b, double) { pairs_.insert(pair_of(scene, a, b)); });
  }

  const std::set<BodyPair>& pairs() const { return pairs_; }

 private:
  // Whether a pair has kicked its bodies.
  bool ask_all() {
    double farthest = 0;
    for (const Surface& surface : surfaces_)
      farthest = std::max(farthest, surface.way + surface.deviation + dt_ * surface.kick);
    bool has_kicked = false;
    for_each_near_pair(scene_, before_, touching_ + 2 * farthest,
                       [&](int a, int b, double gap) { has_kicked |= ask(a, b, gap); });
    return has_kicked;
  }

  bool ask(int a, int b, double gap) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    Surface &of_a = surfaces_[i], &of_b = surfaces_[j];
    const double kicks = of_a.kick + of_b.kick;
    // Bodies that touch and rest need no more questions.
    if (gap <= touching_ && of_a.way + of_b.way + dt_ * kicks <= touching_) {
      pairs_.insert(pair_of(scene_, a, b));
      return false;
    }
    collide(*scene_.bodies[i].shape, middle_of(before_, before_, a, 0), *scene_.bodies[j].shape,
            middle_of(before_, before_, b, 0), points_);
    const Approach approach = approach_of(points_, before_, a, b, dt_);
    const bool meets =
        gap <= touching_ || approach.gap_after - dt_ * kicks <= touching_ + of_a.deviation + of_b.deviation;
    if (!meets) return false;
    const BodyPair pair = pair_of(scene_, a, b);
    pairs_.insert(pair);
    // A speed that carries a body nowhere within the step is that of a body at rest.
    const double speed = approach.speed + kicks;
    if (dt_ * speed <= touching_ || !have_kicked_.insert(pair).second) return false;
    const double impulse = (1 + laws_.of(a, b).restitution) * speed / (inverse_mass(i) + inverse_mass(j));
    of_a.kick = std::max(of_a.kick, impulse * yielding(i)), of_b.kick = std::max(of_b.kick, impulse * yielding(j));
    return true;
  }

  double inverse_mass(std::size_t i) const { return scene_.bodies[i].fixed ? 0 : 1 / scene_.bodies[i].mass; }

  // At most by how much an impulse changes the velocity of the body's points along it: 1/kg.
  double yielding(std::size_t i) const {
    const Body& body = scene_.bodies[i];
    if (body.fixed || std::holds_alternative<Sphere>(*body.shape)) return inverse_mass(i);
    const double least = eigen_of(body.inertia).values.minCoeff();
    return inverse_mass(i) + std::pow(bounding_radius(*body.shape), 2) / least;
  }

  const Scene& scene_;
  const ContactLaws& laws_;
  BodyColumns before_;
  double dt_, touching_;
  std::vector<Surface> surfaces_;
  std::set<BodyPair> pairs_, have_kicked_;
  Manifold points_;
};

// Whether the two parts that touch have an algorithm that finds one point of an area or a line.
bool stands_for_an_area(const Scene& scene, const BodyPair& pair, const Manifold& points, const ManifoldPoint& at) {
  const auto same_parts = [&](const ManifoldPoint& point) {
    return point.part_a == at.part_a && point.part_b == at.part_b;
  };
  if (std::count_if(points.begin(), points.end(), same_parts) > 1) return false;
  const auto is_round = [&](int body, int part) {
    bool found = false;
    int k = 0;
    for_each_part(*scene.bodies[static_cast<std::size_t>(body)].shape, [&](const Shape& shape, const BodyPose&) {
      if (k++ == part) found = std::holds_alternative<Sphere>(shape) || std::holds_alternative<Ellipsoid>(shape);
    });
    return found;
  };
  return !is_round(pair.first, at.part_a) && !is_round(pair.second, at.part_b);
}

}  // namespace

std::vector<MeetingPoint> meeting_points(const Scene& scene, const ContactLaws& laws, BodyColumns before,
                                         BodyColumns after, double dt) {
  const double size = smallest_half_width(scene);
  std::vector<MeetingPoint> found;
  Manifold points;
  const MeetingPairs meeting(scene, laws, before, after, dt);
  for (const BodyPair& pair : meeting.pairs()) {
    const auto shape = [&](int body) { return *scene.bodies[static_cast<std::size_t>(body)].shape; };
    collide(shape(pair.first), middle_of(before, after, pair.first, dt), shape(pair.second),
            middle_of(before, after, pair.second, dt), points);
    double nearest = std::numeric_limits<double>::infinity();
    for (const ManifoldPoint& point : points) nearest = std::min(nearest, point.gap);
    const ContactLaw& law = laws.of(pair.first, pair.second);
    for (const ManifoldPoint& point : points) {
      if (point.gap > nearest + kMayCarry * size) continue;
      const bool has_couple = law.resists_turning() || stands_for_an_area(scene, pair, points, point);
      found.push_back({pair, point.point, point.normal, law.friction > 0, has_couple});
    }
  }
  return found;
}

}  // namespace rigor::inline metric
