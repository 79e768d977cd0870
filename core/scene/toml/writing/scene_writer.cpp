#include "core/scene/toml/writing/scene_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/json.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline scene {
namespace {

Json list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

void add_unless_infinite(Json& row, const char* key, double value) {
  if (std::isfinite(value)) row[key] = value;
}

Json value_of(double value) { return value; }
Json value_of(const Vec3& value) { return list(value); }

// The parts of a compound are a list.
Json json_of_shape(const Shape& shape) {
  if (const auto* compound = std::get_if<Compound>(&shape)) {
    Json parts = Json::array();
    for (const PlacedShape& part : compound->parts) {
      const Quat& q = part.pose.orientation;
      Json row = json_of_shape(part.shape);
      row["position"] = list(part.pose.position);
      row["orientation_wxyz"] = {q.w(), q.x(), q.y(), q.z()};
      parts.push_back(std::move(row));
    }
    return parts;
  }
  Json json = {{"type", shape_name(shape)}};
  for_each_field(shape, [&](const char* key, ShapeQuantity, const auto& value) { json[key] = value_of(value); });
  if (const auto* convex = std::get_if<Convex>(&shape)) {
    json["points"] = Json::array();
    for (const Vec3& point : convex->hull->points) json["points"].push_back(list(point));
  }
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    for (const Vec3& point : mesh->surface->points) json["points"].push_back(list(point));
    for (const TriangleSurface::Triangle& triangle : mesh->surface->triangles)
      json["triangles"].push_back(triangle.corners);
  }
  if (const auto* field = std::get_if<Heightfield>(&shape))
    json["size"] = field->size, json["heights"] = field->heights;
  return json;
}

Json row_of(const Body& body) {
  const Mat3& m = body.inertia;
  Json row = {
      {"name", body.name}, {"mass", body.mass}, {"inertia", {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)}}};
  if (!body.shape || !std::holds_alternative<Plane>(*body.shape)) {  // a plane lies where its normal and offset say
    const Quat& q = body.orientation;
    row["position"] = list(body.position);
    row["orientation_wxyz"] = {q.w(), q.x(), q.y(), q.z()};
  }
  row["velocity"] = list(body.velocity), row["angular_velocity"] = list(body.angular_velocity);
  if (body.shape) row[std::holds_alternative<Compound>(*body.shape) ? "shapes" : "shape"] = json_of_shape(*body.shape);
  row["collides"] = body.collides, row["fixed"] = body.fixed;
  return row;
}

Json row_of(const Spring& spring, const Scene& scene) {
  Json row = {{"a", scene.body_name(spring.a)},   {"point_a", list(spring.point_a)}, {"b", scene.body_name(spring.b)},
              {"point_b", list(spring.point_b)},  {"stiffness", spring.stiffness},   {"damping", spring.damping},
              {"rest_length", spring.rest_length}};
  if (spring.quadratic_stiffness > 0) row["quadratic_stiffness"] = spring.quadratic_stiffness;
  return row;
}

// What acts on the free coordinate of a joint.
void add_coordinate(const Joint& joint, const Scene& scene, Json& row) {
  row["stiffness"] = joint.stiffness, row["damping"] = joint.damping;
  for (const Motor& motor : scene.motors) {
    if (motor.is_friction && &scene.joints[static_cast<std::size_t>(motor.joint)] == &joint)
      row["friction"] = motor.most;
  }
  if (joint.armature > 0) row["armature"] = joint.armature;
  if (joint.stiffness > 0) row["rest"] = joint.rest;
  if (joint.quadratic_stiffness > 0) row["quadratic_stiffness"] = joint.quadratic_stiffness;
  add_unless_infinite(row, "lower", joint.lower);
  add_unless_infinite(row, "upper", joint.upper);
  if (joint.has_limits()) row["restitution"] = joint.restitution;
}

// The axes stand in the scene's joints behind the compound joint.
Json rows_of_axes(const CompoundJoint& compound, const Joint* first, const Scene& scene) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < compound.axes.size(); ++i) {
    Json row = {{"type", compound.axes[i].turns ? "hinge" : "slider"}};
    if (!first[i].name.empty()) row["name"] = first[i].name;
    visit_series_axis(compound.axes[i],
                      [&](const char* key, JointVector, const Vec3& vector) { row[key] = list(vector); });
    add_coordinate(first[i], scene, row);
    rows.push_back(std::move(row));
  }
  return rows;
}

