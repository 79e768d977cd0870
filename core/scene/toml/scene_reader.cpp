#include "core/scene/toml/scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "core/scene/contact_laws.h"
#include "core/scene/joint_rates.h"
#include "core/scene/toml/body_index.h"
#include "core/scene/toml/body_reader.h"
#include "core/scene/toml/joint_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline scene {
namespace {

class SceneReader {
 public:
  explicit SceneReader(InitialVelocities velocities) : velocities_(velocities) {}

  Scene read(const TomlValue& value) {
    const TableReader table = value.table(scene_keys());
    if (const auto gravity = table.find("gravity")) scene_.gravity = gravity->vector();
    for (const TableReader& row : rows(table, "array", array_keys())) index_.add_array(read_array(row), row.at("body"));
    for (const TableReader& row : rows(table, "body", body_keys())) add_body(row);
    if (scene_.bodies.empty()) table.refuse("there is no [[scene.body]]; allowed: a scene of at least one body");
    index_.check_arrays_are_used();
    for (const TableReader& row : rows(table, "spring", kSpringKeys)) add_spring(row);
    for (const TableReader& row : rows(table, "joint", joint_keys())) add_joint(row);
    for (const TableReader& row : rows(table, "coupling", coupling_keys())) add_coupling(row);
    for (const TableReader& row : rows(table, "motor", motor_keys())) scene_.motors.push_back(read_motor(row, scene_));
    if (const auto law = table.find("contact_default")) {
      scene_.contact_default = read_law(law->table(kLawKeys), {});
      refuse_if(fault_of_default(scene_), law->table(kLawKeys));
    }
    for (const TableReader& row : rows(table, "contact", kPairKeys)) add_contact(row);
    if (const auto flag = table.find("self_contact"); flag && !flag->flag()) keep_joined_bodies_apart();
    for (const TableReader& row : rows(table, "force", kForceKeys)) scene_.forces.push_back(read_force(row));
    return std::move(scene_);
  }

 private:
  inline static const Keys kSpringKeys = {"a",         "point_a", "b",           "point_b",
                                          "stiffness", "damping", "rest_length", "quadratic_stiffness"};
  inline static const Keys kLawKeys = {"restitution",        "friction",  "static_friction", "rolling_friction",
                                       "torsional_friction", "stiffness", "damping",         "dissipation"};
  inline static const Keys kPairKeys = [] {
    Keys keys = {"a", "b", "collides"};
    keys.insert(keys.end(), kLawKeys.begin(), kLawKeys.end());
    return keys;
  }();
  inline static const Keys kForceKeys = {"body", "force", "torque", "point", "from", "until"};

  static std::vector<TableReader> rows(const TableReader& table, std::string_view key, const Keys& allowed) {
    const auto value = table.find(key);
    return value ? value->tables(allowed) : std::vector<TableReader>();
  }

  static Vec3 vector_or_zero(const TableReader& row, std::string_view key) {
    const auto value = row.find(key);
    return value ? value->vector() : Vec3::Zero();
  }

  void add_body(const TableReader& row) {
    Body body = read_body(row);
    const std::string where = row.at("name").where();
    BodyArray* const array = index_.find_array(body.name);
    if (!array) return add_body(std::move(body), where);
    if (array->first != kWorld) row.at("name").refuse(fmt::format("there is already a body '{}'", shown(body.name)));
    array->first = static_cast<int>(scene_.bodies.size());
    for (Body& copy : copies_of(body, *array)) add_body(std::move(copy), where);
  }

  void add_body(Body body, const std::string& where) {
    index_.add(body.name, static_cast<int>(scene_.bodies.size()), where);
    scene_.bodies.push_back(std::move(body));
  }

  // The two ends a and b of a spring or joint, of which at least one must be able to move; for a row on an array those
  // of each copy.
  std::vector<Ends> read_ends(const TableReader& row, const char* what) const {
    const std::vector<Ends> all = index_.ends(row.at("a"), row.at("b"));
    for (const auto& [a, b, offset, copy] : all) refuse_if(fault_of_ends(a, b, what, scene_), row);
    return all;
  }

  double distance_at_start(int a, const Vec3& point_a, int b, const Vec3& point_b) const {
    const BodyPose pose_a = scene_.pose(a), pose_b = scene_.pose(b);
    return (pose_b.position + pose_b.orientation * point_b - pose_a.position - pose_a.orientation * point_a)
        .stableNorm();
  }

  void add_spring(const TableReader& row) {
    for (const Ends& ends : read_ends(row, "spring")) scene_.springs.push_back(read_spring(row, ends));
  }

