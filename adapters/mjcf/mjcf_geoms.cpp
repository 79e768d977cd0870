#include <fmt/format.h>

#include "adapters/mjcf/mjcf_import.h"
#include "core/base/error.h"

namespace rigor {
namespace {

using namespace mjcf;

std::optional<Shape> hull_of_geom(MjcfImport& import, int geom) {
  const int mesh = import.whole("geom_dataid", geom);
  const int first = import.whole("mesh_vertadr", mesh), count = import.whole("mesh_vertnum", mesh);
  std::vector<Vec3> points;
  for (int k = first; k < first + count; ++k) points.push_back(import.vector("mesh_vert", k));
  try {
    return Convex{hull_of(points)};
  } catch (const InputError& error) {
    import.lose("geom", geom, "a mesh", fmt::format("has no hull: {}", error.what()));
    return {};
  }
}

std::optional<Shape> shape_of(MjcfImport& import, int geom, const BodyPose& pose) {
  const Vec3 size = import.vector("geom_size", geom);
  switch (import.whole("geom_type", geom)) {
    case kSphere:
      return Sphere{size.x()};
    case kBox:
      return Box{2 * size};
    case kCapsule:
      return Capsule{size.x(), 2 * size.y()};
    case kCylinder:
      return Cylinder{size.x(), 2 * size.y()};
    case kEllipsoid:
      return Ellipsoid{size};
    case kPlane: {
      const Vec3 normal = (pose.orientation * Vec3::UnitZ()).normalized();
      return Plane{normal, normal.dot(pose.position)};
    }
    case kMesh:
      return hull_of_geom(import, geom);
    default:
      import.lose("geom", geom, "a height field or a distance field", "no scene has it: nothing touches it");
      return {};
  }
}

void read_geom(MjcfImport& import, int geom) {
  const std::string where = import.at("geom", geom);
  const auto type = static_cast<unsigned>(import.whole("geom_contype", geom)),
             affinity = static_cast<unsigned>(import.whole("geom_conaffinity", geom));
  if (type == 0 && affinity == 0) return import.model.left_out.add(where, "a geom", no_motion("is only drawn"));
  const int body = import.whole("geom_bodyid", geom);
  const BodyPose pose =
      import.pose_of(body) * BodyPose{import.vector("geom_pos", geom), import.turn("geom_quat", geom)};
  const auto shape = shape_of(import, geom, pose);
  if (!shape) return;
  LinkShape out{*shape, pose, {0, import.value("geom_friction", 3 * geom)}, type, affinity, where};
  const int condim = import.whole("geom_condim", geom);
  out.slips = condim == 1, out.priority = import.whole("geom_priority", geom);
  if (condim > 3) import.lose("geom", geom, "torsional friction", "acts against spinning and rolling: no scene has it");
  if (import.value("geom_margin", geom) - import.value("geom_gap", geom) > 0)
    import.lose("geom", geom, "a margin", "makes contacts act at a distance");
  if (body > 0) {
    import.model.links[MjcfImport::link_of(body)].shapes.push_back(out);
    return;
  }
  const std::string name = import.m.name_of("geom", static_cast<std::size_t>(geom));
  Link link{name.empty() ? fmt::format("geom{}", geom) : name, where, {}};
  link.shapes.push_back(out), link.is_static = true, link.touches_own_model = true;
  import.model.links.push_back(std::move(link));
}

}  // namespace

void read_mjcf_geoms(MjcfImport& import) {
  for (int geom = 0; geom < import.count("geom_type"); ++geom) read_geom(import, geom);
}

}  // namespace rigor
