#include "adapters/mujoco/mujoco_export.h"

#include <fmt/format.h>

#include <iterator>

#include "adapters/mujoco/mujoco_mjcf.h"
#include "adapters/mujoco/mujoco_model.h"
#include "core/base/eigen_of.h"
#include "core/base/error.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline adapters {
namespace {

std::string numbers(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }
std::string numbers(const Quat& q) { return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z()); }

std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return text;
}

// Principal moments and axes: MuJoCo would diagonalise a full inertia to 2.5e-8 of itself only.
std::string inertia_of_body(const Body& body) {
  if (body.inertia.isDiagonal(0)) return fmt::format(R"(diaginertia="{}")", numbers(Vec3(body.inertia.diagonal())));
  const SymmetricEigen principal = eigen_of(body.inertia);
  Mat3 axes = principal.vectors;
  if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  return fmt::format(R"(quat="{}" diaginertia="{}")", numbers(Quat(axes)), numbers(principal.values));
}

class Exporter {
 public:
  Exporter(const Scene& scene, LeftOut& left_out) : scene_(scene), left_out_(left_out), tree_(spanning_tree(scene)) {}

  std::string text() {
    std::string text = body_of_file();
    return text + keyframe(text + "</mujoco>\n") + "</mujoco>\n";
  }

