#include "core/scene/toml/writing/scene_writer.h"

#include <bit>
#include <boost/test/unit_test.hpp>
#include <cstdint>

#include "cases/case/suite.h"
#include "tests/cases/vocabulary.h"
#include "tests/core/scene/scene_of.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_toml_writing_scene_writer)

namespace {

// Every number of a scene by its bits, every name and index, in one list: two scenes are the same if theirs are. It is
// made from the fields themselves, not from what the writer writes.
class Fields {
 public:
  explicit Fields(const Scene& scene) {
    add(scene.gravity), add(scene.contact_default);
    for (const Body& body : scene.bodies) add(body);
    for (const Spring& s : scene.springs) {
      add("spring"), add(s.a), add(s.b), add(s.point_a), add(s.point_b);
      add(s.stiffness), add(s.damping), add(s.rest_length), add(s.quadratic_stiffness);
    }
    for (const Joint& joint : scene.joints) add(joint);
    for (const Coupling& c : scene.couplings) add("coupling"), add(c.joint), add(c.to), add(c.offset);
    for (const Motor& m : scene.motors) {
      add("motor"), add(m.joint), add(m.effort), add(m.speed.has_value()), add(m.speed.value_or(0));
      add(m.most), add(m.from), add(m.until), add(m.plus);
      if (!m.servo) continue;
      add(m.servo->kp), add(m.servo->kd), add(m.servo->target_speed), add(m.servo->most), add(m.servo->period);
    }
    for (const ContactPair& pair : scene.contact_pairs) add("contact"), add(pair.a), add(pair.b), add(pair.law);
    for (const TimedForce& f : scene.forces) {
      add("force"), add(f.body), add(f.force), add(f.torque), add(f.point), add(f.from), add(f.until);
    }
  }
  const std::vector<std::string>& all() const { return all_; }

 private:
  void add(const std::string& text) { all_.push_back(text); }
  void add(const char* text) { all_.emplace_back(text); }
  void add(double number) { all_.push_back(std::to_string(std::bit_cast<std::uint64_t>(number))); }
  void add(int number) { all_.push_back(std::to_string(number)); }
  void add(bool flag) { all_.emplace_back(flag ? "yes" : "no"); }
  void add(const std::vector<JointTerm>& terms) {
    for (const JointTerm& term : terms) add("term"), add(term.joint), add(term.ratio);
  }
  void add(const Vec3& v) { add(v.x()), add(v.y()), add(v.z()); }
  void add(const ContactLaw& law) {
    add(law.restitution), add(law.friction), add(law.collides), add(law.rolling_friction), add(law.torsional_friction);
    add(law.stiffness), add(law.damping), add(law.static_friction);
  }
  void add(const Body& body) {
    add(body.name), add(body.mass), add(body.position), add(body.orientation.vec()), add(body.orientation.w());
    add(body.velocity), add(body.angular_velocity), add(body.collides), add(body.fixed);
    for (int k = 0; k < 9; ++k) add(body.inertia(k / 3, k % 3));
    if (!body.shape) return;
    add(*body.shape);
  }
  void add(const Shape& shape) {
    add(shape_name(shape));
    std::visit(
        ForShapes{[&](const Box& s) { add(s.size); }, [&](const Capsule& s) { add(s.radius), add(s.length); },
                  [&](const Compound& s) {
                    for (const PlacedShape& part : s.parts) {
                      add(part.shape), add(part.pose.position);
                      add(part.pose.orientation.vec()), add(part.pose.orientation.w());
                    }
                  },
                  [&](const Convex& s) {
                    for (const Vec3& point : s.hull->points) add(point);
                  },
                  [&](const Cylinder& s) { add(s.radius), add(s.length); }, [&](const Ellipsoid& s) { add(s.radii); },
                  [&](const SurfaceShape& s) {
                    for (const Vec3& point : s.surface->points) add(point);
                    for (const auto& triangle : s.surface->triangles)
                      for (const int corner : triangle.corners) add(corner);
                  },
                  [&](const Plane& s) { add(s.normal), add(s.offset); }, [&](const Sphere& s) { add(s.radius); }},
        shape);
  }
  void add(const std::vector<SeriesAxis>& axes) {
    for (const SeriesAxis& axis : axes) add(axis.turns), add(axis.anchor), add(axis.axis);
  }
  void add(const Joint& joint) {
    add(joint_type_name(joint)), add(joint.name), add(joint.a), add(joint.b);
    add(joint.stiffness), add(joint.damping), add(joint.rest), add(joint.quadratic_stiffness);
    add(joint.lower), add(joint.upper), add(joint.restitution), add(joint.armature);
    if (const auto* ball = std::get_if<BallJoint>(&joint.type)) add(ball->anchor);
    if (const auto* cylinder = std::get_if<CylindricalJoint>(&joint.type)) add(cylinder->anchor), add(cylinder->axis);
    if (const auto* plane = std::get_if<PlanarJoint>(&joint.type)) add(plane->anchor), add(plane->normal);
    if (const auto* screw = std::get_if<ScrewJoint>(&joint.type))
      add(screw->anchor), add(screw->axis), add(screw->pitch);
    if (const auto* compound = std::get_if<CompoundJoint>(&joint.type)) add(compound->axes);
    if (const auto* axis = std::get_if<CompoundAxis>(&joint.type)) add(axis->axes), add(static_cast<int>(axis->index));
    if (const auto* hinge = std::get_if<HingeJoint>(&joint.type)) add(hinge->anchor), add(hinge->axis);
    if (const auto* slider = std::get_if<SliderJoint>(&joint.type)) add(slider->axis);
    if (const auto* rod = std::get_if<DistanceJoint>(&joint.type)) add(rod->point_a), add(rod->point_b);
    if (const auto* cross = std::get_if<UniversalJoint>(&joint.type))
      add(cross->anchor), add(cross->axis), add(cross->axis2);
  }

