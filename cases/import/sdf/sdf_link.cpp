#include "cases/import/sdf/sdf_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <set>
#include <utility>

#include "cases/import/mesh_shape.h"
#include "cases/import/model_elements.h"
#include "cases/import/model_files.h"
#include "core/base/near_match.h"

namespace rigor::inline imports {
namespace {

constexpr double kFrictionOfFormat = 1;

// A flag that agrees with a scene's bodies needs no notice.
struct Flag {
  const char* word;
  bool of_a_scene;
  Reason why;
};
const Flag kFlags[] = {{"kinematic", false, lost("says that no force moves this link; in a scene forces move all")},
                       {"self_collide", false, assumed("is read of models alone")},
                       {"enable_wind", false, lost("is wind, which no scene has")}};

class SdfLinkReader {
 public:
  SdfLinkReader(const XmlElement& element, const std::string& file, bool repairs, LeftOut& left_out)
      : element_(element), file_(file), repairs_(repairs), left_out_(left_out) {}

  Link read() {
    XmlKnown known{{"name"},
                   {"inertial", "collision", "pose", "gravity"},
                   {{"visual", kIsSeen},
                    {"light", kIsSeen},
                    {"projector", kIsSeen},
                    {"particle_emitter", kIsSeen},
                    {"sensor", kSensor},
                    {"audio_source", kSaysNothing},
                    {"audio_sink", kSaysNothing},
                    {"battery", kSaysNothing},
                    {"plugin", kController},
                    {"velocity_decay", lost("is damping by the world, which no scene has")},
                    {"must_be_base_link", kSaysNothing}}};
    for (const auto& [word, of_a_scene, why] : kFlags) {
      const auto flag = element_.child(word);
      if (flag && flag->flag_of_text() == of_a_scene) {
        known.elements.push_back(word);
      } else {
        known.left_out.emplace_back(word, why);
      }
    }
    element_.check(known, left_out_);
    Link link{element_.name_attribute(), element_.place(), {}};
    link.inertial.push_back(inertial());
    if (const auto gravity = element_.child("gravity"); gravity && !gravity->flag_of_text()) link.lifted = 1;
    for (const XmlElement& visual : element_.children("visual")) check_mesh(visual);
    for (const XmlElement& collision : element_.children("collision")) read_collision(collision, link);
    return link;
  }

