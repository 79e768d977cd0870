// SDF 1.9. All moving bodies form one model, whose links have the bodies' frames. Each fixed body is a static model.
// Joints are in the model's frame, which is W.
#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "cases/report/scene/scene_formats.h"

namespace rigor::inline report {
namespace {

std::string sdf_numbers(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

// With a quaternion, for turns about three axes would lose digits.
std::string sdf_pose_of(const BodyPose& pose) {
  const Quat& q = pose.orientation;
  return fmt::format("<pose rotation_format=\"quat_xyzw\">{} {} {} {} {}</pose>", sdf_numbers(pose.position), q.x(),
                     q.y(), q.z(), q.w());
}

std::string sdf_escaped(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return text;
}

struct SdfGeometry {
  std::string operator()(const Sphere& s) const {
    return fmt::format("<sphere><radius>{}</radius></sphere>", s.radius);
  }
  std::string operator()(const Box& b) const { return fmt::format("<box><size>{}</size></box>", sdf_numbers(b.size)); }
  std::string operator()(const Capsule& c) const {
    return fmt::format("<capsule><radius>{}</radius><length>{}</length></capsule>", c.radius, c.length);
  }
  std::string operator()(const Cylinder& c) const {
    return fmt::format("<cylinder><radius>{}</radius><length>{}</length></cylinder>", c.radius, c.length);
  }
  std::string operator()(const Ellipsoid& e) const {
    return fmt::format("<ellipsoid><radii>{}</radii></ellipsoid>", sdf_numbers(e.radii));
  }
  std::string operator()(const Plane& p) const {
    return fmt::format("<plane><normal>{}</normal></plane>", sdf_numbers(p.normal));
  }
  // A compound's parts are written one by one. SDF has meshes in files of their own alone.
  template <typename Other>
  std::string operator()(const Other&) const {
    return "";
  }
};

class SdfWriter {
 public:
  SdfWriter(const Scene& scene, LeftOut& left_out) : scene_(scene), left_out_(left_out) {}

  std::string text() {
    add("<?xml version=\"1.0\"?>\n<sdf version=\"1.9\">\n  <world name=\"rigor\">\n    <gravity>{}</gravity>\n",
        sdf_numbers(scene_.gravity));
    bool some_move = false;
    for (const Body& body : scene_.bodies) {
      some_move |= !body.fixed;
      if (body.fixed) add_static(body);
    }
    if (some_move) add_moving();
    add("  </world>\n</sdf>\n");
    name_the_rest();
    return std::move(out_);
  }

 private:
  template <typename... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Values>(values)...);
  }

  void add_shape(const Body& body, const char* indent) {
    if (!body.shape) return;
    int number = 0;
    for_each_part(*body.shape, [&](const Shape& shape, const BodyPose& pose) {
      add_part(body, shape, pose, number == 0 ? "shape" : fmt::format("shape{}", number + 1), indent);
      ++number;
    });
  }

  void add_part(const Body& body, const Shape& shape, const BodyPose& at, const std::string& name, const char* indent) {
    const std::string geometry_of_shape = std::visit(SdfGeometry(), shape);
    if (geometry_of_shape.empty())
      return leave_out(fmt::format("body '{}'", body.name),
                       std::holds_alternative<Convex>(shape) ? "its convex hull" : "its " + shape_name(shape),
                       "a mesh of SDF is a file of its own");
    const double mu = scene_.contact_default.friction;
    const auto* plane = std::get_if<Plane>(&shape);
    std::string pose;
    if (plane) pose = fmt::format("<pose>{} 0 0 0</pose>", sdf_numbers(Vec3(plane->normal * plane->offset)));
    if (std::holds_alternative<Compound>(*body.shape)) pose = sdf_pose_of(at);
    const std::string geometry = fmt::format("{}<geometry>{}</geometry>", pose, geometry_of_shape);
    add("{}<visual name=\"{}\">{}</visual>\n", indent, name, geometry);
    if (!body.collides) return;
    add("{}<collision name=\"{}\">{}<surface><friction><ode><mu>{}</mu><mu2>{}</mu2></ode></friction>", indent, name,
        geometry, std::min(mu, 1e6), std::min(mu, 1e6));
    add("<bounce><restitution_coefficient>{}</restitution_coefficient></bounce></surface></collision>\n",
        scene_.contact_default.restitution);
  }

