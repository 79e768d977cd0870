#include "cases/import/urdf_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "cases/import/mesh_shape.h"
#include "cases/import/model_elements.h"
#include "cases/import/model_files.h"
#include "cases/import/urdf_gazebo.h"
#include "core/base/near_match.h"

namespace rigor::inline imports {
namespace {

constexpr double kGravity = 9.81;  // m/s²: the format states none
const std::vector<std::string> kJointTypes = {"revolute", "continuous", "prismatic", "fixed", "floating", "planar"};

class UrdfReader {
 public:
  UrdfReader(const XmlFile& file, const ImportOptions& options)
      : file_(file), repairs_(options.repair_inertia), root_(file.root()) {}

  LinkModel read() {
    if (root_.name() != "robot") root_.refuse("found this at the top; allowed: <robot>");
    model_.name = root_.find("name").value_or("robot");
    model_.combine = least_of, model_.keeps_overlaps_apart = true;
    model_.gravity = {0, 0, -kGravity};
    model_.left_out.add(root_.place(), "gravity",
                        assumed(fmt::format("the format states none: {} m/s² along -z are assumed", kGravity)));
    root_.check({{"name", "version"},
                 {"link", "joint", "gazebo"},
                 {{"material", kIsSeen},
                  {"transmission", no_motion("describes a drive that nothing controls")},
                  {"ros2_control", kController},
                  {"sensor", kSensor},
                  {"group", kController},
                  {"mujoco", assumed("is for MuJoCo's compiler")}}},
                model_.left_out);
    for (const XmlElement& element : root_.children("link")) read_link(element);
    if (model_.links.empty()) root_.refuse("there is no <link>");
    for (const XmlElement& element : root_.children("joint")) read_joint(element);
    read_mimics();
    start_ = pose_of_urdf_model(root_, model_.left_out);
    place_links();
    for (const XmlElement& element : root_.children("gazebo")) read_urdf_gazebo(element, links_, model_);
    return std::move(model_);
  }

 private:
  struct Held {  // a link by a joint
    XmlElement element;
    int parent, child;
    BodyPose in_parent;
  };

  BodyPose origin_of(const XmlElement& of) {
    const auto origin = of.child("origin");
    if (!origin) return {};
    origin->check({{"xyz", "rpy"}, {}}, model_.left_out);
    const Vec3 rpy = vector_of(origin->find_numbers("rpy", 3));
    return {vector_of(origin->find_numbers("xyz", 3)), turn_of(rpy.x(), rpy.y(), rpy.z())};
  }

  void read_link(const XmlElement& element) {
    element.check(
        {{"name"}, {"inertial", "collision"}, {{"visual", kIsSeen}, {"type", kSaysNothing}, {"sensor", kSensor}}},
        model_.left_out);
    for (const XmlElement& visual : element.children("visual")) check_mesh(visual);
    Link link{element.name_attribute(), element.place(), {}};
    link.touches_own_model = true;  // the format says nothing else
    if (!links_.emplace(link.name, model_.links.size()).second) element.refuse("another link has this name, too");
    if (const auto inertial = element.child("inertial")) link.inertial = inertial_of(*inertial);
    for (const XmlElement& collision : element.children("collision")) read_collision(collision, link);
    model_.links.push_back(std::move(link));
  }

  std::vector<LinkInertial> inertial_of(const XmlElement& element) {
    element.check({{}, {"origin", "mass", "inertia"}}, model_.left_out);
    const XmlElement mass = element.only("mass"), inertia = element.only("inertia");
    mass.check({{"value"}, {}}, model_.left_out);
    const Reason kOtherHalf = assumed("repeats a half of a symmetric matrix; ixy, ixz and iyz are taken");
    inertia.check({{"ixx", "iyy", "izz", "ixy", "ixz", "iyz"},
                   {},
                   {{"iyx", kOtherHalf}, {"izx", kOtherHalf}, {"izy", kOtherHalf}}},
                  model_.left_out);
    if (mass.number("value") == 0) {
      model_.left_out.add(mass.place(), "its inertia",
                          assumed("a mass of 0 is none: the link is taken as one without mass"));
      return {};
    }
    LinkInertial out{mass.number("value"), origin_of(element),
                     symmetric(inertia.number("ixx"), inertia.number("iyy"), inertia.number("izz"),
                               inertia.number("ixy"), inertia.number("ixz"), inertia.number("iyz"))};
    check_mass(out.mass, mass);
    out.inertia = checked_inertia(out.inertia, inertia, repairs_, model_.left_out);
    return {out};
  }