 private:
  LinkInertial inertial() {
    const auto inertial = element_.child("inertial");
    if (!inertial) {
      left_out_.add(element_.place(), "its inertia",
                    assumed("there is no <inertial>: the format's 1 kg and 1 kg m² are taken"));
      return {1, {}, Mat3::Identity()};
    }
    if (inertial->find("auto").value_or("false") != "false")
      inertial->refuse("auto: the inertia would be computed from shapes; allowed: numbers");
    inertial->check({{"auto"},
                     {"mass", "inertia", "pose"},
                     {{"density", no_motion("is for an inertia that is computed")},
                      {"fluid_added_mass", lost("is the mass of a fluid, which no scene has")}}},
                    left_out_);
    const auto mass = inertial->child("mass"), inertia = inertial->child("inertia");
    LinkInertial out{mass ? mass->number_of_text() : 1, sdf_pose(inertial->child("pose"), left_out_), Mat3::Identity()};
    check_mass(out.mass, mass.value_or(*inertial));
    if (!inertia) return out;
    inertia->check({{}, {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"}}, left_out_);
    const auto moment = [&](const char* name, double otherwise) {
      const auto found = inertia->child(name);
      return found ? found->number_of_text() : otherwise;
    };
    out.inertia = symmetric(moment("ixx", 1), moment("iyy", 1), moment("izz", 1), moment("ixy", 0), moment("ixz", 0),
                            moment("iyz", 0));
    out.inertia = checked_inertia(out.inertia, *inertia, repairs_, left_out_);
    return out;
  }

  void check_mesh(const XmlElement& of) {
    const auto geometry = of.child("geometry");
    const auto mesh = geometry ? geometry->child("mesh") : std::nullopt;
    if (mesh) check_stays_in_folder(mesh->only("uri").text(), *mesh, file_);
  }

  void read_collision(const XmlElement& element, Link& link) {
    element.check({{"name"},
                   {"geometry", "pose", "surface"},
                   {{"laser_retro", kSaysNothing},
                    {"max_contacts", kOfASolver},
                    {"density", no_motion("is for an inertia that is computed")}}},
                  left_out_);
    if (!names_.insert(element.name_attribute()).second)
      element.refuse("another collision of this link has this name, too");
    const XmlElement geometry = element.only("geometry");
    geometry.check({{},
                    {"box", "capsule", "cylinder", "ellipsoid", "empty", "mesh", "plane", "sphere"},
                    {{"cone", lost("is a cone, which no scene has: nothing touches it")},
                     {"heightmap", lost("is a height map: nothing touches it")},
                     {"polyline", lost("is a prism: nothing touches it")},
                     {"image", lost("is an image: nothing touches it")}}},
                   left_out_);
    const auto shape = shape_of(geometry);
    if (!shape) return;
    LinkShape out{*shape, sdf_pose(element.child("pose"), left_out_),
                  {},     1,
                  1,      fmt::format("{}: collision of link '{}'", element.where(), link.name)};
    read_surface(element.child("surface"), out);
    link.shapes.push_back(out);
  }

  std::optional<Shape> shape_of(const XmlElement& geometry) {
    std::optional<Shape> shape;
    bool is_first = true;
    for (const XmlElement& element : geometry.children()) {
      if (!std::exchange(is_first, false)) element.refuse("is a second shape; allowed: one");
      const auto length = [&](const char* name) {
        const XmlElement value = element.only(name);
        return positive(value.number_of_text(), "it", value);
      };
      if (element.name() == "box") {
        element.check({{}, {"size"}}, left_out_);
        const XmlElement size = element.only("size");
        shape = Box{vector_of(size.numbers_of_text(3))};
        positive(std::get<Box>(*shape).size.minCoeff(), "its least edge", size);
      } else if (element.name() == "sphere") {
        element.check({{}, {"radius"}}, left_out_);
        shape = Sphere{length("radius")};
      } else if (element.name() == "capsule") {
        element.check({{}, {"radius", "length"}}, left_out_);
        shape = Capsule{length("radius"), length("length")};
      } else if (element.name() == "cylinder") {
        element.check({{}, {"radius", "length"}}, left_out_);
        shape = Cylinder{length("radius"), length("length")};
      } else if (element.name() == "ellipsoid") {
        element.check({{}, {"radii"}}, left_out_);
        const XmlElement radii = element.only("radii");
        shape = Ellipsoid{vector_of(radii.numbers_of_text(3))};
        positive(std::get<Ellipsoid>(*shape).radii.minCoeff(), "its least radius", radii);
      } else if (element.name() == "mesh") {
        shape = mesh_of(element);
      } else if (element.name() == "plane") {
        element.check({{}, {"normal", "size"}}, left_out_);
        const auto normal = element.child("normal");
        shape = Plane{normal ? direction_of(vector_of(normal->numbers_of_text(3)), *normal) : Vec3::UnitZ().eval(), 0};
      }
    }
    return shape;
  }

  std::optional<Shape> mesh_of(const XmlElement& element) {
    element.check({{"optimization"},
                   {"uri", "scale"},
                   {{"submesh", lost("is a part of a mesh: the whole mesh is taken")},
                    {"convex_decomposition", lost("is several hulls: one hull is taken")}}},
                  left_out_);
    if (const std::string way = element.find("optimization").value_or(""); way == "convex_decomposition")
      left_out_.add(element.place(), "optimization", lost("asks for several hulls: one hull is taken"));
    const auto scale = element.child("scale");
    return hull_of_mesh(element.only("uri").text(), scale ? vector_of(scale->numbers_of_text(3)) : Vec3::Ones().eval(),
                        element, file_, left_out_);
  }

  void read_surface(const std::optional<XmlElement>& surface, LinkShape& shape) {
    ContactLaw& law = shape.surface;
    law = {0, kFrictionOfFormat};
    if (!surface) return;
    surface->check({{},
                    {"friction", "bounce", "contact"},
                    {{"soft_contact", lost("makes the body soft: in a scene it is rigid")}}},
                   left_out_);
    if (const auto contact = surface->child("contact")) read_contact(*contact, shape);
    if (const auto bounce = surface->child("bounce")) {
      bounce->check({{}, {"restitution_coefficient"}, {{"threshold", kOfASolver}}}, left_out_);
      const auto value = bounce->child("restitution_coefficient");
      if (value) law.restitution = not_negative(value->number_of_text(), "it", *value);
      if (value && law.restitution > 1) value->refuse("is greater than 1");
    }
    if (const auto friction = surface->child("friction")) read_friction(*friction, law);
  }

  void read_contact(const XmlElement& contact, LinkShape& shape) {
    contact.check({{},
                   {"collide_bitmask", "collide_without_contact"},
                   {{"collide_without_contact_bitmask", kSaysNothing},
                    {"category_bitmask", lost("is a second filter, which is not read")},
                    {"poissons_ratio", kOfASolver},
                    {"elastic_modulus", kOfASolver},
                    {"ode", kOfASolver},
                    {"bullet", kOfASolver}}},
                  left_out_);
    if (const auto bits = contact.child("collide_bitmask")) {
      const std::string text = bits->text();
      char* end = nullptr;
      const unsigned long mask = std::strtoul(text.c_str(), &end, 0);
      if (text.empty() || *end != '\0' || text.front() == '-' || mask > 0xffffffff)
        bits->refuse(fmt::format("found '{}'; allowed: a whole number of 32 bits", text));
      shape.type = shape.affinity = static_cast<unsigned>(mask);
    }
    if (const auto without = contact.child("collide_without_contact"); without && without->flag_of_text())
      shape.type = shape.affinity = 0;
  }

  void read_friction(const XmlElement& friction, ContactLaw& law) {
    friction.check({{}, {"ode", "torsional"}, {{"bullet", assumed("belongs to one engine; <ode> is taken")}}},
                   left_out_);
    if (const auto spin = friction.child("torsional")) {
      const auto mu = spin->child("coefficient"), slip = spin->child("ode");
      const double value = mu ? mu->number_of_text() : 1;
      if (value != 0 && (mu || slip || !spin->children().empty()))
        left_out_.add(spin->place(), "torsional friction", lost("acts against spinning: no scene has it"));
    }
    const auto ode = friction.child("ode");
    if (!ode) return;
    ode->check({{},
                {"mu", "mu2"},
                {{"fdir1", lost("is a direction of friction; in a scene all are the same")},
                 {"slip1", kOfASolver},
                 {"slip2", kOfASolver}}},
               left_out_);
    const auto mu = ode->child("mu"), mu2 = ode->child("mu2");
    if (mu) law.friction = not_negative(mu->number_of_text(), "it", *mu);
    if (mu2 && mu2->number_of_text() != law.friction)
      left_out_.add(mu2->place(), "<mu2>", lost("differs from <mu>: in a scene friction has no direction"));
  }

  XmlElement element_;
  const std::string& file_;
  bool repairs_;
  LeftOut& left_out_;
  std::set<std::string> names_;
};

}  // namespace

BodyPose sdf_pose(const std::optional<XmlElement>& pose, LeftOut& left_out) {
  if (!pose) return {};
  pose->check({{"relative_to", "frame", "degrees", "rotation_format"}, {}}, left_out);
  const std::string format = pose->find("rotation_format").value_or("euler_rpy");
  const std::vector<std::string> formats = {"euler_rpy", "quat_xyzw"};
  if (std::find(formats.begin(), formats.end(), format) == formats.end())
    pose->refuse(fmt::format("rotation_format: found '{}'{}; allowed: {}", format, did_you_mean(format, formats),
                             listed(formats)));
  if (pose->text().empty()) return {};
  if (format == "quat_xyzw") {
    const auto v = pose->numbers_of_text(7);
    const Quat q(v[6], v[3], v[4], v[5]);
    if (!(q.norm() > 1e-6)) pose->refuse("its quaternion has no length");
    return {{v[0], v[1], v[2]}, q.normalized()};
  }
  const auto v = pose->numbers_of_text(6);
  const std::string degrees = pose->find("degrees").value_or("false");
  const double unit = degrees == "true" || degrees == "1" ? std::numbers::pi / 180 : 1;
  return {{v[0], v[1], v[2]}, turn_of(unit * v[3], unit * v[4], unit * v[5])};
}

Link read_sdf_link(const XmlElement& element, const std::string& file, bool repairs, LeftOut& left_out) {
  return SdfLinkReader(element, file, repairs, left_out).read();
}

}  // namespace rigor::inline imports
