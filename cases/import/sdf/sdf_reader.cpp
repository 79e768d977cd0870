#include "cases/import/sdf/sdf_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "cases/import/model_elements.h"
#include "cases/import/model_files.h"
#include "cases/import/sdf/sdf_coordinate.h"
#include "cases/import/sdf/sdf_frames.h"
#include "cases/import/sdf/sdf_link.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline imports {
namespace {

constexpr double kSdfGravity = 9.8;  // m/s², along -z: the format's own default
constexpr int kDeepest = 16;         // models in models and files in files
const std::vector<std::string> kSdfJointTypes = {"revolute",  "continuous", "prismatic", "ball",   "universal",
                                                 "revolute2", "fixed",      "screw",     "gearbox"};
const Reason kOfWorld = no_motion("describes the world around, and nothing of it acts on these bodies");

class SdfReader {
 public:
  SdfReader(const XmlFile& file, const ImportOptions& options) : path_(file.path()), repairs_(options.repair_inertia) {
    model_.combine = least_of;
  }

  LinkModel read(const XmlFile& file) {
    const XmlElement root = file.root();
    model_.gravity = {0, 0, -kSdfGravity}, size_ = file.size();
    read_file(root, "", "", 0);
    if (model_.links.empty()) root.refuse("there is no <link> in it");
    for (Later& later : later_) later.finish(*this);
    if (models_ == 1) shorten_names();
    return std::move(model_);
  }

 private:
  // Poses and joints may name elements further down in the file.
  struct Later {
    std::function<void(SdfReader&)> finish;
  };

  struct Scope {
    std::string name;  // "outer::inner::"
    int model;         // the model that owns its links
    bool is_static, touches_itself;
    int depth;
  };

  void read_file(const XmlElement& root, const std::string& scope, const std::string& rename, int depth) {
    if (root.name() != "sdf") root.refuse("found this at the top; allowed: <sdf>");
    version_ = version_of(root);
    root.check({{"version"},
                {"world", "model"},
                {{"actor", no_motion("moves by a script, and nothing touches it")}, {"light", kIsSeen}}},
               model_.left_out);
    const auto worlds = root.children("world"), models = root.children("model");
    if (worlds.size() + models.size() != 1)
      root.refuse(
          fmt::format("holds {} worlds and models; allowed: one world or one model", worlds.size() + models.size()));
    if (worlds.empty()) {
      if (model_.name.empty()) model_.name = models.front().name_attribute();
      return read_model(models.front(), {scope, -1, false, false, depth}, rename);
    }
    if (depth > 0) worlds.front().refuse("is a world in a world; allowed: a model");
    read_world(worlds.front());
  }

  int version_of(const XmlElement& root) const {
    const std::string text = root.at("version");
    for (int minor = 4; minor <= 11; ++minor) {
      if (text == fmt::format("1.{}", minor)) return minor;
    }
    root.refuse(fmt::format("version: found '{}'; allowed: 1.4 to 1.11", text));
  }

  void read_world(const XmlElement& world) {
    world.check({{"name"},
                 {"gravity", "model", "include", "joint", "frame"},
                 {{"physics", kOfASolver},
                  {"light", kIsSeen},
                  {"scene", kIsSeen},
                  {"gui", kIsSeen},
                  {"road", kIsSeen},
                  {"plugin", kController},
                  {"actor", no_motion("moves by a script, and nothing touches it")},
                  {"state", assumed("is a state during a run; the models' own poses are taken")},
                  {"atmosphere", kOfWorld},
                  {"wind", kOfWorld},
                  {"magnetic_field", kOfWorld},
                  {"spherical_coordinates", kOfWorld},
                  {"audio", kOfWorld},
                  {"population", lost("draws models by lot; none is taken")}}},
                model_.left_out);
    model_.name = world.find("name").value_or("world");
    if (const auto gravity = world.child("gravity")) model_.gravity = vector_of(gravity->numbers_of_text(3));
    for (const XmlElement& frame : world.children("frame")) read_frame(frame, "");
    for (const XmlElement& model : world.children("model")) read_model(model, {"", -1, false, false, 1}, "");
    for (const XmlElement& include : world.children("include")) read_include(include, {"", -1, false, false, 1});
    for (const XmlElement& joint : world.children("joint")) read_joint(joint, "");
  }