  // The mesh of a visual is not read, but the next reader may open it.
  void check_mesh(const XmlElement& of) {
    const auto geometry = of.child("geometry");
    const auto mesh = geometry ? geometry->child("mesh") : std::nullopt;
    if (mesh) check_stays_in_folder(mesh->at("filename"), *mesh, file_.path());
  }

  void read_collision(const XmlElement& element, Link& link) {
    element.check({{"name"},
                   {"origin", "geometry"},
                   {{"verbose", kSaysNothing},
                    {"group", kSaysNothing},
                    {"material", kIsSeen},
                    {"contact_coefficients", assumed("is not of the format any more")}}},
                  model_.left_out);
    const XmlElement geometry = element.only("geometry");
    geometry.check({{}, {"box", "capsule", "cylinder", "mesh", "sphere"}}, model_.left_out);
    const auto shape = shape_of(geometry);
    if (shape)
      link.shapes.push_back(
          {*shape, origin_of(element), {0, 1}, 1, 1, element.where() + ": collision of link '" + link.name + "'"});
  }

  std::optional<Shape> shape_of(const XmlElement& geometry) {
    std::optional<Shape> shape;
    bool is_first = true;
    for (const XmlElement& element : geometry.children()) {
      if (!std::exchange(is_first, false)) element.refuse("is a second shape; allowed: one");
      const auto length = [&](const char* key) {
        return positive(element.number(key), fmt::format("its {}", key).c_str(), element);
      };
      if (element.name() == "box") {
        element.check({{"size"}, {}}, model_.left_out);
        const Vec3 size = vector_of(element.find_numbers("size", 3));
        positive(size.minCoeff(), "its least edge", element);
        shape = Box{size};
      } else if (element.name() == "sphere") {
        element.check({{"radius"}, {}}, model_.left_out);
        shape = Sphere{length("radius")};
      } else if (element.name() == "capsule") {
        element.check({{"radius", "length"}, {}}, model_.left_out);
        shape = Capsule{length("radius"), length("length")};
      } else if (element.name() == "cylinder") {
        element.check({{"radius", "length"}, {}}, model_.left_out);
        shape = Cylinder{length("radius"), length("length")};
      } else if (element.name() == "mesh") {
        element.check({{"filename", "scale"}, {}}, model_.left_out);
        const Vec3 scale = element.find("scale") ? vector_of(element.find_numbers("scale", 3)) : Vec3::Ones().eval();
        shape = hull_of_mesh(element.at("filename"), scale, element, file_.path(), model_.left_out);
      }
    }
    return shape;
  }

  int link_of(const XmlElement& joint, const char* which) {
    const XmlElement element = joint.only(which);
    element.check({{"link"}, {}}, model_.left_out);
    const std::string name = element.at("link");
    const auto found = links_.find(name);
    if (found != links_.end()) return static_cast<int>(found->second);
    if (name == "world") return kWorld;
    std::vector<std::string> names;
    for (const Link& link : model_.links) names.push_back(link.name);
    element.refuse(fmt::format("there is no link '{}'{}", name, did_you_mean(name, names)));
  }

