#include "core/dynamics/contact/event/clearance/surface_clearance.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {
const TriangleSurface* surface_of(const Collider& collider) {
  const SurfaceShape* on = surface_in(collider.shape);
  return on ? on->surface.get() : nullptr;
}

SurfaceClearance::SurfaceClearance(const Collider& body, const Collider& surface, const Way& way)
    : body_(body), surface_(*surface_of(surface)), pose_(pose_of(way.from, surface.body)), way_(way) {
  // A path bends away from its chord by at most a h²/8, and a body that turns may reach as far as its furthest point.
  double margin = way.missed + 0.125 * way.h * way.h * way.bend.of_centre;
  margin += std::min(1.0, way.h * way.spin) * (body.bounding_radius - body.inradius);
  const Aabb from = aabb_of(body.shape, pose_of(way.from, body.body), margin),
             to = aabb_of(body.shape, pose_of(way.to, body.body), margin);
  const Vec3 low = from.low.cwiseMin(to.low), high = from.high.cwiseMax(to.high);
  const Vec3 middle = pose_.R.transpose() * (0.5 * (low + high) - pose_.p),
             half = pose_.R.transpose().cwiseAbs() * (0.5 * (high - low));
  surface_.find_near(middle - half, middle + half, near_);
}

bool SurfaceClearance::stays_off(const std::vector<int>& touched, const std::vector<Vec3>& normals,
                                 bool is_near) const {
  return std::all_of(near_.begin(), near_.end(), [&](int t) {
    if (std::find(touched.begin(), touched.end(), surface_.triangles[t].patch) != touched.end()) return true;
    if (is_clear(t, normals, way_.from, 0.5 * way_.h) && is_clear(t, normals, way_.to, -0.5 * way_.h)) return true;
    return is_near && longest_move() <= std::min(0.25 * least_height(t), 0.5 * body_.inradius);
  });
}

Vec3 SurfaceClearance::corner(int triangle, int k) const {
  return pose_.p + pose_.R * surface_.points[surface_.triangles[triangle].corners[k]];
}

Vec3 SurfaceClearance::centre(BodyColumns state) const { return state.position(body_.body); }

// The bound along an axis is largest at an end of the time.
bool SurfaceClearance::is_clear(int triangle, const std::vector<Vec3>& normals, BodyColumns state, double t) const {
  const Vec3 corners[] = {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
  const auto separates = [&](const Vec3& n) {
    const double top = std::max({n.dot(corners[0]), n.dot(corners[1]), n.dot(corners[2])}) - way_.missed;
    return -reach_at_most(body_, state, -n, way_.bend, 0) >= top &&
           -reach_at_most(body_, state, -n, way_.bend, t) >= top;
  };
  const TriangleSurface::Triangle& at = surface_.triangles[triangle];
  if (separates(pose_.R * at.normal)) return true;
  const Vec3 nearest = surface_.nearest_on(at, pose_.R.transpose() * (centre(state) - pose_.p)),
             line = centre(state) - pose_.p - pose_.R * nearest;
  if (line.norm() > 0 && separates(line.normalized())) return true;
  return std::any_of(normals.begin(), normals.end(), separates);
}

// m, of any point of the body; a ball's centre tells all.
double SurfaceClearance::longest_move() const {
  const double speed = std::max(way_.from.velocity(body_.body).norm(), way_.to.velocity(body_.body).norm());
  const bool is_ball = body_.inradius == body_.bounding_radius;
  const double arm = is_ball ? 0 : body_.bounding_radius, bend = is_ball ? way_.bend.of_centre : way_.bend.of_points;
  return way_.h * (speed + arm * way_.spin + 0.5 * way_.h * bend);
}

double SurfaceClearance::least_height(int triangle) const {
  const Vec3 a = corner(triangle, 0), u = corner(triangle, 1) - a, v = corner(triangle, 2) - a;
  return u.cross(v).norm() / std::max({u.norm(), v.norm(), (u - v).norm()});
}

}  // namespace rigor::inline dynamics