  // `outer`: the model's parent; its links belong to the outer model if there is one.
  void read_model(const XmlElement& element, const Scope& outer, const std::string& rename,
                  const std::optional<XmlElement>& pose_of_include = {}) {
    if (outer.depth > kDeepest) element.refuse(fmt::format("models in models go deeper than {}", kDeepest));
    element.check({{"name", "canonical_link"},
                   {"link", "joint", "frame", "model", "include", "pose", "static", "self_collide"},
                   {{"plugin", kController},
                    {"gripper", kController},
                    {"allow_auto_disable", no_motion("lets bodies sleep, and none sleeps here")},
                    {"enable_wind", lost("is wind, which no scene has")}}},
                  model_.left_out);
    if (element.find("placement_frame"))
      element.refuse("placement_frame: is not read; allowed: a pose of the model's own frame");
    const std::string name = rename.empty() ? element.name_attribute() : rename;
    const auto flag = [&](const char* word) {
      const auto child = element.child(word);
      return child && child->flag_of_text();
    };
    Scope scope = outer;
    scope.name = outer.name + name + "::", scope.depth = outer.depth + 1;
    scope.model = outer.model < 0 ? models_++ : outer.model;
    scope.is_static = outer.is_static || flag("static");
    scope.touches_itself = outer.touches_itself || flag("self_collide");
    const auto pose = pose_of_include ? pose_of_include : element.child("pose");
    const std::string base = pose ? pose->find("relative_to").value_or("") : "";
    const std::string of_outer = outer.name.empty() ? "" : "__model__";
    frames_.add(scope.name, "__model__", sdf_pose(pose, model_.left_out), outer.name, base.empty() ? of_outer : base,
                element);
    // Frames outside the model call it by its name.
    frames_.add(outer.name, name, BodyPose(), scope.name, "__model__", element);
    for (const XmlElement& link : element.children("link")) read_link(link, scope);
    for (const XmlElement& frame : element.children("frame")) read_frame(frame, scope.name);
    for (const XmlElement& model : element.children("model")) read_model(model, scope, "");
    for (const XmlElement& include : element.children("include")) read_include(include, scope);
    for (const XmlElement& joint : element.children("joint")) read_joint(joint, scope.name);
  }

  void read_include(const XmlElement& element, const Scope& outer) {
    element.check({{"merge"},
                   {"uri", "name", "pose"},
                   {{"plugin", kController}, {"static", kSaysNothing}, {"placement_frame", kSaysNothing}}},
                  model_.left_out);
    for (const char* word : {"static", "placement_frame"}) {
      if (const auto child = element.child(word))
        child->refuse("changes what is included, which is not read; allowed: to say it in the model itself");
    }
    if (element.find("merge").value_or("false") != "false") element.refuse("merge: is not read; allowed: false");
    const XmlElement uri = element.only("uri");
    const std::string path = uri.text();
    if (path.find("://") != std::string::npos)
      uri.refuse(fmt::format(
          "'{}' is looked for in folders of this machine; allowed: the path of an .sdf file in the folder of the model",
          path));
    check_stays_in_folder(path, uri, path_);
    const std::string file = (std::filesystem::path(path_).parent_path() / path).string();
    if (outer.depth > kDeepest) uri.refuse(fmt::format("files include files deeper than {}", kDeepest));
    included_.push_back(std::make_unique<XmlFile>(file));
    size_ += included_.back()->size();
    if (size_ > kLargestModel)
      uri.refuse(fmt::format("with it the model is larger than {} MiB, the largest that is read", kLargestModel >> 20));
    const XmlElement root = included_.back()->root();
    const int version = version_;
    const auto name = element.child("name");
    if (root.name() != "sdf") root.refuse("found this at the top; allowed: <sdf>");
    version_ = version_of(root);
    read_model(root.only("model"), outer, name ? name->text() : "", element.child("pose"));
    version_ = version;
  }