  void read_joint(const XmlElement& element) {
    element.check(
        {{"name", "type"},
         {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"},
         {{"calibration", kController}, {"safety_controller", kController}, {"hardwareInterface", kController}}},
        model_.left_out);
    LinkJoint row;
    row.where = element.place();
    row.joint.name = element.name_attribute();
    if (!joints_.insert(row.joint.name).second) element.refuse("another joint has this name, too");
    row.joint.a = link_of(element, "parent"), row.joint.b = link_of(element, "child");
    if (row.joint.a == row.joint.b) element.refuse("holds a link to itself");
    if (row.joint.b == kWorld) element.refuse("the world cannot be the child; allowed: the parent");
    const std::string type = element.at("type");
    if (std::find(kJointTypes.begin(), kJointTypes.end(), type) == kJointTypes.end())
      element.refuse(
          fmt::format("type: found '{}'{}; allowed: {}", type, did_you_mean(type, kJointTypes), listed(kJointTypes)));
    held_.push_back({element, row.joint.a, row.joint.b, origin_of(element)});
    rows_.push_back(std::move(row));
    types_.push_back(type);
    read_coordinate(element, type, rows_.back());
  }

  void read_coordinate(const XmlElement& element, const std::string& type, LinkJoint& row) {
    const auto limit = element.child("limit"), dynamics = element.child("dynamics"), axis = element.child("axis");
    const bool slides = type == "prismatic", turns = type == "revolute" || type == "continuous";
    Vec3 along = Vec3::UnitX();  // the format's default
    if (axis) {
      axis->check({{"xyz"}, {}}, model_.left_out);
      const Vec3 given = vector_of(axis->find_numbers("xyz", 3));
      // Many files give a fixed joint the axis 0 0 0, which says nothing there.
      if (slides || turns || type == "planar") along = direction_of(given, *axis);
    }
    if (slides) row.joint.type = SliderJoint{along};
    if (turns) row.joint.type = HingeJoint{Vec3::Zero(), along};
    if (type == "fixed") row.joint.type = FixedJoint{};
    if (type == "planar") row.joint.type = PlanarJoint{Vec3::Zero(), along};
    if (!slides && !turns) return;
    if (dynamics) {
      dynamics->check({{"damping", "friction"}, {}}, model_.left_out);
      row.joint.damping = not_negative(dynamics->find_number("damping").value_or(0), "damping", *dynamics);
      row.friction = not_negative(dynamics->find_number("friction").value_or(0), "friction", *dynamics);
    }
    if (limit)
      limit->check({{"lower", "upper"}, {}, {{"effort", kBoundsADrive}, {"velocity", kBoundsADrive}}}, model_.left_out);
    if (type == "continuous") return;
    if (!limit) element.refuse(fmt::format("there is no <limit>, which a {} joint must have", type));
    const double lower = limit->find_number("lower").value_or(0), upper = limit->find_number("upper").value_or(0);
    if (lower > upper)
      limit->refuse(
          fmt::format("lower is {} and upper {}; allowed: limits of which the upper is greater", lower, upper));
    if (lower == upper) return hold_at(lower, row);
    row.joint.lower = lower, row.joint.upper = upper;
  }

  // Between equal limits nothing moves.
  void hold_at(double place, LinkJoint& row) {
    if (place != 0) {
      model_.left_out.add(row.where, "equal limits", lost("hold the joint beside its zero: it is held at zero"));
    } else {
      model_.left_out.add(row.where, "equal limits", no_motion("hold the joint: it becomes a fixed one"));
    }
    row.joint.type = FixedJoint{};
  }

  void read_mimics() {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const auto mimic = held_[k].element.child("mimic");
      if (!mimic) continue;
      mimic->check({{"joint", "multiplier", "offset"}, {}}, model_.left_out);
      const std::string name = mimic->at("joint");
      const auto found =
          std::find_if(rows_.begin(), rows_.end(), [&](const LinkJoint& row) { return row.joint.name == name; });
      std::vector<std::string> names;
      for (const LinkJoint& row : rows_) names.push_back(row.joint.name);
      if (found == rows_.end()) mimic->refuse(fmt::format("there is no joint '{}'{}", name, did_you_mean(name, names)));
      if (found - rows_.begin() == static_cast<std::ptrdiff_t>(k)) mimic->refuse("the joint mimics itself");
      const double ratio = mimic->find_number("multiplier").value_or(1);
      model_.couplings.push_back({static_cast<int>(k),
                                  {{static_cast<int>(found - rows_.begin()), ratio}},
                                  mimic->find_number("offset").value_or(0),
                                  mimic->place()});
    }
  }