  std::vector<std::string> all_;
};

// A line of JSON is a TOML inline table once its keys are.
std::string inline_table(const std::string& json) {
  std::string text = "scene = ";
  for (std::size_t at = 0; at < json.size();) {
    const std::size_t end = json[at] == '"' ? json.find('"', at + 1) : std::string::npos;
    const bool is_key = end != std::string::npos && end + 1 < json.size() && json[end + 1] == ':' &&
                        json.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789", at + 1) == end;
    text += is_key ? json.substr(at + 1, end - at - 1) + " = " : std::string(1, json[at]);
    at = is_key ? end + 2 : at + 1;
  }
  return text;
}

void check_is_read_back(const Scene& scene) {
  const auto fields = Fields(scene).all();
  BOOST_TEST(Fields(scene_of(scene_toml(scene))).all() == fields, boost::test_tools::per_element());
  BOOST_TEST(Fields(scene_of(inline_table(scene_json(scene)))).all() == fields, boost::test_tools::per_element());
}

// One of everything, and nothing at its default.
const std::string kEverything = R"(
[scene]
gravity = [0.1, -9.8, 1e-300]
contact_default = { restitution = 0.3, friction = "infinite" }
[[scene.body]]
name = "ground"
shape = { type = "plane", normal = [0.1, 0.2, 3], offset = -0.1 }
[[scene.body]]
name = "a \"quoted\" name, \\ and ü"
mass = 0.1
inertia = [0.3, 0.4, 0.5, 0.01, -0.02, 0.03]
position = [1, 2, 3]
orientation_wxyz = [0.1, 0.2, 0.3, 0.4]
velocity = [0.1, 0.2, 0.3]
shape = { type = "box", size = [0.1, 0.2, 0.3] }
[[scene.body]]
name = "ball"
mass = 3
position = [5, 0, 1]
angular_velocity = [0, 0, 7e-5]
shape = { type = "sphere", radius = 0.7 }
collides = false
[[scene.body]]
name = "post"
fixed = true
shape = { type = "capsule", radius = 0.1, length = 0.9 }
[[scene.body]]
name = "rod"
mass = 2
inertia = [1, 1, 1]
[[scene.spring]]
a = "world"
b = "ball"
point_a = [0.1, 0.2, 0.3]
point_b = [0, 0, 0.1]
stiffness = 1e4
quadratic_stiffness = 3e3
damping = 0.1
[[scene.joint]]
type = "hinge"
name = "door"
a = "post"
b = "rod"
anchor = [0, 0, 0]
axis = [1, 2, 2.5]
stiffness = 0.2
quadratic_stiffness = 0.4
damping = 0.1
rest = 0.7
lower = -1.1
upper = 2.2
restitution = 0.5
[[scene.joint]]
type = "slider"
name = "drawer"
a = "world"
b = "rod"
axis = [0.3, 0.4, 0.1]
[[scene.joint]]
type = "distance"
a = "ball"
b = "rod"
point_a = [0, 0, 0.1]
point_b = [0.1, 0, 0]
[[scene.joint]]
type = "fixed"
a = "ball"
b = "world"
[[scene.joint]]
type = "planar"
a = "world"
b = "rod"
anchor = [0.1, 0, 0.2]
normal = [0.3, 0.4, 0.1]
[[scene.joint]]
type = "screw"
a = "world"
b = "rod"
anchor = [0.1, 0, 0.2]
axis = [0.3, 0.4, 0.1]
pitch = -0.3
[[scene.joint]]
type = "compound"
name = "hip"
a = "post"
b = "rod"
axes = [
  { type = "slider", name = "hip x", axis = [0.3, 0.4, 0.1], stiffness = 3, rest = 0.2, armature = 0.7 },
  { type = "hinge", anchor = [0.1, 0, 0.2], axis = [0.1, 0.4, 0.1], lower = -0.3, friction = 0.1 },
]
[[scene.coupling]]
joint = "drawer"
to = ["door", "hip x"]
ratio = [-0.05, 0.3]
[[scene.motor]]
joint = "door"
speed = 0.3
most = 2
from = 0.5
[[scene.motor]]
joint = "drawer"
force = -0.3
until = 2.5
[[scene.motor]]
joint = "drawer"
plus = ["hip x", "door"]
ratio = [0.4, -0.2]
kp = 11
kd = 0.7
target = 0.1
target_speed = 0.6
[[scene.contact]]
a = "ground"
b = "ball"
friction = 0.4
static_friction = 0.5
rolling_friction = 0.02
torsional_friction = 0.003
[[scene.force]]
body = "ball"
force = [0.1, 0, 0]
point = [0, 0.1, 0]
from = 0.25
)";

}  // namespace

