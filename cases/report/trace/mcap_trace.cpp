// A run for Foxglove: each body is a frame, moved by FrameTransforms; SceneUpdate sends its shape once
// (docs.foxglove.dev/docs/visualization/message-schemas). Quaternions have named components x, y, z, w there. With
// contacts, the topic /contacts has an arrow at each contact point, along the force on the second body, and
// /contact_forces the numbers.
#include <cmath>

#include "cases/report/trace/mcap_file.h"
#include "cases/report/trace/trace_formats.h"
#include "core/base/json.h"
#include "core/base/rotation_between.h"

namespace rigor::inline report {
namespace {

constexpr const char* kRoot = "world";

Json xyz(const Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }
Json xyzw(const Quat& q) { return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}; }
Json pose_json(const BodyPose& pose) {
  return {{"position", xyz(pose.position)}, {"orientation", xyzw(pose.orientation)}};
}

std::uint64_t nanoseconds_of(double seconds) { return static_cast<std::uint64_t>(std::llround(seconds * 1e9)); }
Json stamp(std::uint64_t nanoseconds) {
  return {{"sec", nanoseconds / 1000000000}, {"nsec", nanoseconds % 1000000000}};
}

Json object_of(const Json& properties) { return {{"type", "object"}, {"properties", properties}}; }
Json list_of(const Json& items) { return {{"type", "array"}, {"items", items}}; }

// The parts of Foxglove's schemas that are written.
struct Schemas {
  Json number = {{"type", "number"}}, text = {{"type", "string"}}, flag = {{"type", "boolean"}};
  Json time = object_of({{"sec", {{"type", "integer"}}}, {"nsec", {{"type", "integer"}}}});
  Json vector = object_of({{"x", number}, {"y", number}, {"z", number}});
  Json quaternion = object_of({{"x", number}, {"y", number}, {"z", number}, {"w", number}});
  Json pose = object_of({{"position", vector}, {"orientation", quaternion}});
  Json colour = object_of({{"r", number}, {"g", number}, {"b", number}, {"a", number}});

  Json transforms() const {
    Json schema = object_of({{"transforms", list_of(object_of({{"timestamp", time},
                                                               {"parent_frame_id", text},
                                                               {"child_frame_id", text},
                                                               {"translation", vector},
                                                               {"rotation", quaternion}}))}});
    schema["title"] = "foxglove.FrameTransforms";
    return schema;
  }
  Json scene() const {
    const Json solid = object_of({{"pose", pose}, {"size", vector}, {"color", colour}});
    const Json cylinder = object_of(
        {{"pose", pose}, {"size", vector}, {"bottom_scale", number}, {"top_scale", number}, {"color", colour}});
    const Json nothing = list_of(object_of(Json::object()));
    const Json arrow = object_of({{"pose", pose},
                                  {"shaft_length", number},
                                  {"shaft_diameter", number},
                                  {"head_length", number},
                                  {"head_diameter", number},
                                  {"color", colour}});
    Json entity = object_of({{"timestamp", time},
                             {"frame_id", text},
                             {"id", text},
                             {"lifetime", time},
                             {"frame_locked", flag},
                             {"metadata", nothing},
                             {"arrows", list_of(arrow)},
                             {"cubes", list_of(solid)},
                             {"spheres", list_of(solid)},
                             {"cylinders", list_of(cylinder)},
                             {"lines", nothing},
                             {"triangles", nothing},
                             {"texts", nothing},
                             {"models", nothing}});
    Json schema = object_of({{"deletions", nothing}, {"entities", list_of(entity)}});
    schema["title"] = "foxglove.SceneUpdate";
    return schema;
  }
  Json contact_forces() const {
    const Json contact = object_of(
        {{"a", text}, {"b", text}, {"point", vector}, {"normal", vector}, {"gap", number}, {"force", vector}});
    Json schema = object_of({{"contacts", list_of(contact)}});
    schema["title"] = "rigor.ContactForces";
    return schema;
  }
};

// Without shapes; each message replaces the last one of its id. Lifetime 0 means until then.
Json entity_without_shapes(const std::string& frame, const std::string& id, std::uint64_t time) {
  Json entity = {
      {"timestamp", stamp(time)}, {"frame_id", frame}, {"id", id}, {"lifetime", stamp(0)}, {"frame_locked", true}};
  for (const char* kind :
       {"metadata", "arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models"})
    entity[kind] = Json::array();
  return entity;
}

// An arrow points along the x of its pose.
Json arrow_of(const ReportedContact& contact, double metres_per_newton) {
  constexpr double kHead = 0.25, kWidth = 0.08;  // of the arrow's length
  const double length = contact.force.norm() * metres_per_newton;
  const BodyPose pose{contact.point, rotation_between(Vec3::UnitX(), contact.force.normalized())};
  return {{"pose", pose_json(pose)},
          {"shaft_length", (1 - kHead) * length},
          {"shaft_diameter", kWidth * length},
          {"head_length", kHead * length},
          {"head_diameter", 2 * kWidth * length},
          {"color", {{"r", 0.85}, {"g", 0.2}, {"b", 0.15}, {"a", 1}}}};
}

class Entity {
 public:
  explicit Entity(const Body& body) {
    json_ = entity_without_shapes(body.name, body.name, 0);
    colour_ = body.fixed ? Json{{"r", 0.6}, {"g", 0.6}, {"b", 0.6}, {"a", 0.5}}
                         : Json{{"r", 0.25}, {"g", 0.5}, {"b", 0.85}, {"a", 1}};
    std::visit([this](const auto& shape) { (*this)(shape); }, drawn_shape(body));
  }
  void operator()(const Sphere& sphere) { add("spheres", at_, Vec3::Constant(2 * sphere.radius)); }
  void operator()(const Box& box) { add("cubes", at_, box.size); }
  void operator()(const Capsule& capsule) {
    (*this)(Cylinder{capsule.radius, capsule.length});
    for (const double side : {-0.5, 0.5})
      add("spheres", at_ * BodyPose{side * capsule.length * Vec3::UnitZ()}, Vec3::Constant(2 * capsule.radius));
  }
  void operator()(const Compound& compound) {
    for (const PlacedShape& part : compound.parts) {
      at_ = part.pose;
      std::visit([this](const auto& shape) { (*this)(shape); }, part.shape);
    }
    at_ = {};
  }
  template <typename Other>
  void operator()(const Other& other) {
    const TriangleMesh mesh = other.drawn();
    Json points = Json::array();
    for (const Vec3& point : mesh.points) points.push_back(xyz(point));
    json_["triangles"].push_back({{"pose", pose_json(at_)},
                                  {"points", points},
                                  {"color", colour_},
                                  {"colors", Json::array()},
                                  {"indices", mesh.corners}});
  }
  void operator()(const Cylinder& cylinder) {
    add("cylinders", at_, {2 * cylinder.radius, 2 * cylinder.radius, cylinder.length});
    json_["cylinders"].back()["bottom_scale"] = json_["cylinders"].back()["top_scale"] = 1;
  }
  void operator()(const Ellipsoid& ellipsoid) { add("spheres", at_, 2 * ellipsoid.radii); }
  // The frame of a plane's body is W itself.
  void operator()(const Plane& plane) {
    constexpr double kThin = 0.01;  // m
    BodyPose pose = pose_of_plane(plane);
    pose.position -= kThin / 2 * plane.normal;
    add("cubes", pose, {2 * kDrawnPlane, 2 * kDrawnPlane, kThin});
  }
  const Json& json() const { return json_; }

