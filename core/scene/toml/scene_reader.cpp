#include "core/scene/toml/scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

#include "core/base/near_match.h"
#include "core/scene/toml/body_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor {
namespace {

// Bodies by name, for everything that refers to one.
class BodyIndex {
 public:
  void add(const std::string& name, int index, const TableReader& row) {
    const auto [known, is_new] = index_.try_emplace(name, index, row.at("name").where());
    if (is_new) return;
    row.at("name").refuse(fmt::format("there is already a body '{}', at {}; allowed: a name that no other body has",
                                      shown(name), known->second.second));
  }

  int body(const TomlValue& value) const { return find(value, false); }
  int body_or_world(const TomlValue& value) const { return find(value, true); }

 private:
  int find(const TomlValue& value, bool world_allowed) const {
    const std::string name = value.text();
    if (name == "world") {
      if (world_allowed) return kWorld;
      value.refuse("found 'world', which is no body; allowed: a body's name");
    }
    const auto found = index_.find(name);
    if (found != index_.end()) return found->second.first;
    value.refuse(fmt::format("there is no body '{}'{}; there is: {}", shown(name),
                             did_you_mean(name, known(world_allowed)), some_of(known(world_allowed))));
  }

  std::vector<std::string> known(bool world_allowed) const {
    std::vector<std::string> names;
    for (const auto& [name, entry] : index_) names.push_back(name);
    std::sort(names.begin(), names.end());
    if (world_allowed) names.push_back("world");
    return names;
  }

  static std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 8;
    std::vector<std::string> first;
    for (const std::string& name : names) {
      if (first.size() < kMost) first.push_back(shown(name));
    }
    return listed(first) + (names.size() > kMost ? fmt::format(" and {} more", names.size() - kMost) : "");
  }

  std::unordered_map<std::string, std::pair<int, std::string>> index_;  // the body's index, and where its name stands
};

class SceneReader {
 public:
  Scene read(const TomlValue& value) {
    const TableReader table =
        value.table({"gravity", "body", "spring", "joint", "contact", "contact_default", "force"});
    if (const auto gravity = table.find("gravity")) scene_.gravity = gravity->vector();
    for (const TableReader& row : rows(table, "body", body_keys())) add_body(row);
    if (scene_.bodies.empty()) table.refuse("there is no [[scene.body]]; allowed: a scene of at least one body");
    for (const TableReader& row : rows(table, "spring", kSpringKeys)) scene_.springs.push_back(read_spring(row));
    for (const TableReader& row : rows(table, "joint", joint_keys())) scene_.joints.push_back(read_joint(row));
    if (const auto law = table.find("contact_default")) {
      scene_.contact_default = read_law(law->table({"restitution", "friction"}), {});
    }
    for (const TableReader& row : rows(table, "contact", {"a", "b", "restitution", "friction"})) add_contact(row);
    for (const TableReader& row : rows(table, "force", kForceKeys)) scene_.forces.push_back(read_force(row));
    return std::move(scene_);
  }

 private:
  struct JointRow {
    std::string name;
    Keys keys;  // beside type, a and b
    void (SceneReader::*read)(const TableReader& row, Joint& joint) const;
  };
  inline static const Keys kSpringKeys = {"a", "point_a", "b", "point_b", "stiffness", "damping", "rest_length"};
  inline static const Keys kForceKeys = {"body", "force", "torque", "point", "from", "until"};

  static const std::vector<JointRow>& joint_rows() {
    static const std::vector<JointRow> rows = {
        {"ball", {"anchor"}, &SceneReader::read_ball},
        {"distance", {"point_a", "point_b"}, &SceneReader::read_distance},
        {"fixed", {}, &SceneReader::read_fixed},
        {"hinge", {"anchor", "axis"}, &SceneReader::read_hinge},
        {"slider", {"axis"}, &SceneReader::read_slider},
    };
    return rows;
  }

  static Keys joint_keys() { return {"type", "a", "b", "anchor", "axis", "point_a", "point_b"}; }

  static std::vector<TableReader> rows(const TableReader& table, std::string_view key, const Keys& allowed) {
    const auto value = table.find(key);
    return value ? value->tables(allowed) : std::vector<TableReader>();
  }

  static Vec3 vector_or_zero(const TableReader& row, std::string_view key) {
    const auto value = row.find(key);
    return value ? value->vector() : Vec3::Zero();
  }

  void add_body(const TableReader& row) {
    scene_.bodies.push_back(read_body(row));
    index_.add(scene_.bodies.back().name, static_cast<int>(scene_.bodies.size()) - 1, row);
  }

  bool can_move(int body) const { return body != kWorld && !scene_.bodies[body].fixed; }

