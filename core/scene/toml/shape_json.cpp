#include "core/scene/toml/shape_json.h"

namespace rigor {
namespace {

Json list_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json value_of(double value) { return value; }
Json value_of(const Vec3& value) { return list_of(value); }

}  // namespace

Json json_of_shape(const Shape& shape) {
  if (const auto* compound = std::get_if<Compound>(&shape)) {
    Json parts = Json::array();
    for (const PlacedShape& part : compound->parts) {
      const Quat& q = part.pose.orientation;
      Json row = json_of_shape(part.shape);
      row["position"] = list_of(part.pose.position);
      row["orientation_wxyz"] = {q.w(), q.x(), q.y(), q.z()};
      parts.push_back(std::move(row));
    }
    return parts;
  }
  Json json = {{"type", shape_name(shape)}};
  for_each_field(shape, [&](const char* key, ShapeQuantity, const auto& value) { json[key] = value_of(value); });
  if (const auto* convex = std::get_if<Convex>(&shape)) {
    json["points"] = Json::array();
    for (const Vec3& point : convex->hull->points) json["points"].push_back(list_of(point));
  }
  return json;
}

}  // namespace rigor
