// A case's scene for other programs: what is exported and imported again is the same scene, and what a format cannot
// say is named.
#include <boost/test/unit_test.hpp>

#include "tests/cases/cli/program.h"
#include "tests/cases/import/imported.h"

using namespace rigor;
using namespace rigor::test;

namespace cases_report_scene_scene_formats {

// Everything that both formats can say.
constexpr const char* kMechanism = R"(title = "mechanism"
[scene]
gravity = [0.1, 0.2, -9.7]
[[scene.body]]
name = "frame <a & b>"
mass = 3
inertia = [0.1, 0.12, 0.05, 0.01, -0.02, 0.005]
position = [0.1, 0.2, 1.1]
orientation_wxyz = [0.9, 0.1, -0.3, 0.2]
shape = { type = "capsule", radius = 0.1, length = 0.3 }
[[scene.body]]
name = "arm"
mass = 1
inertia = [0.02, 0.03, 0.04, 0.001, 0, 0]
position = [0.6, 0.2, 1.1]
[[scene.body]]
name = "hand"
mass = 0.5
inertia = [0.002, 0.003, 0.004]
position = [1, 0.2, 1]
[[scene.body]]
name = "floor"
shape = { type = "plane", normal = [0, 0.6, 0.8], offset = -2 }
[[scene.joint]]
name = "hip"
type = "hinge"
a = "frame <a & b>"
b = "arm"
anchor = [0.3, 0.2, 1.1]
axis = [0, 1, 0.1]
stiffness = 5
damping = 0.3
rest = 0.2
lower = -1
upper = 2
[[scene.joint]]
name = "wrist"
type = "universal"
a = "arm"
b = "hand"
anchor = [0.8, 0.2, 1.05]
axis = [1, 0, 0]
axis2 = [0, 1, 0]
[scene.contact_default]
friction = 0.7
[run]
duration = 1
dt = ["1/100"]
)";

double apart(const Vec3& a, const Vec3& b) { return (a - b).norm(); }

}  // namespace cases_report_scene_scene_formats

BOOST_FIXTURE_TEST_SUITE(cases_report_scene_scene_formats, Program)

BOOST_AUTO_TEST_CASE(sdf_comes_back_as_the_same_scene) {
  folder.write("m.toml", kMechanism);
  const Answer answer = run({"export", "m.toml", "--format", "sdf"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  BOOST_TEST(answer.err == "");
  const Scene scene = read_case(path("m.toml"), "m", words()).scene, again = scene_of_text("m.sdf", answer.out);
  BOOST_TEST_REQUIRE(again.bodies.size() == 4u);
  BOOST_TEST(apart(scene.gravity, again.gravity) == 0);
  for (const char* name : {"frame <a & b>", "arm", "hand"}) {
    const Body &a = body_named(scene, name), &b = body_named(again, std::string("bodies::") + name);
    BOOST_TEST(apart(a.position, b.position) < 1e-14);
    BOOST_TEST(angle_between(a.orientation, b.orientation) < 1e-14);
    BOOST_TEST((a.inertia - b.inertia).cwiseAbs().maxCoeff() < 1e-14);
    BOOST_TEST(a.mass == b.mass);
    BOOST_TEST(a.collides == b.collides);
  }
  const Joint &a = joint_named(scene, "hip"), &b = joint_named(again, "bodies::hip");
  BOOST_TEST(apart(std::get<HingeJoint>(a.type).anchor, std::get<HingeJoint>(b.type).anchor) < 1e-14);
  BOOST_TEST(apart(std::get<HingeJoint>(a.type).axis, std::get<HingeJoint>(b.type).axis) < 1e-14);
  BOOST_TEST((a.stiffness == b.stiffness && a.damping == b.damping && a.rest == b.rest && a.lower == b.lower &&
              a.upper == b.upper));
  BOOST_TEST(std::abs(std::get<Plane>(*body_named(again, "floor::link").shape).offset + 2) < 1e-14);
  BOOST_TEST(again.contact_default.friction == 0.7);
}

BOOST_AUTO_TEST_CASE(what_a_format_cannot_say_is_named_and_bad_usage_refused) {
  const Answer springs = run({"export", "springs/fixed-spring", "--format", "sdf"});
  BOOST_TEST(springs.code == 0);
  BOOST_TEST(
      springs.err.find("left out: a spring between 'world' and 'cube': it: SDF has no springs") != std::string::npos,
      springs.err);
  for (const char* format : {"sdf", "mjcf"}) {
    const Answer sticks = run({"export", "forces-of-contact/brick-sticks", "--format", format});
    BOOST_TEST(sticks.err.find("static friction") != std::string::npos, sticks.err);
    const Answer hills = run({"export", "surfaces/hills", "--format", format});
    BOOST_TEST(hills.err.find("heightfield") != std::string::npos, hills.err);
    BOOST_TEST(hills.out.find("geom name=\"hills\"") == std::string::npos);
  }
  BOOST_TEST(run({"export", "springs/fixed-spring"}).code == 2);
  BOOST_TEST(run({"export", "springs/fixed-spring", "--format", "urdf"}).code == 2);
  BOOST_TEST(run({"export", "--format", "sdf"}).code == 2);
}

BOOST_AUTO_TEST_SUITE_END()