  void read_link(const XmlElement& element, const Scope& scope) {
    Link link = read_sdf_link(element, path_, repairs_, model_.left_out);
    const auto pose = element.child("pose");
    frames_.add(scope.name, link.name, sdf_pose(pose, model_.left_out), scope.name, base_of(pose, "__model__"),
                element);
    const std::string own = link.name;
    links_[scope.name + own] = static_cast<int>(model_.links.size());
    link.name = scope.name + own;
    link.is_static = scope.is_static, link.model = scope.model, link.touches_own_model = scope.touches_itself;
    const std::size_t index = model_.links.size();
    model_.links.push_back(std::move(link));
    later_.push_back({[=, name = scope.name](SdfReader& reader) { reader.place_link(index, name, own, element); }});
  }

  // Drops the name of the only outermost model.
  void shorten_names() {
    const auto shorten = [&](std::string& name) { name = name.substr(name.find("::") + 2); };
    for (Link& link : model_.links) shorten(link.name);
    for (LinkJoint& row : model_.joints) {
      if (row.joint.name.find("::") != std::string::npos) shorten(row.joint.name);
    }
  }

  // relative_to exists from 1.7 on.
  std::string base_of(const std::optional<XmlElement>& pose, const std::string& otherwise) const {
    const std::string base = pose && version_ >= 7 ? pose->find("relative_to").value_or("") : "";
    return base.empty() ? otherwise : base;
  }

  void place_link(std::size_t index, const std::string& scope, const std::string& name, const XmlElement& element) {
    Link& link = model_.links[index];
    link.pose = frames_.pose(scope, name, element);
    for (LinkInertial& inertial : link.inertial) inertial.pose = link.pose * inertial.pose;
    for (LinkShape& shape : link.shapes) {
      shape.pose = link.pose * shape.pose;
      if (auto* plane = std::get_if<Plane>(&shape.shape)) {
        plane->normal = (shape.pose.orientation * plane->normal).normalized();
        plane->offset = plane->normal.dot(shape.pose.position);
      }
    }
  }

  void read_frame(const XmlElement& element, const std::string& scope) {
    element.check({{"name", "attached_to"}, {"pose"}}, model_.left_out);
    const std::string to = element.find("attached_to").value_or(""), own = scope.empty() ? "" : "__model__";
    const auto pose = element.child("pose");
    frames_.add(scope, element.name_attribute(), sdf_pose(pose, model_.left_out), scope,
                base_of(pose, to.empty() ? own : to), element);
    if (!to.empty()) frames_.attach(scope, element.name_attribute(), to);
  }

  void read_joint(const XmlElement& element, const std::string& scope) {
    element.check({{"name", "type"},
                   {"parent", "child", "pose", "axis", "axis2", "gearbox_ratio", "gearbox_reference_body",
                    "thread_pitch", "screw_thread_pitch"},
                   {{"physics", kOfASolver}, {"sensor", kSensor}}},
                  model_.left_out);
    const std::string type = element.at("type");
    if (std::find(kSdfJointTypes.begin(), kSdfJointTypes.end(), type) == kSdfJointTypes.end())
      element.refuse(fmt::format("type: found '{}'{}; allowed: {}", type, did_you_mean(type, kSdfJointTypes),
                                 listed(kSdfJointTypes)));
    const auto pose = element.child("pose");
    const std::string child = element.only("child").text(), name = element.name_attribute();
    frames_.add(scope, name, sdf_pose(pose, model_.left_out), scope, base_of(pose, child), element);
    frames_.attach(scope, name, child);
    const int version = version_;
    later_.push_back({[=](SdfReader& reader) { reader.finish_joint(element, scope, name, type, version); }});
  }

  int link_of(const XmlElement& element, const std::string& scope) {
    const std::string name = element.text();
    if (name == "world") return kWorld;
    const auto found = links_.find(frames_.carrier(scope, name, element));
    if (found != links_.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [whole, index] : links_)
      names.push_back(whole.starts_with(scope) ? whole.substr(scope.size()) : whole);
    element.refuse(fmt::format("there is no link '{}'{}", name, did_you_mean(name, names)));
  }