 private:
  void add(const char* kind, const BodyPose& pose, const Vec3& size) {
    json_[kind].push_back({{"pose", pose_json(pose)}, {"size", xyz(size)}, {"color", colour_}});
  }
  Json json_, colour_;
  BodyPose at_;  // of the shape in B
};

class McapTrace : public TraceWriter {
 public:
  McapTrace(const Scene& scene, bool has_contacts)
      : scene_(scene), has_contacts_(has_contacts), metres_per_newton_(drawn_metres_per_newton(scene)) {
    const Schemas schemas;
    shapes_ = file_.add_channel("/scene", "foxglove.SceneUpdate", schemas.scene().dump());
    frames_ = file_.add_channel("/tf", "foxglove.FrameTransforms", schemas.transforms().dump());
    if (!has_contacts) return;
    arrows_ = file_.add_channel("/contacts", "foxglove.SceneUpdate", schemas.scene().dump());
    forces_ = file_.add_channel("/contact_forces", "rigor.ContactForces", schemas.contact_forces().dump());
  }

  std::string begin(std::size_t) override {
    Json entities = Json::array();
    for (const Body& body : scene_.bodies) entities.push_back(Entity(body).json());
    const std::string start = file_.begin();
    return start + file_.add(shapes_, 0, Json{{"deletions", Json::array()}, {"entities", entities}}.dump());
  }

  std::string add(const Sample& sample) override {
    const std::uint64_t time = nanoseconds_of(sample.time);
    Json transforms = Json::array();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const BodyColumns bodies = sample.bodies.columns();
      transforms.push_back({{"timestamp", stamp(time)},
                            {"parent_frame_id", kRoot},
                            {"child_frame_id", scene_.bodies[i].name},
                            {"translation", xyz(bodies.position(i))},
                            {"rotation", xyzw(bodies.orientation(i))}});
    }
    const std::string frames = file_.add(frames_, time, Json{{"transforms", transforms}}.dump());
    return has_contacts_ ? frames + add_contacts(sample, time) : frames;
  }

  std::string end() override { return file_.end(); }

 private:
  std::string add_contacts(const Sample& sample, std::uint64_t time) {
    Json entity = entity_without_shapes(kRoot, "contacts", time), contacts = Json::array();
    for (const ReportedContact& contact : sample.contacts) {
      contacts.push_back({{"a", scene_.body_name(contact.a)},
                          {"b", scene_.body_name(contact.b)},
                          {"point", xyz(contact.point)},
                          {"normal", xyz(contact.normal)},
                          {"gap", contact.gap},
                          {"force", xyz(contact.force)}});
      if (!contact.force.isZero(0)) entity["arrows"].push_back(arrow_of(contact, metres_per_newton_));
    }
    const Json update = {{"deletions", Json::array()}, {"entities", Json::array({entity})}};
    const std::string arrows = file_.add(arrows_, time, update.dump());
    return arrows + file_.add(forces_, time, Json{{"contacts", contacts}}.dump());
  }

  const Scene& scene_;
  bool has_contacts_;
  double metres_per_newton_;
  McapFile file_;
  std::uint16_t shapes_ = 0, frames_ = 0, arrows_ = 0, forces_ = 0;
};

}  // namespace

std::unique_ptr<TraceWriter> mcap_trace(const Scene& scene, bool has_contacts) {
  return std::make_unique<McapTrace>(scene, has_contacts);
}

}  // namespace rigor::inline report
