#include "core/scene/toml/joint_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/near_match.h"
#include "core/scene/joint_rates.h"

namespace rigor {
namespace {

using JointType = decltype(Joint::type);

struct JointRow {
  std::string name;
  Keys keys;  // beside those of every joint
  JointType (*read)(const TableReader& row, const Ends& ends);
};

const Keys kOfEvery = {"type", "name", "a", "b"};
const Keys kOfCoordinate = {"stiffness", "damping", "rest", "lower", "upper", "restitution"};

Vec3 anchor_of(const TableReader& row, const Ends& ends) { return row.at("anchor").vector() + ends.offset; }

JointType read_distance(const TableReader& row, const Ends& ends) {
  const auto point = [&](const char* key, int body) -> Vec3 {
    return row.at(key).vector() + (body == kWorld ? ends.offset : Vec3::Zero());
  };
  return DistanceJoint{point("point_a", ends.a), point("point_b", ends.b)};
}

JointType read_universal(const TableReader& row, const Ends& ends) {
  return UniversalJoint{anchor_of(row, ends), row.at("axis").direction(), row.at("axis2").direction()};
}

const std::vector<JointRow>& joint_rows() {
  static const std::vector<JointRow> rows = {
      {"ball",
       {"anchor"},
       [](const TableReader& row, const Ends& ends) -> JointType { return BallJoint{anchor_of(row, ends)}; }},
      {"distance", {"point_a", "point_b"}, read_distance},
      {"fixed", {}, [](const TableReader&, const Ends&) -> JointType { return FixedJoint{}; }},
      {"hinge",
       {"anchor", "axis"},
       [](const TableReader& row, const Ends& ends) -> JointType {
         return HingeJoint{anchor_of(row, ends), row.at("axis").direction()};
       }},
      {"slider",
       {"axis"},
       [](const TableReader& row, const Ends&) -> JointType { return SliderJoint{row.at("axis").direction()}; }},
      {"universal", {"anchor", "axis", "axis2"}, read_universal},
  };
  return rows;
}

void read_limits(const TableReader& row, Joint& joint) {
  if (const auto lower = row.find("lower")) joint.lower = lower->number();
  if (const auto upper = row.find("upper")) joint.upper = upper->number();
  if (const auto restitution = row.find("restitution")) {
    if (!joint.has_limits()) restitution->refuse("the joint has no limit to bounce off; allowed: lower or upper, too");
    joint.restitution = restitution->fraction_of_one();
  }
}

void read_coordinate(const TableReader& row, Joint& joint) {
  if (const auto stiffness = row.find("stiffness")) joint.stiffness = stiffness->non_negative();
  if (const auto damping = row.find("damping")) joint.damping = damping->non_negative();
  if (const auto rest = row.find("rest")) {
    if (joint.stiffness == 0) rest->refuse("a joint without stiffness has no rest; allowed: stiffness, too");
    joint.rest = rest->number();
  }
  read_limits(row, joint);
}

std::size_t find_joint(const TomlValue& value, const Scene& scene) {
  const std::string name = value.text();
  std::vector<std::string> names;
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    if (scene.joints[k].name == name) return k;
    if (!scene.joints[k].name.empty()) names.push_back(scene.joints[k].name);
  }
  value.refuse(fmt::format("there is no joint '{}'{}; there is: {}", shown(name), did_you_mean(name, names),
                           names.empty() ? "none with a name" : listed(names)));
}

}  // namespace

const Keys& joint_keys() {
  static const Keys keys = {"type",    "name",      "a",       "b",    "anchor", "axis",  "axis2",      "point_a",
                            "point_b", "stiffness", "damping", "rest", "lower",  "upper", "restitution"};
  return keys;
}

const Keys& motor_keys() {
  static const Keys keys = {"joint", "torque", "force", "speed", "most", "from", "until"};
  return keys;
}

Joint read_joint(TableReader row, const Scene& scene, const Ends& ends, bool check_velocities) {
  Keys names;
  for (const JointRow& type : joint_rows()) names.push_back(type.name);
  const std::string name = row.at("type").choice(names);
  const auto type =
      std::find_if(joint_rows().begin(), joint_rows().end(), [&](const JointRow& r) { return r.name == name; });
  Joint joint;
  joint.a = ends.a, joint.b = ends.b;
  joint.type = type->read(row, ends);
  const bool has_coordinate = free_axis(joint) != nullptr;
  Keys keys = kOfEvery;
  keys.insert(keys.end(), type->keys.begin(), type->keys.end());
  if (has_coordinate) keys.insert(keys.end(), kOfCoordinate.begin(), kOfCoordinate.end());
  row.narrow(keys, fmt::format("a {} joint", name));
  if (const auto own = row.find("name")) joint.name = own->text() + ends.copy;
  if (has_coordinate) read_coordinate(row, joint);
  refuse_if(fault_of(joint, scene), row);
  if (!check_velocities) return joint;
  if (const std::string why = why_rates_break(scene, joint); !why.empty())
    row.refuse(why + "; `rigor settle FILE` prints the file with velocities that keep it");
  return joint;
}

void read_times(const TableReader& row, double& from, double& until) {
  if (const auto value = row.find("from")) from = value->non_negative();
  if (const auto value = row.find("until")) until = value->number();
}

Motor read_motor(const TableReader& row, const Scene& scene) {
  Motor motor;
  const std::size_t joint = find_joint(row.at("joint"), scene);
  motor.joint = static_cast<int>(joint);
  const std::string type = joint_type_name(scene.joints[joint]);
  if (!free_axis(scene.joints[joint])) refuse_if(fault_of(motor, scene), row);
  const std::string effort = type == "hinge" ? "torque" : "force", other = type == "hinge" ? "force" : "torque";
  if (const auto wrong = row.find(other)) wrong->refuse(fmt::format("a {} takes a {}", type, effort));
  const auto given = row.find(effort), speed = row.find("speed"), most = row.find("most");
  if (given.has_value() == speed.has_value())
    row.refuse(fmt::format("gives {}; allowed: {}, or speed and most", given ? "both" : "neither", effort));
  if (given) motor.effort = given->number();
  if (speed) motor.speed = speed->number(), motor.most = row.at("most").positive();
  if (most && !speed) most->refuse(fmt::format("bounds what keeps a speed; allowed: speed, too, or {} alone", effort));
  read_times(row, motor.from, motor.until);
  refuse_if(fault_of(motor, scene), row);
  return motor;
}

}  // namespace rigor
