#include "cases/report/json/scene_json.h"
#include "core/base/json.h"
#include "core/scene/toml/writing/scene_writer.h"

#include <cmath>

namespace rigor {
namespace {

Json list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// As the page draws it: a compound as its parts, and a hull with the triangles of its surface.
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
  return json;
}

Json json_of_body(const Body& body) {
  const Quat& q = body.orientation;
  const Mat3& m = body.inertia;
  return {{"name", body.name},
          {"mass", body.mass},
          {"inertia", {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)}},
          {"position", list(body.position)},
          {"orientation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"shape", body.shape ? drawn_shape_json(*body.shape) : Json(nullptr)},
          {"collides", body.collides},
          {"fixed", body.fixed}};
}

Json json_of_joint(const Joint& joint, const Scene& scene) {
  Json json = {{"a", scene.body_name(joint.a)}, {"b", scene.body_name(joint.b)}, {"type", joint_type_name(joint)}};
  for_each_vector(joint.type, [&](const char* key, JointVector, const Vec3& vector) { json[key] = list(vector); });
  return json;
}

}  // namespace

Json json_of(const Scene& scene) {
  Json json = {{"gravity", list(scene.gravity)},
               {"bodies", Json::array()},
               {"springs", Json::array()},
               {"joints", Json::array()},
               {"forces", Json::array()}};
  for (const Body& body : scene.bodies) json["bodies"].push_back(json_of_body(body));
  for (const Spring& spring : scene.springs) {
    json["springs"].push_back({{"a", scene.body_name(spring.a)},
                               {"point_a", list(spring.point_a)},
                               {"b", scene.body_name(spring.b)},
                               {"point_b", list(spring.point_b)},
                               {"stiffness", spring.stiffness},
                               {"damping", spring.damping},
                               {"rest_length", spring.rest_length}});
  }
  for (const Joint& joint : scene.joints) json["joints"].push_back(json_of_joint(joint, scene));
  for (const TimedForce& force : scene.forces) {
    json["forces"].push_back(
        {{"body", scene.body_name(force.body)},
         {"force", list(force.force)},
         {"torque", list(force.torque)},
         {"point", list(force.point)},
         {"from", force.from},
         {"until", std::isfinite(force.until) ? Json(force.until) : Json(nullptr)}});  // null: to the end
  }
  return json;
}

}  // namespace rigor