BOOST_AUTO_TEST_CASE(every_case_of_the_suite_is_read_back_to_the_bit) {
  for (const Case& c : select_cases({}, default_suite_dir(), test::words())) {
    BOOST_TEST_CONTEXT(c.id) check_is_read_back(c.scene);
  }
}

BOOST_AUTO_TEST_CASE(nothing_that_a_scene_can_say_is_lost) {
  const TomlFile file = TomlFile::parse(kEverything, "s.toml");
  const Scene scene = read_scene(file.root({"scene"}).at("scene"), InitialVelocities::as_given);
  BOOST_TEST_REQUIRE(scene.motors.size() == 4u);  // with the friction of the compound joint
  const auto fields = Fields(scene).all();
  for (const std::string& text : {scene_toml(scene), inline_table(scene_json(scene))}) {
    const TomlFile again = TomlFile::parse(text, "s.toml");
    const Scene read = read_scene(again.root({"scene"}).at("scene"), InitialVelocities::as_given);
    BOOST_TEST(Fields(read).all() == fields, boost::test_tools::per_element());
  }
}

// Joined bodies come as one line of TOML; an engine from outside gets a row for each pair.
BOOST_AUTO_TEST_CASE(pairs_that_never_touch_are_read_back) {
  Scene scene = scene_of(R"(
[scene]
self_contact = false
[[scene.body]]
name = "a"
mass = 1
shape = { type = "sphere", radius = 1 }
[[scene.body]]
name = "b"
mass = 1
shape = { type = "sphere", radius = 1 }
[[scene.body]]
name = "floor"
shape = { type = "plane", normal = [0, 0, 1], offset = -3 }
[[scene.joint]]
type = "ball"
a = "a"
b = "b"
anchor = [0, 0, 0]
)");
  BOOST_TEST_REQUIRE(scene.contact_pairs.size() == 1u);
  check_is_read_back(scene);
  BOOST_TEST(scene_toml(scene).find("self_contact = false") != std::string::npos);
  BOOST_TEST(scene_toml(scene).find("[[scene.contact]]") == std::string::npos);
  BOOST_TEST(scene_json(scene).find(R"("collides":false)") != std::string::npos);
  scene.contact_pairs = {{1, 2, kApart}};  // not the joined pair
  check_is_read_back(scene);
  BOOST_TEST(scene_toml(scene).find("self_contact") == std::string::npos);
  BOOST_TEST(scene_toml(scene).find("[[scene.contact]]") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(defaults_are_written_out) {
  const std::string json = scene_json(scene_of("scene.body = [{ name = 'a', mass = 1, inertia = [1, 1, 1] }]"));
  BOOST_TEST(json ==
             R"({"gravity":[0.0,0.0,0.0],"contact_default":{"restitution":0.0,"friction":0.0},"body":[{"name":"a",)"
             R"("mass":1.0,"inertia":[1.0,1.0,1.0,0.0,0.0,0.0],"position":[0.0,0.0,0.0],)"
             R"("orientation_wxyz":[1.0,0.0,0.0,0.0],"velocity":[0.0,0.0,0.0],"angular_velocity":[0.0,0.0,0.0],)"
             R"("collides":false,"fixed":false}]})");
}

BOOST_AUTO_TEST_SUITE_END()