  Spring read_spring(const TableReader& row, const Ends& ends) const {
    Spring spring;
    spring.a = ends.a, spring.b = ends.b;
    spring.point_a = vector_or_zero(row, "point_a") + (ends.a == kWorld ? ends.offset : Vec3::Zero());
    spring.point_b = vector_or_zero(row, "point_b") + (ends.b == kWorld ? ends.offset : Vec3::Zero());
    spring.stiffness = row.at("stiffness").non_negative();
    if (const auto quadratic = row.find("quadratic_stiffness")) spring.quadratic_stiffness = quadratic->non_negative();
    refuse_if(fault_of_quadratic(spring.stiffness, spring.quadratic_stiffness), row);
    if (const auto damping = row.find("damping")) spring.damping = damping->non_negative();
    const auto rest_length = row.find("rest_length");
    spring.rest_length = rest_length ? rest_length->non_negative()
                                     : distance_at_start(spring.a, spring.point_a, spring.b, spring.point_b);
    if (!std::isfinite(spring.rest_length)) row.refuse("the distance between its ends is too large for a number");
    return spring;
  }

  void add_joint(const TableReader& row) {
    for (const Ends& ends : read_ends(row, "joint")) {
      for (const auto& [joint, of] : read_joint(row, scene_, ends, velocities_ == InitialVelocities::checked)) {
        if (!joint.name.empty() && !joint_names_.insert(joint.name).second)
          of.at("name").refuse(fmt::format("there is already a joint '{}'; allowed: another name", shown(joint.name)));
        scene_.joints.push_back(joint);
        if (!free_axis(joint)) continue;
        if (const auto friction = read_friction(of, scene_)) scene_.motors.push_back(*friction);
      }
    }
  }

  void add_coupling(const TableReader& row) {
    scene_.couplings.push_back(read_coupling(row, scene_));
    refuse_if(fault_of_circle(scene_.couplings, scene_.couplings.size() - 1, scene_), row);
    if (velocities_ != InitialVelocities::checked) return;
    if (const std::string why = why_rates_break(scene_, scene_.couplings.back()); !why.empty())
      row.refuse(why + "; `rigor settle FILE` prints the file with velocities that keep it");
  }

  static ContactLaw read_law(const TableReader& row, ContactLaw law) {
    if (const auto restitution = row.find("restitution")) law.restitution = restitution->fraction_of_one();
    if (const auto friction = row.find("friction")) law.friction = friction->non_negative_or_infinite();
    for (const auto& [key, value] :
         {std::pair("static_friction", &law.static_friction), std::pair("rolling_friction", &law.rolling_friction),
          std::pair("torsional_friction", &law.torsional_friction), std::pair("stiffness", &law.stiffness),
          std::pair("damping", &law.damping), std::pair("dissipation", &law.dissipation)}) {
      if (const auto given = row.find(key)) *value = given->non_negative();
    }
    return law;
  }

  void add_contact(const TableReader& row) {
    const int a = index_.body(row.at("a")), b = index_.body(row.at("b"));
    ContactPair pair{a, b, read_law(row, scene_.contact_default)};
    if (const auto collides = row.find("collides"); collides && !collides->flag()) {
      for (const std::string& key : kLawKeys) {
        if (row.find(key)) row.at(key).refuse("the pair never touches, for collides is false; allowed: one of the two");
      }
      pair.law = kApart;
    }
    refuse_if(fault_of(pair, scene_), row);
    if (!pairs_seen_.insert(std::minmax({a, b})).second) {
      row.refuse(fmt::format("the contact of '{}' and '{}' is given twice; allowed: once, in either order",
                             shown(scene_.body_name(a)), shown(scene_.body_name(b))));
    }
    scene_.contact_pairs.push_back(pair);
  }

  // A row of [[scene.contact]] comes first: it says more about its pair than self_contact does.
  void keep_joined_bodies_apart() {
    for (const Joint& joint : scene_.joints) {
      if (joint.a == kWorld || joint.b == kWorld || !can_meet(scene_.bodies[joint.a], scene_.bodies[joint.b])) continue;
      if (pairs_seen_.insert(std::minmax({joint.a, joint.b})).second)
        scene_.contact_pairs.push_back({joint.a, joint.b, kApart});
    }
  }

  TimedForce read_force(const TableReader& row) const {
    TimedForce force;
    force.body = index_.body(row.at("body"));
    if (!row.find("force") && !row.find("torque")) row.refuse("gives neither force nor torque; allowed: one or both");
    force.force = vector_or_zero(row, "force");
    force.torque = vector_or_zero(row, "torque");
    force.point = vector_or_zero(row, "point");
    read_times(row, force.from, force.until);
    refuse_if(fault_of(force, scene_), row);
    return force;
  }

  InitialVelocities velocities_;
  Scene scene_;
  BodyIndex index_;
  std::set<std::string> joint_names_;
  std::set<std::pair<int, int>> pairs_seen_;
};

}  // namespace

const std::vector<std::string>& case_keys() {
  static const Keys keys = {"title", "source", "scene", "run", "truth", "gate"};
  return keys;
}

const std::vector<std::string>& scene_keys() {
  static const Keys keys = {"gravity", "body",    "array",           "spring", "joint",       "coupling",
                            "motor",   "contact", "contact_default", "force",  "self_contact"};
  return keys;
}

Scene read_scene(const TomlValue& value, InitialVelocities velocities) { return SceneReader(velocities).read(value); }

}  // namespace rigor::inline scene
