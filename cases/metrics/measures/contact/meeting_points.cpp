#include "cases/metrics/measures/contact/meeting_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cases/metrics/measures/contact/pair_wrenches.h"
#include "cases/metrics/measures/shape_gap.h"
#include "core/dynamics/collision/narrow_phase.h"

namespace rigor {
namespace {

// Of the smallest body's half width. A gap below the first is closed: it is beyond the rounding of a truth's
// positions, and below any gap that a scene means. A point within the second of the pair's nearest may carry.
constexpr double kTouching = 1e-7, kMayCarry = 1e-3;

double smallest_half_width(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : scene.bodies)
    if (body.shape && !body.fixed) least = std::min(least, inradius(*body.shape));
  return least;
}

Pose middle_of(BodyColumns before, BodyColumns after, int body, double dt) {
  const auto i = static_cast<std::size_t>(body);
  const Quat middle = before.orientation(i).normalized().slerp(0.5, after.orientation(i).normalized());
  return {mean_position(before, after, i, dt), matrix_of(middle)};
}

// How a body's surface moves in a step.
struct Surface {
  double way = 0;        // m: no point moves farther, if both ends' velocities bound those between
  double deviation = 0;  // m: of a point from its straight way with the velocity at the start, likewise
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

// The least gap, if all points went on with their velocities of the start.
double gap_after(const Manifold& points, BodyColumns bodies, int a, int b, double dt) {
  const auto velocity = [&](int body, const Vec3& at) {
    const auto i = static_cast<std::size_t>(body);
    return Vec3(bodies.velocity(i) + bodies.angular_velocity(i).cross(at - bodies.position(i)));
  };
  double least = std::numeric_limits<double>::infinity();
  for (const ManifoldPoint& point : points) {
    const double rate = point.normal.dot(velocity(a, point.point) - velocity(b, point.point));
    least = std::min(least, point.gap + dt * std::min(rate, 0.0));
  }
  return least;
}

std::set<BodyPair> meeting_pairs(const Scene& scene, BodyColumns before, BodyColumns after, double dt,
                                 double touching) {
  std::vector<Surface> surfaces;
  double farthest = 0, most = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    surfaces.push_back(surface_of(scene.bodies[i], before, after, i, dt));
    farthest = std::max(farthest, surfaces.back().way), most = std::max(most, surfaces.back().deviation);
  }
  std::set<BodyPair> pairs;
  Manifold points;
  for_each_near_pair(scene, before, 2 * (farthest + most) + touching, [&](int a, int b, double gap) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    bool meets = gap <= touching;
    if (!meets) {
      collide(*scene.bodies[i].shape, middle_of(before, before, a, 0), *scene.bodies[j].shape,
              middle_of(before, before, b, 0), points);
      meets = gap_after(points, before, a, b, dt) <= touching + surfaces[i].deviation + surfaces[j].deviation;
    }
    if (meets) pairs.insert(pair_of(scene, a, b));
  });
  for_each_near_pair(scene, after, touching, [&](int a, int b, double) { pairs.insert(pair_of(scene, a, b)); });
  return pairs;
}

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
  for (const BodyPair& pair : meeting_pairs(scene, before, after, dt, kTouching * size)) {
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

}  // namespace rigor