  // The two ends a and b of a spring or joint, of which at least one must be able to move.
  std::pair<int, int> read_ends(const TableReader& row, const char* what) const {
    const int a = index_.body_or_world(row.at("a")), b = index_.body_or_world(row.at("b"));
    if (a == b)
      row.at("b").refuse(fmt::format("a {} from '{}' to itself does nothing", what, shown(scene_.body_name(a))));
    if (!can_move(a) && !can_move(b)) {
      row.at("b").refuse(fmt::format("a {} from '{}' to '{}' does nothing, for neither can move", what,
                                     shown(scene_.body_name(a)), shown(scene_.body_name(b))));
    }
    return {a, b};
  }

  Vec3 in_world(int body, const Vec3& point) const {
    if (body == kWorld) return point;
    return scene_.bodies[body].position + scene_.bodies[body].orientation * point;
  }

  double distance_at_start(int a, const Vec3& point_a, int b, const Vec3& point_b) const {
    return (in_world(b, point_b) - in_world(a, point_a)).stableNorm();
  }

  Spring read_spring(const TableReader& row) const {
    Spring spring;
    std::tie(spring.a, spring.b) = read_ends(row, "spring");
    spring.point_a = vector_or_zero(row, "point_a");
    spring.point_b = vector_or_zero(row, "point_b");
    spring.stiffness = row.at("stiffness").non_negative();
    if (const auto damping = row.find("damping")) spring.damping = damping->non_negative();
    const auto rest_length = row.find("rest_length");
    spring.rest_length = rest_length ? rest_length->non_negative()
                                     : distance_at_start(spring.a, spring.point_a, spring.b, spring.point_b);
    if (!std::isfinite(spring.rest_length)) row.refuse("the distance between its ends is too large for a number");
    return spring;
  }

  void read_ball(const TableReader& row, Joint& joint) const { joint.type = BallJoint{row.at("anchor").vector()}; }
  void read_hinge(const TableReader& row, Joint& joint) const {
    joint.type = HingeJoint{row.at("anchor").vector(), row.at("axis").direction()};
  }
  void read_slider(const TableReader& row, Joint& joint) const { joint.type = SliderJoint{row.at("axis").direction()}; }
  void read_fixed(const TableReader&, Joint& joint) const { joint.type = FixedJoint{}; }
  void read_distance(const TableReader& row, Joint& joint) const {
    const DistanceJoint type{row.at("point_a").vector(), row.at("point_b").vector()};
    if (!(distance_at_start(joint.a, type.point_a, joint.b, type.point_b) > 0)) {
      row.at("point_b").refuse(
          "the two points coincide at t = 0, so their distance has no direction; allowed: points apart");
    }
    joint.type = type;
  }

  Joint read_joint(TableReader row) const {
    Keys names;
    for (const JointRow& type : joint_rows()) names.push_back(type.name);
    const std::string name = row.at("type").choice(names);
    const auto type =
        std::find_if(joint_rows().begin(), joint_rows().end(), [&](const JointRow& r) { return r.name == name; });
    Keys keys = {"type", "a", "b"};
    keys.insert(keys.end(), type->keys.begin(), type->keys.end());
    row.narrow(keys, fmt::format("a {} joint", name));
    Joint joint;
    std::tie(joint.a, joint.b) = read_ends(row, "joint");
    (this->*type->read)(row, joint);
    return joint;
  }

  static ContactLaw read_law(const TableReader& row, ContactLaw law) {
    if (const auto restitution = row.find("restitution")) law.restitution = restitution->fraction_of_one();
    if (const auto friction = row.find("friction")) law.friction = friction->non_negative_or_infinite();
    return law;
  }

  void add_contact(const TableReader& row) {
    const int a = index_.body(row.at("a")), b = index_.body(row.at("b"));
    if (a == b) row.at("b").refuse(fmt::format("'{}' cannot touch itself", shown(scene_.body_name(a))));
    if (!pairs_seen_.insert(std::minmax({a, b})).second) {
      row.refuse(fmt::format("the contact of '{}' and '{}' is given twice; allowed: once, in either order",
                             shown(scene_.body_name(a)), shown(scene_.body_name(b))));
    }
    scene_.contact_pairs.push_back({a, b, read_law(row, scene_.contact_default)});
  }

  TimedForce read_force(const TableReader& row) const {
    TimedForce force;
    force.body = index_.body(row.at("body"));
    if (!can_move(force.body)) row.at("body").refuse("the body is fixed, so no force can move it");
    if (!row.find("force") && !row.find("torque")) row.refuse("gives neither force nor torque; allowed: one or both");
    force.force = vector_or_zero(row, "force");
    force.torque = vector_or_zero(row, "torque");
    force.point = vector_or_zero(row, "point");
    if (const auto from = row.find("from")) force.from = from->non_negative();
    if (const auto until = row.find("until")) {
      force.until = until->number();
      if (force.until <= force.from) {
        until->refuse(fmt::format("found {}; allowed: a time after from, which is {} s", force.until, force.from));
      }
    }
    return force;
  }

  Scene scene_;
  BodyIndex index_;
  std::set<std::pair<int, int>> pairs_seen_;
};

}  // namespace

Scene read_scene(const TomlValue& value) { return SceneReader().read(value); }

}  // namespace rigor
