#include "cases/truth/flat_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

constexpr double kBehind = 1e-12;  // of the bounding radius: points of the region's plane are not in front of it
constexpr int kInstants = 2000;    // at which the bodies are looked at

// A flat region of a surface, in W.
struct Region {
  Plane plane;
  struct Side {
    Vec3 from, inwards;  // m; unit, in the plane
  };
  std::vector<Side> border;
  double area = 0;  // m²

  // m, how far the foot of a point is from the border; negative outside. Exact for a convex region, and less elsewhere.
  double inside(const Vec3& p) const {
    double least = kEndless;
    for (const Side& side : border) least = std::min(least, side.inwards.dot(p - side.from));
    return least;
  }
};

std::map<int, Region> regions_of(const TriangleSurface& surface, const BodyPose& pose) {
  std::map<int, Region> regions;
  const auto at = [&](int corner) -> Vec3 {
    return pose.position + pose.orientation * surface.points[static_cast<std::size_t>(corner)];
  };
  for (const TriangleSurface::Triangle& triangle : surface.triangles) {
    Region& region = regions[triangle.patch];
    const Vec3 a = at(triangle.corners[0]), b = at(triangle.corners[1]), c = at(triangle.corners[2]);
    const Vec3 normal = pose.orientation * triangle.normal;
    if (region.area == 0) region.plane = {normal, normal.dot(a)};
    region.area += 0.5 * (b - a).cross(c - a).norm();
    for (std::size_t k = 0; k < 3; ++k) {
      const int beside = triangle.beside[k];
      if (beside >= 0 && surface.triangles[static_cast<std::size_t>(beside)].patch == triangle.patch) continue;
      const Vec3 from = at(triangle.corners[k]), to = at(triangle.corners[(k + 1) % 3]);
      region.border.push_back({from, normal.cross((to - from).normalized())});
    }
  }
  return regions;
}

std::optional<Region> ground_of(const Body& body, const Vec3& gravity) {
  const SurfaceShape* on = body.shape ? surface_in(*body.shape) : nullptr;
  if (!on) return {};
  const BodyPose pose{body.position, body.orientation};
  const auto lies_behind = [&](const Plane& plane) {
    return std::all_of(on->surface->points.begin(), on->surface->points.end(), [&](const Vec3& point) {
      const Vec3 p = pose.position + pose.orientation * point;
      return plane.normal.dot(p) - plane.offset <= kBehind * (on->surface->bounding_radius + pose.position.norm());
    });
  };
  std::optional<Region> best;
  const auto rank = [&](const Region& region) { return std::pair(-region.plane.normal.dot(gravity), region.area); };
  for (const auto& [patch, region] : regions_of(*on->surface, pose)) {
    if (lies_behind(region.plane) && (!best || rank(region) > rank(*best))) best = region;
  }
  return best;
}

class OverGround : public Truth {
 public:
  OverGround(const Scene& scene, std::unique_ptr<Truth> on_plane) : scene_(scene), on_plane_(std::move(on_plane)) {}

  void at(double t, MutableBodyColumns out) const override {
    on_plane_->at(t, out);
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const Body& body = scene_.bodies[i];
      if (body.shape && surface_in(*body.shape))
        out.set_body(i, {body.position, body.orientation, Vec3::Zero(), Vec3::Zero()});
    }
  }
  double error(double t) const override { return t < end_ ? on_plane_->error(t) : kEndless; }
  std::string caveat() const override {
    const std::string own = on_plane_->caveat();
    return own.empty() || why_.empty() ? own + why_ : own + " " + why_;
  }
  void end_at(double t, std::string why) { end_ = t, why_ = std::move(why); }

 private:
  Scene scene_;
  std::unique_ptr<Truth> on_plane_;
  double end_ = kEndless;  // s
  std::string why_;
};

struct Ground {
  std::size_t body;
  Region region;
};

std::vector<Ground> grounds_of(const Scene& scene) {
  std::vector<Ground> grounds;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (auto region = ground_of(scene.bodies[i], scene.gravity)) grounds.push_back({i, std::move(*region)});
  }
  return grounds;
}

// "'ball' is at the border of the flat part of 'ground'"; empty if all are in front of it.
std::string who_leaves(const Scene& scene, const std::vector<Ground>& grounds, BodyColumns bodies) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed || !body.collides) continue;
    for (const Ground& ground : grounds) {
      const Plane& plane = ground.region.plane;
      const bool is_behind = plane.normal.dot(bodies.position(i)) < plane.offset;
      if (is_behind || ground.region.inside(bodies.position(i)) < bounding_radius(*body.shape))
        return fmt::format("'{}' is {} the flat part of '{}'", body.name, is_behind ? "behind" : "at the border of",
                           scene.bodies[ground.body].name);
    }
  }
  return "";
}

}  // namespace

Scene on_planes(const Scene& scene) {
  Scene flat = scene;
  for (Body& body : flat.bodies) {
    const auto ground = ground_of(body, scene.gravity);
    if (!ground) continue;
    body.shape = ground->plane;
    body.position = Vec3::Zero(), body.orientation = Quat::Identity();
  }
  return flat;
}

std::unique_ptr<Truth> truth_over_ground(const Scene& scene, std::unique_ptr<Truth> on_plane, double duration) {
  const std::vector<Ground> grounds = grounds_of(scene);
  if (grounds.empty()) return on_plane;
  auto truth = std::make_unique<OverGround>(scene, std::move(on_plane));
  BodyTable bodies(scene.bodies.size());
  for (int k = 0; k <= kInstants; ++k) {
    const double t = duration * k / kInstants;
    truth->at(t, bodies.columns());
    const std::string who = who_leaves(scene, grounds, std::as_const(bodies).columns());
    if (who.empty()) continue;
    if (k == 0) throw InputError(fmt::format("{} from the start; allowed: a larger one, or the truth 'none'", who));
    truth->end_at(duration * (k - 1) / kInstants,
                  fmt::format("From {:.3g} s on {}, where its motion is not known.", t, who));
    break;
  }
  return truth;
}

}  // namespace rigor::inline truth
