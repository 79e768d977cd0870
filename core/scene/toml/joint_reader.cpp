#include "core/scene/toml/joint_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/near_match.h"
#include "core/scene/joint_rates.h"
#include "core/scene/joints/axis_series.h"
#include "core/scene/toml/time_table_reader.h"

namespace rigor::inline scene {
namespace {

const Keys kOfEvery = {"type", "name", "a", "b"};
const Keys kOfCoordinate = {"stiffness", "quadratic_stiffness", "damping", "rest", "friction", "armature", "lower",
                            "upper",     "restitution"};
const Keys kOfSeriesAxis = {"type", "name", "anchor", "axis"};

JointType read_type(const TableReader& row, const Ends& ends, JointType type) {
  for_each_vector(type, [&](const char* key, JointVector kind, Vec3& vector) {
    const TomlValue value = row.at(key);
    vector = kind == JointVector::direction ? value.direction() : value.vector();
    const bool is_in_W = kind == JointVector::point || (kind == JointVector::point_of_a && ends.a == kWorld) ||
                         (kind == JointVector::point_of_b && ends.b == kWorld);
    if (is_in_W) vector += ends.offset;
  });
  for_each_number(type, [&](const char* key, double& number) { number = row.at(key).number(); });
  return type;
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
  if (const auto quadratic = row.find("quadratic_stiffness")) joint.quadratic_stiffness = quadratic->non_negative();
  if (const auto damping = row.find("damping")) joint.damping = damping->non_negative();
  if (const auto armature = row.find("armature")) joint.armature = armature->non_negative();
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
  static const Keys keys = [] {
    Keys all = kOfEvery;
    all.push_back("axes");
    for (const JointTypeInfo& type : joint_types()) {
      std::copy_if(type.keys.begin(), type.keys.end(), std::back_inserter(all),
                   [&](const std::string& key) { return std::find(all.begin(), all.end(), key) == all.end(); });
    }
    all.insert(all.end(), kOfCoordinate.begin(), kOfCoordinate.end());
    return all;
  }();
  return keys;
}

const Keys& motor_keys() {
  static const Keys keys = {"joint",  "torque", "force",  "interpolate", "file", "column",
                            "speed",  "most",   "target", "kp",          "kd",   "target_speed",
                            "period", "from",   "until",  "plus",        "ratio"};
  return keys;
}

namespace {

// The axes of a compound joint, each with what only it has.
std::vector<JointOfFile> read_series(const TableReader& row, const Ends& ends, const Joint& whole) {
  Keys keys = kOfSeriesAxis;
  keys.insert(keys.end(), kOfCoordinate.begin(), kOfCoordinate.end());
  std::vector<SeriesAxis> axes;
  std::vector<JointOfFile> rows;
  for (TableReader& own : row.at("axes").tables(keys)) {
    SeriesAxis axis;
    axis.turns = own.at("type").choice({"hinge", "slider"}) == "hinge";
    axis.axis = own.at("axis").direction();
    if (axis.turns) axis.anchor = own.at("anchor").vector() + ends.offset;
    if (!axis.turns && own.find("anchor")) {
      Keys others = keys;
      std::erase(others, "anchor");
      own.at("anchor").refuse(fmt::format("a slider has no anchor; allowed: {}", fmt::join(others, ", ")));
    }
    Joint part;
    part.a = whole.a, part.b = whole.b;
    if (const auto name = own.find("name")) part.name = name->text() + ends.copy;
    axes.push_back(axis);
    rows.push_back({part, own});
  }
  if (const std::string why = why_no_series(axes); !why.empty()) row.at("axes").refuse(why);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].joint.type = CompoundAxis{axes, i};
    read_coordinate(rows[i].row, rows[i].joint);
  }
  Joint first = whole;
  first.type = CompoundJoint{axes};
  rows.insert(rows.begin(), {first, row});
  return rows;
}

}  // namespace

std::vector<JointOfFile> read_joint(TableReader row, const Scene& scene, const Ends& ends, bool check_velocities) {
  Keys names;
  for (const JointTypeInfo& type : joint_types())
    if (type.is_whole) names.push_back(type.word);
  const std::string name = row.at("type").choice(names);
  const auto type = std::find_if(joint_types().begin(), joint_types().end(),
                                 [&](const JointTypeInfo& info) { return info.word == name; });
  const bool is_series = std::holds_alternative<CompoundJoint>(type->prototype);
  const bool has_coordinate = type->coordinate != FreeCoordinate::none;
  Keys keys = kOfEvery;
  keys.insert(keys.end(), type->keys.begin(), type->keys.end());
  if (is_series) keys.push_back("axes");
  if (has_coordinate) keys.insert(keys.end(), kOfCoordinate.begin(), kOfCoordinate.end());
  row.narrow(keys, fmt::format("a {} joint", name));
  Joint joint;
  joint.a = ends.a, joint.b = ends.b;
  if (const auto own = row.find("name")) joint.name = own->text() + ends.copy;
  std::vector<JointOfFile> rows;
  if (is_series) {
    rows = read_series(row, ends, joint);
  } else {
    joint.type = read_type(row, ends, type->prototype);
    if (has_coordinate) read_coordinate(row, joint);
    rows.push_back({joint, row});
  }
  for (const JointOfFile& read : rows) {
    refuse_if(fault_of(read.joint, scene), read.row);
    if (!check_velocities) continue;
    if (const std::string why = why_rates_break(scene, read.joint); !why.empty())
      read.row.refuse(why + "; `rigor settle FILE` prints the file with velocities that keep it");
  }
  return rows;
}