Json row_of(const Joint& joint, const Scene& scene) {
  Json row = {{"type", joint_type_name(joint)}};
  if (!joint.name.empty()) row["name"] = joint.name;
  row["a"] = scene.body_name(joint.a), row["b"] = scene.body_name(joint.b);
  if (const auto* compound = std::get_if<CompoundJoint>(&joint.type)) {
    row["axes"] = rows_of_axes(*compound, &joint + 1, scene);
    return row;
  }
  for_each_vector(joint.type, [&](const char* key, JointVector, const Vec3& vector) { row[key] = list(vector); });
  for_each_number(joint.type, [&](const char* key, double number) { row[key] = number; });
  if (free_axis(joint)) add_coordinate(joint, scene, row);
  return row;
}

// One term as it is, several as lists.
void add_terms(const char* key, const std::vector<JointTerm>& terms, const Scene& scene, Json& row) {
  const auto name_of = [&](const JointTerm& term) { return scene.joints[static_cast<std::size_t>(term.joint)].name; };
  if (terms.size() == 1) {
    row[key] = name_of(terms.front()), row["ratio"] = terms.front().ratio;
    return;
  }
  for (const JointTerm& term : terms) row[key].push_back(name_of(term)), row["ratio"].push_back(term.ratio);
}

Json row_of(const Coupling& coupling, const Scene& scene) {
  Json row = {{"joint", scene.joints[static_cast<std::size_t>(coupling.joint)].name}};
  add_terms("to", coupling.to, scene, row);
  if (coupling.offset != 0) row["offset"] = coupling.offset;
  return row;
}

void add_times(Json& row, double from, double until) {
  row["from"] = from;
  add_unless_infinite(row, "until", until);
}

// A number, or rows [t, value].
void add_table(const char* key, const TimeTable& table, Json& row) {
  if (table.is_constant()) {
    row[key] = table.values.front();
    return;
  }
  for (std::size_t i = 0; i < table.times.size(); ++i) row[key].push_back({table.times[i], table.values[i]});
  row["interpolate"] = table.is_linear ? "linear" : "previous";
}

void add_servo(const Servo& servo, Json& row) {
  row["kp"] = servo.kp, row["kd"] = servo.kd;
  if (servo.kp > 0) add_table("target", servo.target, row);
  if (servo.kd > 0) row["target_speed"] = servo.target_speed;
  add_unless_infinite(row, "most", servo.most);
  if (servo.period > 0) row["period"] = servo.period;
}

Json row_of(const Motor& motor, const Scene& scene) {
  const Joint& joint = scene.joints[static_cast<std::size_t>(motor.joint)];
  Json row = {{"joint", joint.name}};
  if (motor.speed) {
    row["speed"] = *motor.speed, row["most"] = motor.most;
  } else if (motor.servo) {
    add_servo(*motor.servo, row);
    if (!motor.plus.empty()) add_terms("plus", motor.plus, scene, row);
  } else {
    add_table(turns(joint) ? "torque" : "force", motor.efforts ? *motor.efforts : TimeTable::constant(motor.effort),
              row);
  }
  add_times(row, motor.from, motor.until);
  return row;
}

Json row_of(const ContactLaw& law) {
  Json row = {{"restitution", law.restitution},
              {"friction", std::isfinite(law.friction) ? Json(law.friction) : Json("infinite")}};
  // Absent: 0. Engines from outside that know none of these keep the scenes that they had.
  for (const auto& [key, value] :
       {std::pair("static_friction", law.sticks_better() ? law.static_friction : 0),
        std::pair("rolling_friction", law.rolling_friction), std::pair("torsional_friction", law.torsional_friction),
        std::pair("stiffness", law.stiffness), std::pair("damping", law.damping),
        std::pair("dissipation", law.dissipation)}) {
    if (value > 0) row[key] = value;
  }
  return row;
}

