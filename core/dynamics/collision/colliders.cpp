#include "core/dynamics/collision/colliders.h"

#include <limits>

#include "core/dynamics/model/contact_scales.h"

namespace rigor {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Inradius {
  double operator()(const Sphere& s) const { return s.radius; }
  double operator()(const Box& b) const { return 0.5 * b.size.minCoeff(); }
  double operator()(const Capsule& c) const { return c.radius; }
  double operator()(const Plane&) const { return kInfinity; }
};

// Half the width along each of W's axes.
struct HalfWidth {
  const Mat3& R;
  Vec3 operator()(const Sphere& s) const { return Vec3::Constant(s.radius); }
  Vec3 operator()(const Box& b) const { return R.cwiseAbs() * (0.5 * b.size); }
  Vec3 operator()(const Capsule& c) const { return R.col(2).cwiseAbs() * (0.5 * c.length) + Vec3::Constant(c.radius); }
  Vec3 operator()(const Plane&) const { return Vec3::Constant(kInfinity); }
};

}  // namespace

std::vector<Collider> colliders_of(const Scene& scene) {
  std::vector<Collider> colliders;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.collides) continue;
    colliders.push_back(
        {i, *body.shape, enclosing_radius(*body.shape), std::visit(Inradius{}, *body.shape), body.fixed});
  }
  return colliders;
}

Pose pose_of(BodyColumns state, int body) { return {state.position(body), state.rotation(body)}; }

Aabb aabb_of(const Shape& shape, const Pose& pose, double margin) {
  const Vec3 half = std::visit(HalfWidth{pose.R}, shape) + Vec3::Constant(margin);
  return {pose.p - half, pose.p + half};
}

}  // namespace rigor
