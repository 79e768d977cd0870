#include "cases/report/json/scene_json.h"
#include "core/base/json.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor {
namespace {

Json list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// The shape as the page draws it: a compound as its parts, and a hull, mesh or height field with its triangles.
Json drawn_shape_json(const Shape& shape) {
  if (const auto* compound = std::get_if<Compound>(&shape)) {
    Json json = {{"type", "compound"}, {"parts", parse_json(shape_json(shape))}};
    for (std::size_t k = 0; k < compound->parts.size(); ++k)
      json["parts"][k].update(drawn_shape_json(compound->parts[k].shape));
    return json;
  }
  Json json = parse_json(shape_json(shape));
  if (const auto* convex = std::get_if<Convex>(&shape)) {
    json["triangles"] = Json::array();
    for (const Hull::Face& face : convex->hull->faces) {
      for (std::size_t k = 1; k + 1 < face.corners.size(); ++k)
        json["triangles"].push_back({face.corners[0], face.corners[k], face.corners[k + 1]});
    }
  }
  if (const SurfaceShape* on = surface_in(shape)) {
    json.erase("heights"), json["points"] = Json::array(), json["triangles"] = Json::array();
    for (const Vec3& point : on->surface->points) json["points"].push_back(list(point));
    for (const TriangleSurface::Triangle& triangle : on->surface->triangles)
      json["triangles"].push_back(triangle.corners);
  }
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

}  // namespace rigor