Json row_of(const ContactPair& pair, const Scene& scene) {
  Json row = {{"a", scene.body_name(pair.a)}, {"b", scene.body_name(pair.b)}};
  if (pair.law.collides) {
    row.update(row_of(pair.law));
  } else {
    row["collides"] = false;
  }
  return row;
}

Json row_of(const TimedForce& force, const Scene& scene) {
  Json row = {{"body", scene.body_name(force.body)},
              {"force", list(force.force)},
              {"torque", list(force.torque)},
              {"point", list(force.point)}};
  add_times(row, force.from, force.until);
  return row;
}

template <typename Rows>
void add_rows(Json& tree, const char* key, const Rows& rows, const Scene& scene) {
  for (const auto& row : rows) tree[key].push_back(row_of(row, scene));
}

Json tree_of(const Scene& scene) {
  Json tree = {{"gravity", list(scene.gravity)}, {"contact_default", row_of(scene.contact_default)}};
  for (const Body& body : scene.bodies) tree["body"].push_back(row_of(body));
  add_rows(tree, "spring", scene.springs, scene);
  for (const Joint& joint : scene.joints)
    if (!is_axis_of_compound(joint)) tree["joint"].push_back(row_of(joint, scene));
  add_rows(tree, "coupling", scene.couplings, scene);
  for (const Motor& motor : scene.motors) {
    if (!motor.is_friction) tree["motor"].push_back(row_of(motor, scene));  // friction is its joint's
  }
  add_rows(tree, "contact", scene.contact_pairs, scene);
  add_rows(tree, "force", scene.forces, scene);
  return tree;
}

// Bodies that share a joint, in ascending order, where they could meet.
std::set<std::pair<int, int>> joined_pairs(const Scene& scene) {
  std::set<std::pair<int, int>> joined;
  for (const Joint& joint : scene.joints) {
    const bool are_bodies = joint.a != kWorld && joint.b != kWorld;
    if (are_bodies && can_meet(scene.bodies[joint.a], scene.bodies[joint.b]))
      joined.insert(std::minmax({joint.a, joint.b}));
  }
  return joined;
}

// Writes `self_contact = false` in place of the rows that it stands for. Only if every joined pair has such a row.
void shorten_contacts(Json& tree, const Scene& scene) {
  const auto joined = joined_pairs(scene);
  const auto stands = [&](const ContactPair& pair) {
    return !pair.law.collides && joined.contains(std::minmax({pair.a, pair.b}));
  };
  const auto& pairs = scene.contact_pairs;
  const auto count = static_cast<std::size_t>(std::count_if(pairs.begin(), pairs.end(), stands));
  if (joined.empty() || count < joined.size()) return;
  tree.erase("contact");
  for (const ContactPair& pair : pairs) {
    if (!stands(pair)) tree["contact"].push_back(row_of(pair, scene));
  }
  tree["self_contact"] = false;
}

// Numbers, texts, flags and lists of these are TOML as they stand; only objects are not.
std::string toml_of(const Json& value) {
  std::string text;
  if (value.is_array() && !value.empty() && value.front().is_object()) {
    for (const Json& part : value) text += (text.empty() ? "" : ", ") + toml_of(part);
    return "[" + text + "]";
  }
  if (!value.is_object()) return value.dump();
  for (const auto& [key, part] : value.items())
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, toml_of(part));
  return "{ " + text + " }";
}

}  // namespace

std::string shape_json(const Shape& shape) { return json_of_shape(shape).dump(); }

std::string scene_json(const Scene& scene) { return tree_of(scene).dump(); }

std::string scene_toml(const Scene& scene) {
  std::string values = "[scene]\n", tables;
  Json tree = tree_of(scene);
  shorten_contacts(tree, scene);
  for (const auto& [key, value] : tree.items()) {
    const bool is_table = value.is_array() && value.front().is_object();
    if (!is_table) values += fmt::format("{} = {}\n", key, toml_of(value));
    for (std::size_t n = 0; is_table && n < value.size(); ++n) {
      tables += fmt::format("\n[[scene.{}]]\n", key);
      for (const auto& [name, part] : value[n].items()) tables += fmt::format("{} = {}\n", name, toml_of(part));
    }
  }
  return values + tables;
}

}  // namespace rigor::inline scene
