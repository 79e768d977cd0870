#include <fmt/format.h>

#include <algorithm>

#include "adapters/mujoco/mujoco_mjcf.h"

namespace rigor::inline adapters {
namespace {

struct GeomOf {
  const std::string& asset;

  std::string operator()(const Sphere& s) const { return fmt::format(R"(type="sphere" size="{}")", s.radius); }
  std::string operator()(const Box& b) const { return fmt::format(R"(type="box" size="{}")", mjcf_text(b.size / 2)); }
  std::string operator()(const Capsule& c) const {
    return fmt::format(R"(type="capsule" size="{} {}")", c.radius, c.length / 2);
  }
  // A compound, whose parts are written, and shapes that no feature names.
  template <typename Other>
  std::string operator()(const Other&) const {
    return "";
  }
  std::string operator()(const Convex&) const { return fmt::format(R"(type="mesh" mesh="{}")", asset); }
  std::string operator()(const Cylinder& c) const {
    return fmt::format(R"(type="cylinder" size="{} {}")", c.radius, c.length / 2);
  }
  std::string operator()(const Ellipsoid& e) const {
    return fmt::format(R"(type="ellipsoid" size="{}")", mjcf_text(e.radii));
  }
  std::string operator()(const Heightfield& field) const {
    return fmt::format(R"(type="hfield" hfield="{}" pos="0 0 {}")", asset, field.surface->low.z());
  }
  std::string operator()(const Plane& p) const {
    return fmt::format(R"(type="plane" size="0 0 1" pos="{}" zaxis="{}")", mjcf_text(p.normal * p.offset),
                       mjcf_text(p.normal));
  }
};

double relief(const Heightfield& field) { return field.surface->high.z() - field.surface->low.z(); }

// MuJoCo's ground ends below, and the motion on it depends on where: its detector starts from the middle of a column.
// Four shares of the width were tried: 0.001, 0.01, 0.1 and 1. This one has the smallest product of the errors on
// surfaces/box-over-seams and surfaces/slope-of-triangles.
constexpr double kBaseOfWidth = 0.1;

// The element without its heights, which are shares of the relief. Its cells have the same diagonals as the scene's.
std::string asset_of(const Heightfield& field, const std::string& name) {
  const double high = relief(field) > 0 ? relief(field) : 1;
  return fmt::format("<hfield name=\"{}\" nrow=\"{}\" ncol=\"{}\" size=\"{} {} {} {}\"/>\n", name, field.heights.size(),
                     field.heights.front().size(), field.size[0] / 2, field.size[1] / 2, high,
                     kBaseOfWidth * std::max(field.size[0], field.size[1]));
}

std::string asset_of(const Convex& convex, const std::string& name) {
  std::string points;
  for (const Vec3& point : convex.hull->points) points += (points.empty() ? "" : "  ") + mjcf_text(point);
  return fmt::format("<mesh name=\"{}\" vertex=\"{}\"/>\n", name, points);
}

}  // namespace

std::string mjcf_text(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string mjcf_text(const Quat& q) { return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z()); }

std::string mjcf_geom_name(int body, int part) {
  return part == 0 ? fmt::format("g{}", body) : fmt::format("g{}p{}", body, part);
}

std::string mjcf_shape(const Shape& shape, const std::string& asset) { return std::visit(GeomOf{asset}, shape); }

std::string mjcf_pose(const BodyPose& pose) {
  return fmt::format(R"( pos="{}" quat="{}")", mjcf_text(pose.position), mjcf_text(pose.orientation));
}

std::string mjcf_asset(const Shape& shape, const std::string& name) {
  if (const auto* convex = std::get_if<Convex>(&shape)) return asset_of(*convex, name);
  if (const auto* field = std::get_if<Heightfield>(&shape)) return asset_of(*field, name);
  return "";
}

std::vector<float> mujoco_heights(const Scene& scene) {
  std::vector<float> heights;
  for (const Body& body : scene.bodies) {
    const auto* field = body.collides ? std::get_if<Heightfield>(&*body.shape) : nullptr;
    if (!field) continue;
    const double low = field->surface->low.z(), high = relief(*field) > 0 ? relief(*field) : 1;
    for (const std::vector<double>& row : field->heights) {
      for (const double height : row) heights.push_back(static_cast<float>((height - low) / high));
    }
  }
  return heights;
}

}  // namespace rigor::inline adapters