  // Places links from the root outwards. A link that is not reached belongs to a circle.
  void place_links() {
    std::vector<std::vector<std::size_t>> below(model_.links.size() + 1);
    std::vector<int> holder(model_.links.size(), -1);
    for (std::size_t k = 0; k < held_.size(); ++k) {
      if (holder[held_[k].child] >= 0)
        held_[k].element.refuse(fmt::format("link '{}' hangs on two joints; allowed: one, for links make a tree",
                                            model_.links[held_[k].child].name));
      holder[held_[k].child] = static_cast<int>(k);
      below[held_[k].parent + 1].push_back(k);
    }
    std::vector<int> waiting = {kWorld};
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      if (holder[i] >= 0) continue;
      waiting.push_back(static_cast<int>(i));
      place_root(i, below);
    }
    std::size_t placed = 0;
    while (!waiting.empty()) {
      const int parent = waiting.back();
      waiting.pop_back();
      placed += parent != kWorld;
      for (const std::size_t k : below[parent + 1]) {
        const BodyPose from = parent == kWorld ? start_ : model_.links[parent].pose;
        place(model_.links[held_[k].child], from * held_[k].in_parent, rows_[k]);
        waiting.push_back(held_[k].child);
      }
    }
    for (std::size_t i = 0; i < model_.links.size() && placed < model_.links.size(); ++i) {
      if (!reached_[&model_.links[i]])
        held_[holder[i]].element.refuse("its links hang on each other in a circle; allowed: a tree");
    }
    keep_joints();
  }

  // A root called "world" is bolted down, and one without mass. But a root frame that fixed joints connect with a mass
  // is free where more than one joint moves against it: it is the base of a vehicle and not the foot of an arm.
  void place_root(std::size_t index, const std::vector<std::vector<std::size_t>>& below) {
    Link& root = model_.links[index];
    place_at(root, start_);
    const auto [has_mass, joints] = base_of(index, below);
    root.is_static = root.name == "world" || !has_mass || (root.inertial.empty() && joints < 2);
    if (!has_mass || root.name == "world") return;
    model_.left_out.add(
        root.where, "a base",
        assumed(root.is_static
                    ? "is held by the world: its root has no mass, and carries one arm"
                    : "has mass and no joint to the world: it is free. A fixed joint to a link 'world' would hold it"));
  }

  // Looks at the links that fixed joints hold to the root: whether any has mass, and how many joints move against them.
  std::pair<bool, std::size_t> base_of(std::size_t root, const std::vector<std::vector<std::size_t>>& below) const {
    std::vector<std::size_t> waiting = {root};
    std::set<std::size_t> seen;
    std::pair<bool, std::size_t> found = {false, 0};
    while (!waiting.empty()) {
      const std::size_t link = waiting.back();
      waiting.pop_back();
      if (!seen.insert(link).second) continue;
      found.first = found.first || !model_.links[link].inertial.empty();
      for (const std::size_t k : below[link + 1]) {
        if (types_[k] == "fixed") {
          waiting.push_back(static_cast<std::size_t>(held_[k].child));
        } else {
          ++found.second;
        }
      }
    }
    return found;
  }

  void place_at(Link& link, const BodyPose& pose) {
    link.pose = pose, reached_[&link] = true;
    for (LinkInertial& inertial : link.inertial) inertial.pose = pose * inertial.pose;
    for (LinkShape& shape : link.shapes) shape.pose = pose * shape.pose;
  }

  void place(Link& link, const BodyPose& pose, LinkJoint& row) {
    place_at(link, pose);
    for_each_vector(row.joint.type, [&](const char*, JointVector kind, Vec3& vector) {
      if (kind == JointVector::point) vector = pose.position;
      if (kind == JointVector::direction) vector = (pose.orientation * vector).normalized();
    });
  }

  // All joints are kept, so that mimics find them; a floating one is no joint of a scene.
  void keep_joints() {
    std::vector<int> place(rows_.size(), -1);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (types_[k] == "floating") continue;
      place[k] = static_cast<int>(model_.joints.size());
      model_.joints.push_back(rows_[k]);
    }
    keep_renumbered(model_.couplings, place);
  }

  const XmlFile& file_;
  bool repairs_;
  XmlElement root_;
  LinkModel model_;
  BodyPose start_;  // of the model in W
  std::map<std::string, std::size_t> links_;
  std::map<const Link*, bool> reached_;
  std::set<std::string> joints_;
  std::vector<Held> held_;
  std::vector<LinkJoint> rows_;
  std::vector<std::string> types_;
};

}  // namespace

LinkModel read_urdf(const XmlFile& file, const ImportOptions& options) { return UrdfReader(file, options).read(); }

}  // namespace rigor::inline imports