const Keys& coupling_keys() {
  static const Keys keys = {"joint", "to", "ratio", "offset"};
  return keys;
}

// `key` names one joint or several, and `ratio` gives a number for each.
static std::vector<JointTerm> read_terms(const TableReader& row, const char* key, const Scene& scene) {
  const std::vector<TomlValue> joints = row.at(key).items(), ratios = row.at("ratio").items();
  if (joints.size() != ratios.size())
    row.at("ratio").refuse(fmt::format("found {} for {} {}; allowed: one for each joint of `{}`", ratios.size(),
                                       joints.size(), joints.size() == 1 ? "joint" : "joints", key));
  std::vector<JointTerm> terms;
  for (std::size_t k = 0; k < joints.size(); ++k)
    terms.push_back({static_cast<int>(find_joint(joints[k], scene)), ratios[k].number()});
  return terms;
}

Coupling read_coupling(const TableReader& row, const Scene& scene) {
  Coupling coupling;
  coupling.joint = static_cast<int>(find_joint(row.at("joint"), scene));
  coupling.to = read_terms(row, "to", scene);
  if (const auto offset = row.find("offset")) coupling.offset = offset->number();
  refuse_if(fault_of(coupling, scene), row);
  return coupling;
}

void read_times(const TableReader& row, double& from, double& until) {
  if (const auto value = row.find("from")) from = value->non_negative();
  if (const auto value = row.find("until")) until = value->number();
}

namespace {

const Keys kOfServo = {"kp", "kd", "target", "target_speed", "period"};

Servo read_servo(const TableReader& row) {
  Servo servo;
  if (const auto kp = row.find("kp")) servo.kp = kp->non_negative();
  if (const auto kd = row.find("kd")) servo.kd = kd->non_negative();
  if (servo.kp == 0 && servo.kd == 0) row.refuse("its servo has neither kp nor kd; allowed: at least one above 0");
  const auto target = read_effort_or_target(row, "target");
  if (servo.kp > 0 && !target) row.refuse("gives kp and no target; allowed: target, or file and column, too");
  if (servo.kp == 0 && target) row.at("target").refuse("without kp a target has no effect; allowed: kp, too");
  servo.target = target.value_or(TimeTable::constant(0));
  if (const auto speed = row.find("target_speed")) {
    servo.target_speed = speed->number();
    if (servo.kd == 0) speed->refuse("without kd it has no effect; allowed: kd, too");
  }
  if (const auto most = row.find("most")) servo.most = most->positive();
  if (const auto period = row.find("period")) servo.period = period->positive();
  return servo;
}

void read_drive(const TableReader& row, const std::string& effort, Motor& motor) {
  const auto given = row.find(effort), speed = row.find("speed"), most = row.find("most");
  const auto servo = std::find_if(kOfServo.begin(), kOfServo.end(), [&](const auto& key) { return row.find(key); });
  const bool is_servo = servo != kOfServo.end(), has_effort = given || (row.find("file") && !is_servo);
  const int ways = int(has_effort) + int(speed.has_value()) + int(is_servo);
  if (ways != 1)
    row.refuse(fmt::format("gives {}; allowed: {}, or speed and most, or kp and target",
                           ways == 0 ? "neither" : "more than one drive", effort));
  if (is_servo) {
    motor.servo = read_servo(row);
  } else if (has_effort) {
    const TimeTable table = *read_effort_or_target(row, effort);
    motor.effort = table.values.front();
    if (!table.is_constant()) motor.efforts = table, motor.effort = 0;
  } else {
    motor.speed = speed->number(), motor.most = row.at("most").positive();
  }
  if (speed) refuse_table_keys(row, "a speed is a number");
  if (most && has_effort)
    most->refuse(fmt::format("bounds what keeps a speed; allowed: speed, too, or {} alone", effort));
}

}  // namespace

Motor read_motor(const TableReader& row, const Scene& scene) {
  Motor motor;
  if (const auto way = row.find("interpolate")) way->choice({"linear", "previous"});
  const std::size_t joint = find_joint(row.at("joint"), scene);
  motor.joint = static_cast<int>(joint);
  const std::string type = joint_type_name(scene.joints[joint]);
  if (!free_axis(scene.joints[joint])) refuse_if(fault_of(motor, scene), row);
  const bool is_angle = turns(scene.joints[joint]);
  const std::string effort = is_angle ? "torque" : "force", other = is_angle ? "force" : "torque";
  if (const auto wrong = row.find(other)) wrong->refuse(fmt::format("a {} takes a {}", type, effort));
  if (row.find("plus")) motor.plus = read_terms(row, "plus", scene);
  if (const auto ratio = row.find("ratio"); ratio && motor.plus.empty())
    ratio->refuse("belongs to the joints of `plus`; allowed: plus, too");
  read_drive(row, effort, motor);
  read_times(row, motor.from, motor.until);
  refuse_if(fault_of(motor, scene), row);
  return motor;
}

std::optional<Motor> read_friction(const TableReader& row, const Scene& scene) {
  const auto friction = row.find("friction");
  if (!friction || friction->non_negative() == 0) return std::nullopt;
  Motor motor;
  motor.joint = static_cast<int>(scene.joints.size()) - 1;
  motor.speed = 0, motor.most = friction->number(), motor.is_friction = true;
  return motor;
}

}  // namespace rigor::inline scene
