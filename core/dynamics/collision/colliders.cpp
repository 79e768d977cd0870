#include "core/dynamics/collision/colliders.h"

namespace rigor::inline dynamics {
namespace {

// What a shape fills along W's axes, relative to the pose's origin.
struct Extent {
  const Mat3& R;

  static Aabb symmetric(const Vec3& half) { return {-half, half}; }
  Aabb operator()(const Box& b) const { return symmetric(R.cwiseAbs() * (0.5 * b.size)); }
  Aabb operator()(const Capsule& c) const {
    return symmetric(R.col(2).cwiseAbs() * (0.5 * c.length) + Vec3::Constant(c.radius));
  }
  Aabb operator()(const Compound& c) const {
    Aabb all = {Vec3::Constant(kEndless), Vec3::Constant(-kEndless)};
    for (const PlacedShape& part : c.parts) {
      const Aabb box = aabb_of(part.shape, Pose{Vec3::Zero(), R} * part.pose, 0);
      all.low = all.low.cwiseMin(box.low), all.high = all.high.cwiseMax(box.high);
    }
    return all;
  }
  Aabb operator()(const Convex& c) const {
    Aabb all = {Vec3::Constant(kEndless), Vec3::Constant(-kEndless)};
    for (const Vec3& point : c.hull->points) {
      const Vec3 at = R * point;
      all.low = all.low.cwiseMin(at), all.high = all.high.cwiseMax(at);
    }
    return all;
  }
  Aabb operator()(const Cylinder& c) const {
    const Vec3 along = R.col(2).cwiseAbs(), across = (1 - along.array().square()).cwiseMax(0).sqrt().matrix();
    return symmetric(along * (0.5 * c.length) + across * c.radius);
  }
  template <typename Solid>
  requires(!kStandsStill<Solid>) Aabb operator()(const Solid& solid) const {
    Aabb all;
    for (int k = 0; k < 3; ++k) {
      const Vec3 along = R.row(k);
      all.low[k] = along.dot(solid.support(-along)), all.high[k] = along.dot(solid.support(along));
    }
    return all;
  }
  Aabb operator()(const SurfaceShape& on) const {
    const Vec3 middle = R * (0.5 * (on.surface->low + on.surface->high)),
               half = R.cwiseAbs() * (0.5 * (on.surface->high - on.surface->low));
    return {middle - half, middle + half};
  }
  Aabb operator()(const Plane&) const { return symmetric(Vec3::Constant(kEndless)); }
  Aabb operator()(const Sphere& s) const { return symmetric(Vec3::Constant(s.radius)); }
};

}  // namespace

std::vector<Collider> colliders_of(const Scene& scene) {
  std::vector<Collider> colliders;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.collides) continue;
    colliders.push_back({i, *body.shape, bounding_radius(*body.shape), inradius(*body.shape), body.fixed});
  }
  return colliders;
}

Pose pose_of(BodyColumns state, int body) { return {state.position(body), state.rotation(body)}; }

Aabb aabb_of(const Shape& shape, const Pose& pose, double margin) {
  const Aabb extent = std::visit(Extent{pose.R}, shape);
  return {pose.p + (extent.low - Vec3::Constant(margin)), pose.p + (extent.high + Vec3::Constant(margin))};
}

}  // namespace rigor::inline dynamics
