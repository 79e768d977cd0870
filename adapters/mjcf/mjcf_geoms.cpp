#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "adapters/mjcf/mjcf_import.h"
#include "core/base/error.h"

namespace rigor::inline adapters {
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

// The heights of a file are shares of its relief.
std::vector<std::vector<double>> heights_of(const MjcfImport& import, int field) {
  const int first = import.whole("hfield_adr", field), columns = import.whole("hfield_ncol", field);
  std::vector<std::vector<double>> heights(static_cast<std::size_t>(import.whole("hfield_nrow", field)));
  int next = first;
  for (std::vector<double>& along : heights) {
    for (int column = 0; column < columns; ++column)
      along.push_back(import.value("hfield_size", 4 * field + 2) * import.value("hfield_data", next++));
  }
  return heights;
}

// Level ground has the same surface with its four corners alone.
std::optional<Shape> field_of_geom(MjcfImport& import, int geom) {
  const int field = import.whole("geom_dataid", geom);
  Heightfield out;
  out.size = {2 * import.value("hfield_size", 4 * field), 2 * import.value("hfield_size", 4 * field + 1)};
  out.heights = heights_of(import, field);
  const double level = out.heights.front().front();
  const bool is_level = std::all_of(out.heights.begin(), out.heights.end(), [=](const std::vector<double>& row) {
    return std::all_of(row.begin(), row.end(), [=](double height) { return height == level; });
  });
  const bool has_cells = out.heights.size() > 1 && out.heights.front().size() > 1;
  if (is_level && has_cells) out.heights.assign(2, {level, level});
  try {
    out.surface = height_surface(out.size, out.heights);
    return out;
  } catch (const InputError& error) {
    import.lose("geom", geom, "a height field", error.what());
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
    case kHeightField:
      return field_of_geom(import, geom);
    default:
      import.lose("geom", geom, "a distance field", "no scene has it: nothing touches it");
      return {};
  }
}

// Makes a shape larger on all sides. Returns false for a shape that another one of its kind would not equal.
struct Grown {
  double by;  // m
  bool operator()(Sphere& sphere) const { return sphere.radius += by, true; }
  bool operator()(Capsule& capsule) const { return capsule.radius += by, true; }
  bool operator()(Cylinder& cylinder) const { return cylinder.radius += by, cylinder.length += 2 * by, true; }
  bool operator()(Box& box) const { return box.size.array() += 2 * by, true; }
  bool operator()(Plane& plane) const { return plane.offset += by, true; }
  template <typename Curved>
  bool operator()(Curved&) const {
    return false;
  }
};

bool has_edges(const Shape& shape) {
  return std::holds_alternative<Cylinder>(shape) || std::holds_alternative<Box>(shape);
}

double margin_of(const MjcfImport& import, int geom) {
  return import.value("geom_margin", geom) - import.value("geom_gap", geom);
}

bool collides(const MjcfImport& import, int geom) {
  return import.whole("geom_contype", geom) != 0 || import.whole("geom_conaffinity", geom) != 0;
}

// Whether all geoms that collide have one margin.
bool has_one_margin(const MjcfImport& import) {
  std::set<double> margins;
  for (int geom = 0; geom < import.count("geom_type"); ++geom)
    if (collides(import, geom)) margins.insert(margin_of(import, geom));
  return margins.size() <= 1;
}

// Contacts of a pair act where its gap is below its margin, as if the margin were the surface. Two round or flat shapes
// that are larger by their shares touch at the same points.
void grow_by_margin(MjcfImport& import, int geom, bool all_alike, LinkShape& shape) {
  const double own = margin_of(import, geom);
  const bool is_own_share = all_alike || import.m.adds_margins;
  if (own <= 0 && is_own_share) return;
  if (!is_own_share) {
    const std::string why = fmt::format("{} takes the larger of two, and those of this model differ", import.m.parser);
    return import.lose("geom", geom, "a margin", why);
  }
  const double share = import.m.adds_margins ? own : own / 2;
  if (!std::visit(Grown{share}, shape.shape))
    return import.lose("geom", geom, "a margin", "makes contacts of a curved or pointed shape act at a distance");
  const char* edges = has_edges(shape.shape) ? "; its edges stay sharp, where the margin would round them" : "";
  import.model.left_out.add(
      shape.where, "a margin",
      assumed(fmt::format("the shape is larger by {:g} m, as {} reads the file{}", share, import.m.parser, edges)));
}

void read_geom(MjcfImport& import, int geom, bool all_alike) {
  const std::string where = import.at("geom", geom);
  const auto type = static_cast<unsigned>(import.whole("geom_contype", geom)),
             affinity = static_cast<unsigned>(import.whole("geom_conaffinity", geom));
  if (!collides(import, geom)) return import.model.left_out.add(where, "a geom", no_motion("is only drawn"));
  const int body = import.whole("geom_bodyid", geom);
  const BodyPose pose =
      import.pose_of(body) * BodyPose{import.vector("geom_pos", geom), import.turn("geom_quat", geom)};
  const auto shape = shape_of(import, geom, pose);
  if (!shape) return;
  const auto friction = [&](int k) { return import.value("geom_friction", 3 * geom + k); };
  LinkShape out{*shape, pose, {.friction = friction(0)}, type, affinity, where};
  out.surface.torsional_friction = friction(1), out.surface.rolling_friction = friction(2);
  out.dimensions = import.whole("geom_condim", geom), out.priority = import.whole("geom_priority", geom);
  grow_by_margin(import, geom, all_alike, out);
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
  const bool all_alike = has_one_margin(import);
  for (int geom = 0; geom < import.count("geom_type"); ++geom) read_geom(import, geom, all_alike);
}

}  // namespace rigor::inline adapters
