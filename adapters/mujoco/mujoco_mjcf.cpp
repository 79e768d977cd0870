#include "adapters/mujoco/mujoco_mjcf.h"
#include "adapters/mujoco/mujoco_options.h"
#include "adapters/mujoco/mujoco_servos.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/engine/engine_failure.h"
#include "core/engine/option_values.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline adapters {
namespace {

std::string name_of(int body) { return fmt::format("b{}", body); }

// MuJoCo's numbers of friction: sliding along two axes, spinning, rolling twice. Contacts of three rows look at the
// first two alone; without friction one row is enough, for a coefficient of zero would be raised.
// MuJoCo raises each coefficient of a contact to this value. condim 4 adds torsional friction, and condim 6 both
// others.
constexpr double kLeastFriction = 1e-5;

void refuse_friction(const ContactLaw& law) {
  const double least =
      std::min(law.friction, law.rolling_friction > 0 ? std::min(law.rolling_friction, law.torsional_friction)
                                                      : law.torsional_friction);
  if (!law.resists_turning() || least >= kLeastFriction) return;
  throw EngineFailure(
      FailureKind::unsupported,
      fmt::format("MuJoCo's {} friction comes with {} of at least {:g} each",
                  law.rolling_friction > 0 ? "rolling" : "torsional",
                  law.rolling_friction > 0 ? "torsional and sliding friction" : "sliding friction", kLeastFriction));
}

std::string friction_of(const ContactLaw& law, bool of_a_pair) {
  refuse_friction(law);
  if (law.friction == 0) return R"(condim="1")";
  const int dimensions = law.rolling_friction > 0 ? 6 : law.torsional_friction > 0 ? 4 : 3;
  // Coefficients that the dimensions leave out have no effect.
  const double spin = dimensions > 3 ? law.torsional_friction : 0.005,
               roll = dimensions > 4 ? law.rolling_friction : 1e-4;
  return of_a_pair ? fmt::format(R"(condim="{0}" friction="{1} {1} {2} {3} {3}")", dimensions, law.friction, spin, roll)
                   : fmt::format(R"(condim="{}" friction="{} {} {}")", dimensions, law.friction, spin, roll);
}

class Writer {
 public:
  Writer(const Scene& scene, const SpanningTree& tree, const Settings& settings, const MujocoVersion& version)
      : scene_(scene), tree_(tree), settings_(settings), version_(version) {}

  std::string text() {
    add("<mujoco>\n");
    add(R"(<compiler angle="radian" balanceinertia="false" boundmass="0" boundinertia="0" autolimits="false"/>)");
    write_options();
    write_size();
    write_assets();
    add("<worldbody>\n");
    write_sites(kWorld);
    for (int i = 0; i < static_cast<int>(scene_.bodies.size()); ++i) {
      if (scene_.bodies[i].fixed) write_fixed(i);
    }
    for (const int root : tree_.roots) write_body(root);
    add("</worldbody>\n");
    write_tendons();
    write_loops();
    write_pairs();
    if (has_native_servos(scene_, settings_)) add("{}", mjcf_actuators(scene_, element_of_joint(), sign_of_joint()));
    add("</mujoco>\n");
    return std::move(out_);
  }