  Vec3 axis_of(const XmlElement& joint, const char* which, const std::string& scope, const std::string& name,
               int version) {
    const XmlElement axis = joint.only(which);
    axis.check({{}, {"xyz", "limit", "dynamics", "use_parent_model_frame", "initial_position"}}, model_.left_out);
    if (const auto initial = axis.child("initial_position"); initial && initial->number_of_text() != 0)
      initial->refuse("is of a draft of the format, in which it was never defined; allowed: 0, or poses of the links");
    const auto xyz = axis.child("xyz");
    Vec3 along = Vec3::UnitZ();
    std::string in = name;
    if (xyz) {
      xyz->check({{"expressed_in"}, {}}, model_.left_out);
      along = direction_of(vector_of(xyz->numbers_of_text(3)), *xyz);
      if (const auto frame = xyz->find("expressed_in"); frame && !frame->empty()) in = *frame;
    }
    const auto parent_frame = axis.child("use_parent_model_frame");
    if (version <= 4 || (parent_frame && parent_frame->flag_of_text())) in = scope.empty() ? "world" : "__model__";
    return (frames_.pose(scope, in, joint).orientation * along).normalized();
  }

  void finish_joint(const XmlElement& element, const std::string& scope, const std::string& name,
                    const std::string& type, int version) {
    LinkJoint row;
    row.where = element.place();
    row.joint.name = scope + name;
    row.joint.a = link_of(element.only("parent"), scope), row.joint.b = link_of(element.only("child"), scope);
    if (row.joint.a == row.joint.b) element.refuse("holds a link to itself");
    if (row.joint.b == kWorld) element.refuse("the world cannot be the child; allowed: the parent");
    const Vec3 anchor = frames_.pose(scope, name, element).position;
    if (type == "screw" || type == "gearbox")
      return model_.left_out.add(row.where, fmt::format("a {} joint", type),
                                 lost("no scene has this joint: the two links come apart"));
    if (type == "fixed") row.joint.type = FixedJoint{};
    if (type == "ball") row.joint.type = BallJoint{anchor};
    if (type == "universal" || type == "revolute2") return add_two_axes(element, scope, name, anchor, version, row);
    if (type == "revolute" || type == "continuous")
      row.joint.type = HingeJoint{anchor, axis_of(element, "axis", scope, name, version)};
    if (type == "prismatic") row.joint.type = SliderJoint{axis_of(element, "axis", scope, name, version)};
    if (free_axis(row.joint)) read_sdf_coordinate(element.only("axis"), type, row, model_.left_out);
    model_.joints.push_back(std::move(row));
  }

  // Two hinges in series, with a link without mass between them.
  void add_two_axes(const XmlElement& element, const std::string& scope, const std::string& name, const Vec3& anchor,
                    int version, LinkJoint row) {
    Link between{row.joint.name + "/between", row.where, {}};
    between.pose = frames_.pose(scope, name, element), between.model = model_.links[row.joint.b].model;
    model_.links.push_back(between);
    LinkJoint second = row;
    row.joint.b = second.joint.a = static_cast<int>(model_.links.size()) - 1;
    row.joint.type = HingeJoint{anchor, axis_of(element, "axis", scope, name, version)};
    second.joint.type = HingeJoint{anchor, axis_of(element, "axis2", scope, name, version)};
    second.joint.name += "/axis2";
    read_sdf_coordinate(element.only("axis"), "revolute", row, model_.left_out);
    read_sdf_coordinate(element.only("axis2"), "revolute", second, model_.left_out);
    model_.joints.push_back(std::move(row)), model_.joints.push_back(std::move(second));
  }

  std::string path_;
  bool repairs_;
  LinkModel model_;
  SdfFrames frames_;
  std::map<std::string, int> links_;
  std::vector<Later> later_;
  std::vector<std::unique_ptr<XmlFile>> included_;
  std::size_t size_ = 0;
  int version_ = 0, models_ = 0;
};

}  // namespace

LinkModel read_sdf(const XmlFile& file, const ImportOptions& options) { return SdfReader(file, options).read(file); }

}  // namespace rigor::inline imports
