#include "cases/report/json/scene_json.h"

#include <array>
#include <map>

#include "core/base/json.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor::inline report {
namespace {

Json list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// Triangles share their points: a mesh repeats them for each normal.
Json triangles_json(const TriangleMesh& mesh) {
  Json json = {{"points", Json::array()}, {"triangles", Json::array()}};
  std::map<std::array<double, 3>, std::size_t> index;
  const auto index_of = [&](int corner) {
    const Vec3& at = mesh.points[static_cast<std::size_t>(corner)];
    const auto [place, is_new] = index.try_emplace({at.x(), at.y(), at.z()}, index.size());
    if (is_new) json["points"].push_back(list(at));
    return place->second;
  };
  for (std::size_t k = 0; k < mesh.corners.size(); k += 3)
    json["triangles"].push_back(
        {index_of(mesh.corners[k]), index_of(mesh.corners[k + 1]), index_of(mesh.corners[k + 2])});
  return json;
}

// Whether the page draws it from its lengths.
bool is_drawn_by_lengths(const Shape& shape) {
  return std::visit(
      []<typename Type>(const Type&) {
        return std::is_same_v<Type, Box> || std::is_same_v<Type, Capsule> || std::is_same_v<Type, Cylinder> ||
               std::is_same_v<Type, Ellipsoid> || std::is_same_v<Type, Plane> || std::is_same_v<Type, Sphere>;
      },
      shape);
}

// The shape as the page draws it: a compound as its parts, any other from its lengths or with triangles.
Json drawn_shape_json(const Shape& shape) {
  if (const auto* compound = std::get_if<Compound>(&shape)) {
    Json json = {{"type", "compound"}, {"parts", parse_json(shape_json(shape))}};
    for (std::size_t k = 0; k < compound->parts.size(); ++k)
      json["parts"][k].update(drawn_shape_json(compound->parts[k].shape));
    return json;
  }
  Json json = parse_json(shape_json(shape));
  if (is_drawn_by_lengths(shape)) return json;
  json.erase("heights"), json.update(triangles_json(drawn_mesh(shape)));
  return json;
}

// The row of a case file, with a pose for a plane too and with the shape as the page draws it.
Json drawn_body_json(const Body& body, Json row) {
  const Quat& q = body.orientation;
  row["position"] = list(body.position);
  row["orientation_wxyz"] = {q.w(), q.x(), q.y(), q.z()};
  row["shape"] = body.shape ? drawn_shape_json(*body.shape) : Json(nullptr);
  for (const char* key : {"shapes", "velocity", "angular_velocity"}) row.erase(key);
  return row;
}

}  // namespace

Json json_of(const Scene& scene) {
  const Json written = parse_json(scene_json(scene));
  const auto rows = [&](const char* key) { return written.value(key, Json::array()); };
  Json json = {{"gravity", written.at("gravity")}, {"bodies", Json::array()},
               {"springs", rows("spring")},        {"joints", rows("joint")},
               {"forces", rows("force")},          {"contact_default", written.at("contact_default")},
               {"contacts", rows("contact")}};
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    json["bodies"].push_back(drawn_body_json(scene.bodies[i], written.at("body")[i]));
  for (Json& force : json["forces"]) force.emplace("until", nullptr);  // null: to the end
  return json;
}

}  // namespace rigor::inline report