 private:
  template <typename... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Values>(values)...);
  }

  void write_options() {
    static const std::map<std::string, std::string> kIntegrators = {
        {"euler", "Euler"}, {"implicit", "implicit"}, {"implicitfast", "implicitfast"}, {"rk4", "RK4"}};
    add(R"(<option gravity="{}" integrator="{}")", mjcf_text(scene_.gravity), kIntegrators.at(settings_.method));
    const bool matched = settings_.track == Track::matched;
    if (const auto cone = word_to_set(settings_, kMujocoCone)) add(R"( cone="{}")", *cone);
    if (matched) add(R"( solver="Newton" tolerance="{:g}")", version_.tolerance);
    for (const OptionInfo& option : {kMujocoIterations, kMujocoImpratio}) {
      if (const auto number = number_to_set(settings_, option)) add(R"( {}="{}")", option.name, *number);
    }
    // As shipped, bodies that share a joint never touch. Here the scene alone says which pairs do. A box that rests on
    // a height field rocks and even jumps with MuJoCo 3's own detector: with that of MuJoCo 2.2 it rests to 1e-6 m/s.
    const bool leaves_native = matched && version_.has_native_collisions && has_heights();
    add("><flag filterparent=\"disable\"{}/></option>\n", leaves_native ? R"( nativeccd="disable")" : "");
  }

  bool has_heights() const {
    return std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const Body& body) {
      return body.collides && std::holds_alternative<Heightfield>(*body.shape);
    });
  }

  // The memory for contacts and constraints is set once. In a heap a shape touches at most a dozen others, with up to
  // eight points between boxes. More than fits is a solver warning.
  void write_size() {
    std::size_t shapes = 0;
    for (const Body& body : scene_.bodies) {
      if (body.collides) for_each_part(*body.shape, [&](const Shape&, const BodyPose&) { ++shapes; });
    }
    // A pyramid has twice as many edges as the contact has tangential directions: two, or five with condim 6. MuJoCo
    // allots a dense matrix of so many rows, which is why a pile of 216 balls gets no more than it needs.
    const bool resists = any_law(scene_, [](const ContactLaw& law) { return law.resists_turning(); });
    const std::size_t rows = resists ? 10 : 4;
    // Its memory grows with the square of all rows, too. With 20,000 a hundred quadrupeds were refused, with these not.
    constexpr std::size_t kMostRows = 12'000;
    const std::size_t of_joints = 7 * scene_.joints.size(), left = kMostRows - std::min(kMostRows, of_joints);
    const std::size_t contacts = std::max<std::size_t>(100, std::min(12 * shapes, left / rows));
    add("<size nconmax=\"{}\" njmax=\"{}\"/>\n", contacts, rows * contacts + of_joints);
  }

  void write_assets() {
    add("<asset>\n");
    for (int i = 0; i < static_cast<int>(scene_.bodies.size()); ++i) {
      const Body& body = scene_.bodies[i];
      int part = 0;
      if (!body.collides) continue;
      for_each_part(*body.shape, [&](const Shape& shape, const BodyPose&) {
        add("{}", mjcf_asset(shape, mjcf_geom_name(i, part++)));
      });
    }
    add("</asset>\n");
  }

  void write_fixed(int index) {
    const Body& body = scene_.bodies[index];
    const bool is_plane = body.shape && std::holds_alternative<Plane>(*body.shape);
    // A plane is given in W. An exclusion names bodies, so a plane that is kept apart belongs to its own body.
    if (is_plane && !is_kept_apart(index)) write_geom(index);
    add(R"(<body name="{}" pos="{}" quat="{}">)", name_of(index), mjcf_text(body.position),
        mjcf_text(body.orientation));
    if (!is_plane || is_kept_apart(index)) write_geom(index);
    write_sites(index);
    add("</body>\n");
  }

  bool is_kept_apart(int body) const {
    return std::any_of(scene_.contact_pairs.begin(), scene_.contact_pairs.end(), [=](const ContactPair& pair) {
      return !pair.law.collides && (pair.a == body || pair.b == body);
    });
  }

  void write_body(int index, int depth = 1) {
    if (depth > kDeepestBody) {
      throw EngineFailure(FailureKind::unsupported,
                          fmt::format("body '{}' hangs on {} others, and MuJoCo's reader of scenes goes no deeper",
                                      scene_.bodies[index].name, kDeepestBody));
    }
    const Body& body = scene_.bodies[index];
    const SpanningTree::Link& link = tree_.links[index];
    const BodyPose parent = scene_.pose(link.parent);
    add(R"(<body name="{}" pos="{}" quat="{}">)", name_of(index),
        mjcf_text(parent.orientation.conjugate() * (body.position - parent.position)),
        mjcf_text((parent.orientation.conjugate() * body.orientation).normalized()));
    const Mat3& I = body.inertia;
    add(R"(<inertial pos="0 0 0" mass="{}" fullinertia="{} {} {} {} {} {}"/>)", body.mass, I(0, 0), I(1, 1), I(2, 2),
        I(0, 1), I(0, 2), I(1, 2));
    if (link.joint < 0) {
      add("<freejoint/>");
    } else {
      write_joint(index, link.joint);
    }
    write_geom(index);
    write_sites(index);
    for (const int below : tree_.below[index]) write_body(below, depth + 1);
    add("</body>\n");
  }

  void write_geom(int index) {
    const Body& body = scene_.bodies[index];
    if (!body.collides) return;
    Shape whole = *body.shape;
    auto* plane = std::get_if<Plane>(&whole);
    if (plane && is_kept_apart(index)) plane->offset -= plane->normal.dot(body.position);  // in the body's frame
    int part = 0;
    for_each_part(whole, [&](const Shape& shape, const BodyPose& pose) {
      const std::string name = mjcf_geom_name(index, part++), geom = mjcf_shape(shape, name);
      if (geom.empty()) return;  // nothing that it could touch
      const bool is_placed = std::holds_alternative<Compound>(whole);
      add(R"(<geom name="{}" {}{} {}/>)", name, geom, is_placed ? mjcf_pose(pose) : "",
          friction_of(scene_.contact_default, false));
    });
  }

  int parts_of(int body) const {
    const auto* compound = std::get_if<Compound>(&*scene_.bodies[body].shape);
    return compound ? static_cast<int>(compound->parts.size()) : 1;
  }

  // The points of springs and distance joints.
  void write_sites(int body) {
    const auto site = [&](const std::string& name, const Vec3& point) {
      add(R"(<site name="{}" pos="{}"/>)", name, mjcf_text(point));
    };
    for (std::size_t k = 0; k < scene_.springs.size(); ++k) {
      const Spring& spring = scene_.springs[k];
      if (spring.a == body) site(fmt::format("s{}a", k), spring.point_a);
      if (spring.b == body) site(fmt::format("s{}b", k), spring.point_b);
    }
    for (std::size_t k = 0; k < scene_.joints.size(); ++k) {
      const auto* distance = std::get_if<DistanceJoint>(&scene_.joints[k].type);
      if (distance && scene_.joints[k].a == body) site(fmt::format("d{}a", k), distance->point_a);
      if (distance && scene_.joints[k].b == body) site(fmt::format("d{}b", k), distance->point_b);
    }
  }

  Vec3 point_in(int body, const Vec3& point_W) const {
    const BodyPose pose = scene_.pose(body);
    return pose.orientation.conjugate() * (point_W - pose.position);
  }
  Vec3 direction_in(int body, const Vec3& direction_W) const {
    return scene_.pose(body).orientation.conjugate() * direction_W;
  }

  void write_joint(int body, int index) {
    const double sign = scene_.joints[index].b == body ? 1 : -1;
    const std::vector<MjcfJoint> rows = mjcf_joints(scene_, index, body);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const MjcfJoint& row = rows[k];
      const bool is_one_of_several = rows.size() > 1 && row.coordinate < 0;
      add(R"(<joint name="{}" type="{}" pos="{}")",
          row.coordinate >= 0 ? fmt::format("j{}", row.coordinate)
                              : element_name(index, is_one_of_several ? k : kOnlyElement),
          row.type, mjcf_text(row.point ? point_in(body, *row.point) : Vec3::Zero().eval()));
      if (row.axis) add(R"( axis="{}")", mjcf_text(direction_in(body, *row.axis)));
      if (row.coordinate >= 0) {
        const Joint& joint = scene_.joints[row.coordinate];
        add(R"( stiffness="{}" springref="{}" damping="{}" armature="{}" frictionloss="{}"{})", joint.stiffness,
            sign * joint.rest, joint.damping, joint.armature, mjcf_frictionloss(scene_, row.coordinate),
            limits_of(joint, sign));
      }
      add("/>");
    }
  }

  static constexpr std::size_t kOnlyElement = 3;
  static std::string element_name(int joint, std::size_t element) {
    static constexpr const char* kEnds[] = {"x", "y", "z", ""};
    return fmt::format("j{}{}", joint, kEnds[element]);
  }

  // MuJoCo's coordinates count whole turns, as the scene's limits do.
  static std::string limits_of(const Joint& joint, double sign) {
    if (!joint.has_limits()) return "";
    constexpr double kNone = 1e10;  // rad, m: no motion gets there that MuJoCo would not give up
    const double low = sign > 0 ? joint.lower : -joint.upper, high = sign > 0 ? joint.upper : -joint.lower;
    return fmt::format(R"( limited="true" range="{} {}")", std::max(low, -kNone), std::min(high, kNone));
  }

  void write_tendons() {
    add("<tendon>\n");
    for (std::size_t k = 0; k < scene_.springs.size(); ++k) {
      const Spring& spring = scene_.springs[k];
      add(R"(<spatial stiffness="{}" damping="{}" springlength="{}"><site site="s{}a"/><site site="s{}b"/></spatial>)",
          spring.stiffness, spring.damping, spring.rest_length, k, k);
    }
    for (const int k : tree_.loops) {
      if (std::holds_alternative<DistanceJoint>(scene_.joints[k].type))
        add(R"(<spatial name="d{0}"><site site="d{0}a"/><site site="d{0}b"/></spatial>)", k);
    }
    const std::vector<MjcfCoupling> rows = couplings();
    for (std::size_t k = 0; k < rows.size(); ++k) add("{}", rows[k].tendon(k));
    if (has_native_servos(scene_, settings_))
      add("{}", mjcf_servo_tendons(scene_, element_of_joint(), sign_of_joint()));
    add("\n</tendon>\n");
  }

  static std::function<std::string(int)> element_of_joint() {
    return [](int joint) { return element_name(joint, kOnlyElement); };
  }
  // -1 where MuJoCo's coordinate counts against the scene's.
  std::function<double(int)> sign_of_joint() const {
    return [this](int joint) { return scene_.joints[joint].b == body_on(scene_, tree_, joint) ? 1.0 : -1.0; };
  }

  void write_loops() {
    add("<equality>\n");
    for (const int k : tree_.loops) write_loop(k);
    for (const Coupling& coupling : scene_.couplings)
      if (is_of_a_loop(scene_, tree_, coupling)) refuse(coupling.joint);
    const std::vector<MjcfCoupling> rows = couplings();
    for (std::size_t k = 0; k < rows.size(); ++k) add("{}", rows[k].equality(k));
    add("</equality>\n");
  }
  std::vector<MjcfCoupling> couplings() const { return mjcf_couplings(scene_, tree_, element_name, sign_of_joint()); }

  // An equality has no coordinate that a spring, a damper or a motor could act on.
  void refuse_drive(int index) const {
    const Joint& joint = scene_.joints[index];
    const bool has_motor = std::any_of(scene_.motors.begin(), scene_.motors.end(),
                                       [&](const Motor& motor) { return motor.drives(index); });
    if (joint.stiffness == 0 && joint.damping == 0 && joint.armature == 0 && !has_motor && !joint.has_limits()) return;
    refuse(index);
  }
  [[noreturn]] void refuse(int index) const {
    throw EngineFailure(
        FailureKind::unsupported,
        fmt::format(
            "{} closes a loop of joints, where MuJoCo has no spring, damper, limit, motor, armature or coupling",
            scene_.joint_name(static_cast<std::size_t>(index))));
  }

  void write_loop(int index) {
    const Joint& joint = scene_.joints[index];
    refuse_drive(index);
    const bool moves = joint.a != kWorld;  // an equality's first body is not the world
    const int first = moves ? joint.a : joint.b, second = moves ? joint.b : kWorld;
    const std::string other = second == kWorld ? "" : fmt::format(R"( body2="{}")", name_of(second));
    const MjcfLoop loop = mjcf_loop(joint);
    if (loop.equality == MjcfLoop::Equality::none)
      throw EngineFailure(
          FailureKind::unsupported,
          fmt::format("{} closes a loop of joints, which MuJoCo closes by balls, hinges, fixed and distance "
                      "joints alone",
                      scene_.joint_name(static_cast<std::size_t>(index))));
    if (loop.equality == MjcfLoop::Equality::tendon) add("<tendon tendon1=\"d{}\"/>\n", index);
    if (loop.equality == MjcfLoop::Equality::weld) add("<weld body1=\"{}\"{}/>\n", name_of(first), other);
    for (const Vec3& point : loop.points)
      add("<connect body1=\"{}\"{} anchor=\"{}\"/>\n", name_of(first), other, mjcf_text(point_in(first, point)));
  }

  void write_pairs() {
    add("<contact>\n");
    for (const ContactPair& pair : scene_.contact_pairs) {
      const Body &a = scene_.bodies[pair.a], &b = scene_.bodies[pair.b];
      if (!can_meet(a, b)) continue;
      if (!pair.law.collides) {
        add("<exclude body1=\"{}\" body2=\"{}\"/>\n", name_of(pair.a), name_of(pair.b));
        continue;
      }
      for (int part_a = 0; part_a < parts_of(pair.a); ++part_a) {
        for (int part_b = 0; part_b < parts_of(pair.b); ++part_b)
          add("<pair geom1=\"{}\" geom2=\"{}\" {}/>\n", mjcf_geom_name(pair.a, part_a), mjcf_geom_name(pair.b, part_b),
              friction_of(pair.law, true));
      }
    }
    add("</contact>\n");
  }

  const Scene& scene_;
  const SpanningTree& tree_;
  const Settings& settings_;
  const MujocoVersion& version_;
  std::string out_;
};

}  // namespace

std::string mujoco_mjcf(const Scene& scene, const SpanningTree& tree, const Settings& settings,
                        const MujocoVersion& version) {
  return Writer(scene, tree, settings, version).text();
}

}  // namespace rigor::inline adapters