 private:
  template <typename... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Values>(values)...);
  }
  void leave_out(const std::string& of, const std::string& why) { left_out_.add(of, "it", lost(why)); }

  std::string body_of_file() {
    add("<mujoco>\n  <compiler angle=\"radian\" balanceinertia=\"false\" autolimits=\"false\"/>\n");
    add("  <option gravity=\"{}\" cone=\"elliptic\"/>\n", numbers(scene_.gravity));
    add_meshes();
    add("  <worldbody>\n");
    add_sites(kWorld, 4);
    for (int i = 0; i < static_cast<int>(scene_.bodies.size()); ++i) {
      if (scene_.bodies[i].fixed) add_fixed(i);
    }
    for (const int root : tree_.roots) add_body(root);
    add("  </worldbody>\n");
    add_springs();
    add_loops();
    add_motors();
    add_exclusions();
    for (const ContactPair& pair : scene_.contact_pairs) {
      if (pair.law.collides) leave_out(of_pair(pair), "has a friction of its own; that of the rest is written");
    }
    if (scene_.contact_default.restitution > 0) leave_out("restitution", "MuJoCo has none");
    if (scene_.contact_default.sticks_better()) leave_out("static friction", "MuJoCo has one coefficient");
    if (scene_.contact_default.resists_turning())
      leave_out("rolling and torsional friction", "MuJoCo combines them with the sliding friction in one cone");
    leave_out_quadratic_springs();
    if (scene_.contact_default.is_soft()) leave_out("stiffness of contacts", "MuJoCo's is per mass");
    for (const TimedForce& force : scene_.forces)
      leave_out(fmt::format("a force on '{}'", scene_.body_name(force.body)), "MuJoCo's files have no timed forces");
    return std::move(out_);
  }

  std::string of_pair(const ContactPair& pair) const {
    return fmt::format("the contact of '{}' and '{}'", scene_.body_name(pair.a), scene_.body_name(pair.b));
  }
  bool is_plane(int body) const {
    return scene_.bodies[body].shape && std::holds_alternative<Plane>(*scene_.bodies[body].shape);
  }

  // An exclusion names two bodies. Planes are geoms of the world, so one cannot be excluded without the others.
  void add_exclusions() {
    std::string rows;
    for (const ContactPair& pair : scene_.contact_pairs) {
      if (pair.law.collides || !can_meet(scene_.bodies[pair.a], scene_.bodies[pair.b])) continue;
      if (is_plane(pair.a) || is_plane(pair.b)) {
        leave_out(of_pair(pair), "never touch, which MJCF cannot say of a plane: they collide");
        continue;
      }
      rows += fmt::format("    <exclude body1=\"{}\" body2=\"{}\"/>\n", escaped(scene_.body_name(pair.a)),
                          escaped(scene_.body_name(pair.b)));
    }
    if (!rows.empty()) add("  <contact>\n{}  </contact>\n", rows);
  }

  void add_fixed(int index) {
    const Body& body = scene_.bodies[index];
    const bool is_plane = body.shape && std::holds_alternative<Plane>(*body.shape);
    if (is_plane) add_geom(body, 4);
    add("    <body name=\"{}\" pos=\"{}\" quat=\"{}\">\n", escaped(body.name), numbers(body.position),
        numbers(body.orientation));
    if (!is_plane) add_geom(body, 6);
    add_sites(index, 6);
    add("    </body>\n");
  }

  void add_body(int index, int depth = 1) {
    const Body& body = scene_.bodies[index];
    if (depth > kDeepestBody)
      throw InputError(
          fmt::format("body '{}' hangs on {} others; no file of MJCF holds it, for its readers go no deeper", body.name,
                      kDeepestBody));
    const int indent = 2 + 2 * depth;
    const SpanningTree::Link& link = tree_.links[index];
    const BodyPose in_parent = inverse(scene_.pose(link.parent)) * scene_.pose(index);
    add("{:{}}<body name=\"{}\" pos=\"{}\" quat=\"{}\">\n", "", indent, escaped(body.name), numbers(in_parent.position),
        numbers(in_parent.orientation));
    add("{:{}}<inertial pos=\"0 0 0\" mass=\"{}\" {}/>\n", "", indent + 2, body.mass, inertia_of_body(body));
    if (link.joint < 0) {
      add("{:{}}<freejoint/>\n", "", indent + 2);
    } else {
      add_joint(index, link.joint, indent + 2);
    }
    add_geom(body, indent + 2);
    add_sites(index, indent + 2);
    for (const int below : tree_.below[index]) add_body(below, depth + 1);
    add("{:{}}</body>\n", "", indent);
  }

  // A shape that nothing touches is there to be seen.
  void add_geom(const Body& body, int indent) {
    if (!body.shape) return;
    const bool is_placed = std::holds_alternative<Compound>(*body.shape);
    int part = 0;
    for_each_part(*body.shape, [&](const Shape& shape, const BodyPose& pose) {
      const std::string name = part_name(body, part++);
      const std::string geom = mjcf_shape(shape, name);
      if (surface_in(shape) || geom.empty())
        return leave_out(fmt::format("the {} of body '{}'", shape_name(shape), body.name),
                         surface_in(shape)
                             ? "MuJoCo takes the convex hull of a mesh, and a height field from a file of its own"
                             : "MuJoCo has no such shape");
      add("{:{}}<geom name=\"{}\" {}{}{}/>\n", "", indent, name, geom, is_placed ? mjcf_pose(pose) : "",
          touch_of(body));
    });
  }

  static std::string part_name(const Body& body, int part) {
    return escaped(body.name) + (part == 0 ? "" : fmt::format("/{}", part + 1));
  }

  std::string touch_of(const Body& body) const {
    const double mu = scene_.contact_default.friction;
    return !body.collides ? R"( contype="0" conaffinity="0")"
           : mu == 0      ? R"( condim="1")"
                          : fmt::format(R"( condim="3" friction="{} 0.005 0.0001")", std::min(mu, 1e6));
  }

  void add_meshes() {
    std::string meshes;
    for (const Body& body : scene_.bodies) {
      int part = 0;
      if (!body.shape) continue;
      for_each_part(*body.shape, [&](const Shape& shape, const BodyPose&) {
        const std::string name = part_name(body, part++);
        if (std::holds_alternative<Convex>(shape)) meshes += "    " + mjcf_asset(shape, name);
      });
    }
    if (!meshes.empty()) add("  <asset>\n{}  </asset>\n", meshes);
  }

  // The points of springs and distance joints.
  void add_sites(int body, int indent) {
    const auto site = [&](const std::string& name, int of, const Vec3& point) {
      if (of == body) add("{:{}}<site name=\"{}\" pos=\"{}\"/>\n", "", indent, name, numbers(point));
    };
    for (std::size_t k = 0; k < scene_.springs.size(); ++k) {
      site(fmt::format("spring{}a", k), scene_.springs[k].a, scene_.springs[k].point_a);
      site(fmt::format("spring{}b", k), scene_.springs[k].b, scene_.springs[k].point_b);
    }
    for (std::size_t k = 0; k < scene_.joints.size(); ++k) {
      const auto* distance = std::get_if<DistanceJoint>(&scene_.joints[k].type);
      if (!distance) continue;
      site(fmt::format("distance{}a", k), scene_.joints[k].a, distance->point_a);
      site(fmt::format("distance{}b", k), scene_.joints[k].b, distance->point_b);
    }
  }

  std::string joint_name(int index) const {
    const std::string& own = scene_.joints[index].name;
    return own.empty() ? fmt::format("joint{}", index) : escaped(own);
  }
  Vec3 point_in(int body, const Vec3& in_W) const { return (inverse(scene_.pose(body)) * BodyPose{in_W}).position; }
  Vec3 direction_in(int body, const Vec3& in_W) const { return scene_.pose(body).orientation.conjugate() * in_W; }

  void add_joint(int body, int index, int indent) {
    // MuJoCo counts from the parent to what hangs on it.
    const bool is_reversed = scene_.joints[index].b != body;
    const std::vector<MjcfJoint> rows = mjcf_joints(scene_, index, body);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const MjcfJoint& row = rows[k];
      add("{:{}}<joint name=\"{}\" type=\"{}\" pos=\"{}\"", "", indent,
          row.coordinate >= 0 ? joint_name(row.coordinate) : element_name(index, k), row.type,
          numbers(row.point ? point_in(body, *row.point) : Vec3::Zero().eval()));
      const bool is_turned_round = is_reversed && row.coordinate >= 0;
      if (row.axis) add(" axis=\"{}\"", numbers(direction_in(body, is_turned_round ? Vec3(-*row.axis) : *row.axis)));
      if (row.coordinate >= 0) add("{}", coordinate_of(row.coordinate));
      add("/>\n");
    }
  }

  std::string element_name(int joint, std::size_t element) const {
    return joint_name(joint) + (element == 0 ? "" : element == 1 ? "/2" : "/3");
  }

  std::string coordinate_of(int index) const {
    const Joint& joint = scene_.joints[index];
    std::string text =
        fmt::format(R"( stiffness="{}" springref="{}" damping="{}")", joint.stiffness, joint.rest, joint.damping);
    if (joint.armature > 0) text += fmt::format(R"( armature="{}")", joint.armature);
    if (const double friction = mjcf_frictionloss(scene_, index); friction > 0)
      text += fmt::format(R"( frictionloss="{}")", friction);
    constexpr double kFar = 1e6;  // MuJoCo bounds a joint on both sides or on none
    if (joint.has_limits())
      text +=
          fmt::format(R"( limited="true" range="{} {}")", std::max(joint.lower, -kFar), std::min(joint.upper, kFar));
    return text;
  }

  void leave_out_quadratic_springs() {
    const auto grows = [](const auto& row) { return row.quadratic_stiffness > 0; };
    if (std::any_of(scene_.springs.begin(), scene_.springs.end(), grows) ||
        std::any_of(scene_.joints.begin(), scene_.joints.end(), grows))
      leave_out("quadratic_stiffness of springs", "those of the file are linear");
  }

  void add_springs() {
    add("  <tendon>\n");
    for (std::size_t k = 0; k < scene_.springs.size(); ++k) {
      const Spring& spring = scene_.springs[k];
      add("    <spatial stiffness=\"{}\" damping=\"{}\" springlength=\"{}\"><site site=\"spring{}a\"/><site "
          "site=\"spring{}b\"/></spatial>\n",
          spring.stiffness, spring.damping, spring.rest_length, k, k);
    }
    for (const int k : tree_.loops) {
      if (std::holds_alternative<DistanceJoint>(scene_.joints[k].type))
        add("    <spatial name=\"distance{0}\"><site site=\"distance{0}a\"/><site site=\"distance{0}b\"/></spatial>\n",
            k);
    }
    const std::vector<MjcfCoupling> rows = couplings();
    for (std::size_t k = 0; k < rows.size(); ++k) add("{}", rows[k].tendon(k));
    add("  </tendon>\n");
  }

  void add_loops() {
    add("  <equality>\n");
    for (const int k : tree_.loops) {
      const Joint& joint = scene_.joints[k];
      const int first = joint.a != kWorld ? joint.a : joint.b, second = joint.a != kWorld ? joint.b : kWorld;
      const std::string bodies =
          fmt::format(R"(body1="{}"{})", escaped(scene_.body_name(first)),
                      second == kWorld ? "" : fmt::format(R"( body2="{}")", escaped(scene_.body_name(second))));
      MjcfLoop loop = mjcf_loop(joint);
      if (loop.points.size() > 1 &&
          (joint.stiffness != 0 || joint.damping != 0 || joint.armature != 0 || joint.has_limits()))
        loop = {MjcfLoop::Equality::none};
      if (loop.equality == MjcfLoop::Equality::none)
        leave_out(
            scene_.joint_name(static_cast<std::size_t>(k)),
            "closes a loop of joints, which MuJoCo closes by balls, plain hinges, fixed and distance joints alone");
      if (loop.equality == MjcfLoop::Equality::tendon) add("    <tendon tendon1=\"distance{}\"/>\n", k);
      if (loop.equality == MjcfLoop::Equality::weld) add("    <weld {}/>\n", bodies);
      for (const Vec3& point : loop.points)
        add("    <connect {} anchor=\"{}\"/>\n", bodies, numbers(point_in(first, point)));
    }
    add_couplings();
    add("  </equality>\n");
  }

  void add_couplings() {
    for (std::size_t k = 0; k < scene_.couplings.size(); ++k) {
      if (is_of_a_loop(scene_, tree_, scene_.couplings[k]))
        leave_out(scene_.coupling_name(k), "is of a joint that closes a loop, which has no coordinate in MuJoCo");
    }
    const std::vector<MjcfCoupling> rows = couplings();
    for (std::size_t k = 0; k < rows.size(); ++k) add("    {}", rows[k].equality(k));
  }
  std::vector<MjcfCoupling> couplings() const {
    constexpr std::size_t kScrews = 2;  // elements of a screw; other joints with a coordinate have one
    const auto name = [&](int joint, std::size_t element) {
      return element < kScrews ? element_name(joint, element) : joint_name(joint);
    };
    return mjcf_couplings(scene_, tree_, name, [](int) { return 1.0; });
  }

  void add_motors() {
    for (const Motor& motor : scene_.motors) {
      if (!motor.is_friction)
        leave_out(fmt::format("a motor on {}", scene_.joint_name(static_cast<std::size_t>(motor.joint))),
                  "MuJoCo's files have no efforts that last for a time");
      else if (closes_loop(scene_, tree_, motor.joint))
        leave_out(fmt::format("friction in {}", scene_.joint_name(static_cast<std::size_t>(motor.joint))),
                  "MuJoCo has no coordinate of a joint that closes a loop");
    }
  }

  // The velocities at t = 0, in MuJoCo's coordinates; its poses are those of the file.
  std::string keyframe(const std::string& text) const {
    const bool at_rest = std::all_of(scene_.bodies.begin(), scene_.bodies.end(), [](const Body& body) {
      return body.velocity.isZero(0) && body.angular_velocity.isZero(0);
    });
    if (at_rest) return "";
    MujocoModel made;
    made.model = mujoco_library::compile(text);
    for (const Body& body : scene_.bodies)
      made.body.push_back(mj_name2id(made.model.get(), mjOBJ_BODY, body.name.c_str()));
    std::vector<double> velocities = mujoco_velocities(scene_, tree_, made);
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {  // an axis that was turned round counts the other way
      const int joint = tree_.links[i].joint;
      if (scene_.bodies[i].fixed || joint < 0 || scene_.joints[joint].b == static_cast<int>(i)) continue;
      const std::vector<MjcfJoint> rows = mjcf_joints(scene_, joint, static_cast<int>(i));
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (rows[k].coordinate >= 0)
          velocities[static_cast<std::size_t>(made.model->body_dofadr[made.body[i]]) + k] *= -1;
    }
    return fmt::format("  <keyframe>\n    <key name=\"start\" qvel=\"{}\"/>\n  </keyframe>\n",
                       fmt::join(velocities, " "));
  }

  const Scene& scene_;
  LeftOut& left_out_;
  SpanningTree tree_;
  std::string out_;
};

}  // namespace

std::string mjcf_for_others(const Scene& scene, LeftOut& left_out) {
  mujoco_library::start();
  return Exporter(scene, left_out).text();
}

}  // namespace rigor::inline adapters
