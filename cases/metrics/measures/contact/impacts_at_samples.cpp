#include "cases/metrics/measures/contact/impacts_at_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cases/metrics/measures/contact/touching.h"
#include "cases/metrics/measures/shape_gap.h"
#include "core/dynamics/collision/narrow_phase.h"

namespace rigor::inline metric {
namespace {

// m/s: no point of the body is faster.
double fastest_point(const Body& body, BodyColumns bodies, std::size_t i) {
  if (body.fixed) return 0;
  return bodies.velocity(i).norm() + bounding_radius(*body.shape) * bodies.angular_velocity(i).norm();
}

class ImpactsAtSample {
 public:
  ImpactsAtSample(const Scene& scene, BodyColumns bodies, double dt)
      : scene_(scene), bodies_(bodies), dt_(dt), touching_(touching_gap(scene)), is_hit_(scene.bodies.size(), false) {
    for_each_near_pair(scene, bodies, touching_, [&](int a, int b, double) { pairs_.push_back({a, b}); });
    for (const auto& [a, b] : pairs_)
      if (has_impact(a, b)) hit(a, b);
  }

  std::set<BodyPair> reached() {
    std::set<BodyPair> found;
    for (bool is_more = true; is_more;) {
      is_more = false;
      for (const auto& [a, b] : pairs_) {
        if (!is_hit_[index(a)] && !is_hit_[index(b)]) continue;
        is_more |= found.insert(pair_of(scene_, a, b)).second;
        hit(a, b);
      }
    }
    return found;
  }

 private:
  static std::size_t index(int body) { return static_cast<std::size_t>(body); }

  // A fixed body passes nothing on.
  void hit(int a, int b) {
    for (const int body : {a, b}) is_hit_[index(body)] = !scene_.bodies[index(body)].fixed;
  }

  bool has_impact(int a, int b) {
    const auto i = index(a), j = index(b);
    const double fastest = fastest_point(scene_.bodies[i], bodies_, i) + fastest_point(scene_.bodies[j], bodies_, j);
    if (dt_ * fastest <= touching_) return false;
    collide(*scene_.bodies[i].shape, pose_of(i), *scene_.bodies[j].shape, pose_of(j), points_);
    return std::any_of(points_.begin(), points_.end(), [&](const ManifoldPoint& point) {
      const double speed =
          point.normal.dot(velocity_at(bodies_, a, point.point) - velocity_at(bodies_, b, point.point));
      return std::abs(point.gap) <= touching_ && dt_ * std::abs(speed) > touching_;
    });
  }

  Pose pose_of(std::size_t i) const { return {bodies_.position(i), matrix_of(bodies_.orientation(i).normalized())}; }

  const Scene& scene_;
  BodyColumns bodies_;
  double dt_, touching_;
  std::vector<bool> is_hit_;
  std::vector<std::pair<int, int>> pairs_;
  Manifold points_;
};

}  // namespace

std::set<BodyPair> pairs_with_impact_at(const Scene& scene, BodyColumns bodies, double dt) {
  return ImpactsAtSample(scene, bodies, dt).reached();
}

}  // namespace rigor::inline metric