  void add_static(const Body& body) {
    const bool is_plane = body.shape && std::holds_alternative<Plane>(*body.shape);
    add("    <model name=\"{}\">\n      <static>true</static>\n      {}\n      <link name=\"link\">\n",
        sdf_escaped(body.name), sdf_pose_of(is_plane ? BodyPose() : BodyPose{body.position, body.orientation}));
    add_shape(body, "        ");
    add("      </link>\n    </model>\n");
  }

  // In a scene all bodies may touch each other; in SDF only if the model says so.
  void add_moving() {
    add("    <model name=\"{}\">\n      <self_collide>true</self_collide>\n", kModel);
    for (const Body& body : scene_.bodies) {
      if (!body.fixed) add_link(body);
    }
    for (std::size_t k = 0; k < scene_.joints.size(); ++k) add_joint(k);
    add("    </model>\n");
  }

  void add_link(const Body& body) {
    const Mat3& I = body.inertia;
    add("      <link name=\"{}\">\n        {}\n        <inertial><mass>{}</mass><inertia>", sdf_escaped(body.name),
        sdf_pose_of({body.position, body.orientation}), body.mass);
    add("<ixx>{}</ixx><iyy>{}</iyy><izz>{}</izz><ixy>{}</ixy><ixz>{}</ixz><iyz>{}</iyz></inertia></inertial>\n",
        I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
    add_shape(body, "        ");
    add("      </link>\n");
    if (!body.velocity.isZero(0) || !body.angular_velocity.isZero(0))
      leave_out(fmt::format("body '{}'", body.name), "its velocity", "a model of SDF is at rest");
  }

  std::string end_of(int body) const {
    if (body == kWorld || scene_.bodies[body].fixed) return "world";
    return sdf_escaped(scene_.bodies[body].name);
  }

  void add_joint(std::size_t index) {
    const Joint& joint = scene_.joints[index];
    if (is_axis_of_compound(joint)) return;  // its compound joint is named
    const char* type = std::visit(
        ForJoints{[](const BallJoint&) { return "ball"; }, [](const CylindricalJoint&) { return ""; },
                  [](const DistanceJoint&) { return ""; }, [](const FixedJoint&) { return "fixed"; },
                  [](const HingeJoint&) { return "revolute"; }, [](const SliderJoint&) { return "prismatic"; },
                  [](const UniversalJoint&) { return "universal"; }, [](const CompoundAxis&) { return ""; },
                  [](const CompoundJoint&) { return ""; }, [](const PlanarJoint&) { return ""; },
                  [](const ScrewJoint&) { return ""; }},
        joint.type);
    if (!*type)
      return leave_out(scene_.joint_name(index), "the joint",
                       std::holds_alternative<DistanceJoint>(joint.type) ? "SDF has no joint of a distance"
                       : std::holds_alternative<ScrewJoint>(joint.type)
                           ? "versions of SDF mean different things by the pitch of a screw"
                           : fmt::format("SDF has no {} joint", joint_type_name(joint)));
    if (joint.armature > 0)
      leave_out(scene_.joint_name(index), "its armature", "SDF has no inertia of a rotor on an axis");
    // The world hangs on nothing: a joint from a body to it is one from it to the body, the other way round.
    const bool is_swapped = end_of(joint.b) == "world";
    const double sign = is_swapped ? -1 : 1;
    const std::string name = joint.name.empty() ? fmt::format("joint{}", index) : sdf_escaped(joint.name);
    add("      <joint name=\"{}\" type=\"{}\">\n        <parent>{}</parent>\n        <child>{}</child>\n", name, type,
        end_of(is_swapped ? joint.b : joint.a), end_of(is_swapped ? joint.a : joint.b));
    const Vec3* anchor = anchor_of(joint);
    add("        <pose relative_to=\"__model__\">{} 0 0 0</pose>\n", sdf_numbers(anchor ? *anchor : Vec3::Zero()));
    if (const auto* universal = std::get_if<UniversalJoint>(&joint.type)) {
      add_axis("axis", is_swapped ? universal->axis2 : universal->axis, "");
      add_axis("axis2", is_swapped ? universal->axis : universal->axis2, "");
    } else if (const Vec3* axis = free_axis(joint)) {
      add_axis("axis", sign * *axis, coordinate_of(joint));
    }
    add("      </joint>\n");
  }

  void add_axis(const char* which, const Vec3& axis, const std::string& more) {
    add("        <{0}><xyz expressed_in=\"__model__\">{1}</xyz>{2}</{0}>\n", which, sdf_numbers(axis), more);
  }

  // Turned round at both ends it is the same coordinate.
  static std::string coordinate_of(const Joint& joint) {
    std::string text = "<limit>";
    if (std::isfinite(joint.lower)) text += fmt::format("<lower>{}</lower>", joint.lower);
    if (std::isfinite(joint.upper)) text += fmt::format("<upper>{}</upper>", joint.upper);
    return text + fmt::format(
                      "</limit><dynamics><damping>{}</damping><friction>0</friction><spring_reference>{}</"
                      "spring_reference><spring_stiffness>{}</spring_stiffness></dynamics>",
                      joint.damping, joint.rest, joint.stiffness);
  }

  void leave_out(const std::string& of, const std::string& what, const std::string& why) {
    left_out_.add(of, what, lost(why));
  }

  void name_the_rest() {
    for (const Spring& spring : scene_.springs)
      leave_out(fmt::format("a spring between '{}' and '{}'", scene_.body_name(spring.a), scene_.body_name(spring.b)),
                "it", "SDF has no springs between points");
    for (std::size_t k = 0; k < scene_.joints.size(); ++k)
      if (scene_.joints[k].quadratic_stiffness > 0)
        leave_out(scene_.joint_name(k), "its quadratic_stiffness", "SDF's springs are linear");
    for (std::size_t k = 0; k < scene_.couplings.size(); ++k)
      leave_out(scene_.coupling_name(k), "it", "is not written: the joints move by themselves");
    for (const Motor& motor : scene_.motors)
      leave_out(fmt::format("{} {}", motor.is_friction ? "friction in" : "a motor on",
                            scene_.joint_name(static_cast<std::size_t>(motor.joint))),
                "it", "SDF has no motors");
    for (const TimedForce& force : scene_.forces)
      leave_out(fmt::format("a force on '{}'", scene_.body_name(force.body)), "it", "SDF has no timed forces");
    if (scene_.contact_default.resists_turning())
      leave_out("the contact of all bodies", "its rolling and torsional friction", "SDF states them per engine");
    if (scene_.contact_default.sticks_better())
      leave_out("the contact of all bodies", "its static friction", "SDF has one coefficient");
    if (scene_.contact_default.is_soft())
      leave_out("the contact of all bodies", "its stiffness", "SDF states it per engine");
    for (const ContactPair& pair : scene_.contact_pairs) {
      const auto of_pair =
          fmt::format("the contact of '{}' and '{}'", scene_.body_name(pair.a), scene_.body_name(pair.b));
      if (pair.law.collides) {
        leave_out(of_pair, "its values", "SDF has surfaces and no pairs; those of the rest are written");
      } else {
        leave_out(of_pair, "that they never touch", "SDF says so of a whole model, not of a pair: they collide");
      }
    }
  }

  static constexpr const char* kModel = "bodies";
  const Scene& scene_;
  LeftOut& left_out_;
  std::string out_;
};

}  // namespace

std::string sdf_scene(const Scene& scene, LeftOut& left_out) { return SdfWriter(scene, left_out).text(); }

}  // namespace rigor::inline report
