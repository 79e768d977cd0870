#include "core/scene/toml/scene_reader.h"

#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <ctime>

#include "tests/core/scene/scene_of.h"
#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_toml_scene_reader)

namespace {

// Lines 1 to 8: two bodies that can move, and the ground. What a row adds begins on line 9.
const std::string kBodies = R"([scene]
gravity = [0, -9.8, 0]
body = [
  { name = "cube", mass = 1, inertia = [1, 1, 1] },
  { name = "ball", mass = 2, position = [3, 0, 0], shape = { type = "sphere", radius = 0.1 } },
  { name = "ground", shape = { type = "plane", normal = [0, 2, 0], offset = 0.5 } },
  { name = "post", fixed = true },
]
)";

const std::vector<Refusal> kBadScenes = {
    {"scene = 1", "1:9: scene: ", {"found 1", "a table with the keys gravity, body"}},
    {"[scene]", "1:1: scene: ", {"there is no [[scene.body]]"}},
    {"[scene]\nbody = []", "1:1: scene: ", {"there is no [[scene.body]]"}},
    {"[scene.body]\nname = 'a'", "1:1: scene.body: ", {"found a table", "[[scene.body]]"}},
    {"[scene]\ngravty = [0, 0, 0]", "2:1: scene.gravty: unknown key", {"'gravity'"}},
    {"[scene]\ngravity = -9.8", "2:11: scene.gravity: ", {"found -9.8", "3 numbers"}},
};

// Each begins on line 9, below kBodies.
const std::vector<Refusal> kBadRelations = {
    // Springs.
    {"[[scene.spring]]\nb = 'cube'\nstiffness = 1", "9:1: scene.spring.a: missing", {}},
    {"[[scene.spring]]\na = 'world'\nb = 'cubee'\nstiffness = 1",
     "11:5: scene.spring.b: there is no body 'cubee'",
     {"did you mean 'cube'?", "there is: ball, cube, ground, post, world"}},
    {"[[scene.spring]]\na = 1\nb = 'cube'\nstiffness = 1", "10:5: scene.spring.a: ", {"found 1", "a string"}},
    {"[[scene.spring]]\na = 'world'\nb = 'world'\nstiffness = 1", "11:5: scene.spring.b: ", {"from 'world' to itself"}},
    {"[[scene.spring]]\na = 'cube'\nb = 'cube'\nstiffness = 1", "11:5: scene.spring.b: ", {"from 'cube' to itself"}},
    {"[[scene.spring]]\na = 'world'\nb = 'post'\nstiffness = 1", "11:5: scene.spring.b: ", {"neither can move"}},
    {"[[scene.spring]]\na = 'post'\nb = 'ground'\nstiffness = 1", "11:5: scene.spring.b: ", {"neither can move"}},
    {"[[scene.spring]]\na = 'world'\nb = 'cube'", "9:1: scene.spring.stiffness: missing", {}},
    {"[[scene.spring]]\na = 'world'\nb = 'cube'\nstiffness = -1",
     "12:13: scene.spring.stiffness: ",
     {"found -1", "0 or greater"}},
    {"[[scene.spring]]\na = 'world'\nb = 'cube'\nstiffness = inf", "12:13: scene.spring.stiffness: ", {"found inf"}},
    {"[[scene.spring]]\na = 'world'\nb = 'cube'\nstiffness = 1\ndamping = -1",
     "13:11: scene.spring.damping: ",
     {"found -1"}},
    {"[[scene.spring]]\na = 'world'\nb = 'cube'\nstiffness = 0\nquadratic_stiffness = 1",
     "13:23: scene.spring.quadratic_stiffness: ",
     {"adds to stiffness"}},
    {"[[scene.spring]]\na = 'world'\nb = 'cube'\nstiffness = 1\nrest_length = -1",
     "13:15: scene.spring.rest_length: ",
     {"found -1"}},
    {"[[scene.spring]]\na = 'world'\nb = 'cube'\nstifness = 1",
     "12:1: scene.spring.stifness: unknown key",
     {"'stiffness'"}},
    {"[[scene.spring]]\na = 'world'\nb = 'cube'\nstiffness = 1\npoint_a = [1, 2]",
     "13:11: scene.spring.point_a: ",
     {"3 numbers"}},
    {"[[scene.spring]]\na = 'world'\npoint_a = [1.7e308, 0, 0]\nb = 'cube'\npoint_b = [-1.7e308, 0, 0]\nstiffness = 1",
     "9:1: scene.spring: ",
     {"too large"}},
    // Joints.
    {"[[scene.joint]]\na = 'world'\nb = 'cube'", "9:1: scene.joint.type: missing", {}},
    {"[[scene.joint]]\ntype = 'hing'\na = 'world'\nb = 'cube'",
     "10:8: scene.joint.type: ",
     {"found 'hing'", "'hinge'",
      "ball, compound, cylindrical, distance, fixed, hinge, planar, screw, slider, universal"}},
    {"[[scene.joint]]\ntype = 'ball'\na = 'world'\nb = 'cube'", "9:1: scene.joint.anchor: missing", {}},
    {"[[scene.joint]]\ntype = 'ball'\na = 'world'\nb = 'cube'\nanchor = [0, 0, 0]\naxis = [1, 0, 0]",
     "14:1: scene.joint.axis: a ball joint has no such key",
     {"type, name, a, b, anchor"}},
    {"[[scene.joint]]\ntype = 'hinge'\na = 'world'\nb = 'cube'\nanchor = [0, 0, 0]\naxis = [0, 0, 0]",
     "14:8: scene.joint.axis: ",
     {"points nowhere"}},
    {"[[scene.joint]]\ntype = 'slider'\na = 'world'\nb = 'cube'\naxis = [0, 0, 0]",
     "13:8: scene.joint.axis: ",
     {"points nowhere"}},
    {"[[scene.joint]]\ntype = 'fixed'\na = 'cube'\nb = 'cube'",
     "12:5: scene.joint.b: ",
     {"a joint from 'cube' to itself"}},
    {"[[scene.joint]]\ntype = 'fixed'\na = 'post'\nb = 'world'", "12:5: scene.joint.b: ", {"neither can move"}},
    {"[[scene.joint]]\ntype = 'fixed'\na = 'cube'\nb = 'bal'",
     "12:5: scene.joint.b: there is no body 'bal'",
     {"'ball'"}},
    {"[[scene.joint]]\ntype = 'distance'\na = 'cube'\nb = 'ball'\npoint_a = [3, 0, 0]\npoint_b = [0, 0, 0]",
     "14:11: scene.joint.point_b: ",
     {"coincide"}},
    // Contacts.
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\nrestitution = 1.5",
     "12:15: scene.contact.restitution: ",
     {"found 1.5", "from 0 to 1"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\nfriction = -1",
     "12:12: scene.contact.friction: ",
     {"found -1", "or inf"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\nbounce = 1",
     "12:1: scene.contact.bounce: unknown key",
     {"allowed: a, b, collides, restitution, friction"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\ncollides = false\nfriction = 1",
     "13:12: scene.contact.friction: ",
     {"the pair never touches", "allowed: one of the two"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\ncolides = false",
     "12:1: scene.contact.colides: unknown key",
     {"'collides'"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'world'", "11:5: scene.contact.b: ", {"'world', which is no body"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'groud'", "11:5: scene.contact.b: there is no body 'groud'", {"'ground'"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ball'", "11:5: scene.contact.b: ", {"cannot touch itself"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\n[[scene.contact]]\na = 'ground'\nb = 'ball'",
     "12:1: scene.contact: ",
     {"'ground' and 'ball' is given twice"}},
    {"[scene.contact_default]\nrestitution = -0.1", "10:15: scene.contact_default.restitution: ", {"found -0.1"}},
    {"[scene.contact_default]\nfriction = 0.5\nstatic_friction = 0.4",
     "11:19: scene.contact_default.static_friction: ",
     {"found 0.4, less than the friction of 0.5"}},
    {"[scene.contact_default]\nstatic_frction = 0.4",
     "10:1: scene.contact_default.static_frction: unknown key",
     {"'static_friction'"}},
    {"[scene.contact_default]\nrolling_friction = -1", "10:20: scene.contact_default.rolling_friction: ", {"found -1"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\ntorsional_friction = inf",
     "12:22: scene.contact.torsional_friction: ",
     {"found inf"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\ndamping = 1",
     "12:11: scene.contact.damping: ",
     {"without stiffness", "allowed: stiffness, too"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\ndissipation = 1",
     "12:15: scene.contact.dissipation: ",
     {"without stiffness", "stiffness, too"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\nstiffness = 1e4\ndamping = 1\ndissipation = 1",
     "14:15: scene.contact.dissipation: ",
     {"different laws", "one of the two"}},
    {"[[scene.contact]]\na = 'ball'\nb = 'ground'\nstiffness = 1e4\nrestitution = 0.5",
     "13:15: scene.contact.restitution: ",
     {"soft contact", "allowed: one of the two"}},
    {"[scene.contact_default]\nfrictoin = 1", "10:1: scene.contact_default.frictoin: unknown key", {"'friction'"}},
    // Forces.
    {"[[scene.force]]\nforce = [1, 0, 0]", "9:1: scene.force.body: missing", {}},
    {"[[scene.force]]\nbody = 'cub'\nforce = [1, 0, 0]", "10:8: scene.force.body: there is no body 'cub'", {"'cube'"}},
    {"[[scene.force]]\nbody = 'world'\nforce = [1, 0, 0]", "10:8: scene.force.body: ", {"no body"}},
    {"[[scene.force]]\nbody = 'post'\nforce = [1, 0, 0]", "10:8: scene.force.body: ", {"fixed"}},
    {"[[scene.force]]\nbody = 'cube'", "9:1: scene.force: ", {"neither force nor torque"}},
    {"[[scene.force]]\nbody = 'cube'\nforce = [1, 0]", "11:9: scene.force.force: ", {"3 numbers"}},
    {"[[scene.force]]\nbody = 'cube'\ntorque = [nan, 0, 0]", "11:11: scene.force.torque[0]: ", {"found nan"}},
    {"[[scene.force]]\nbody = 'cube'\nforce = [1, 0, 0]\nfrom = -1", "12:8: scene.force.from: ", {"found -1"}},
    {"[[scene.force]]\nbody = 'cube'\nforce = [1, 0, 0]\nfrom = 2\nuntil = 2",
     "13:9: scene.force.until: ",
     {"found 2", "after from, which is 2 s"}},
    {"[[scene.force]]\nbody = 'cube'\nforce = [1, 0, 0]\nuntil = 0", "12:9: scene.force.until: ", {"found 0"}},
    {"[[scene.force]]\nbody = 'cube'\nforce = [1, 0, 0]\nuntil = inf", "12:9: scene.force.until: ", {"found inf"}},
    {"[[scene.force]]\nbody = 'cube'\nforce = [1, 0, 0]\nuntl = 1", "12:1: scene.force.untl: unknown key", {"'until'"}},
};

}  // namespace

BOOST_AUTO_TEST_CASE(each_scene_that_cannot_be_is_refused) {
  for (const Refusal& row : kBadScenes) check_refusal(row, "s.toml", [&] { scene_of(row.text); });
}

BOOST_AUTO_TEST_CASE(each_spring_joint_contact_and_force_that_cannot_be_is_refused) {
  BOOST_TEST(refusal_of([] { scene_of(kBodies); }) == "");
  for (const Refusal& row : kBadRelations) check_refusal(row, "s.toml", [&] { scene_of(kBodies + row.text); });
}

// The ball sits at (3, 0, 0), the cube, turned a quarter about z, at the origin.
BOOST_AUTO_TEST_CASE(springs_are_read_and_take_their_rest_length_from_the_start) {
  const Scene scene = scene_of(R"(scene.body = [
    { name = "cube", mass = 1, inertia = [1, 1, 1], orientation_wxyz = [1, 0, 0, 1] },
    { name = "ball", mass = 2, inertia = [1, 1, 1], position = [3, 0, 0] } ]
[[scene.spring]]
a = "ball"
point_a = [0, 5, 0]
b = "cube"
point_b = [1, 0, 0]
stiffness = 10
[[scene.spring]]
a = "world"
point_a = [0, 2, 0]
b = "ball"
stiffness = 0
damping = 7
rest_length = 0)");
  const Spring &first = scene.springs.at(0), &second = scene.springs.at(1);
  BOOST_TEST(first.a == 1);
  BOOST_TEST(first.b == 0);
  BOOST_TEST((first.point_a == Vec3(0, 5, 0)));
  BOOST_TEST((first.point_b == Vec3(1, 0, 0)));
  BOOST_TEST(first.stiffness == 10);
  BOOST_TEST(first.damping == 0);
  // The direction is from (3, 5, 0) to (0, 1, 0), to a few roundings of the rotation.
  BOOST_TEST(std::abs(first.rest_length - 5) < 4e-15);
  BOOST_TEST(second.a == kWorld);
  BOOST_TEST(second.b == 1);
  BOOST_TEST(second.damping == 7);
  BOOST_TEST(second.rest_length == 0);
}

BOOST_AUTO_TEST_CASE(every_joint_is_read) {
  const std::string ends = "a = 'world'\nb = 'ball'\n";
  const Scene scene =
      scene_of(kBodies + "\n[[scene.joint]]\ntype = 'ball'\nanchor = [1, 2, 3]\n" + ends +
               "[[scene.joint]]\ntype = 'hinge'\nanchor = [1, 2, 3]\naxis = [0, 0, 2]\n" + ends +
               "[[scene.joint]]\ntype = 'slider'\naxis = [0, -3, 0]\n" + ends + "[[scene.joint]]\ntype = 'fixed'\n" +
               ends + "[[scene.joint]]\ntype = 'distance'\npoint_a = [1, 0, 0]\npoint_b = [0, 1, 0]\n" + ends +
               "[[scene.joint]]\ntype = 'universal'\nanchor = [1, 2, 3]\naxis = [0, 0, 2]\naxis2 = [0, 4, 0]\n" + ends +
               "[[scene.joint]]\ntype = 'cylindrical'\nanchor = [1, 2, 3]\naxis = [0, 0, 2]\n" + ends);
  BOOST_TEST(scene.joints.size() == 7u);
  BOOST_TEST((std::get<BallJoint>(scene.joints[0].type).anchor == Vec3(1, 2, 3)));
  BOOST_TEST((std::get<HingeJoint>(scene.joints[1].type).anchor == Vec3(1, 2, 3)));
  BOOST_TEST((std::get<HingeJoint>(scene.joints[1].type).axis == Vec3(0, 0, 1)));
  BOOST_TEST((std::get<SliderJoint>(scene.joints[2].type).axis == Vec3(0, -1, 0)));
  BOOST_TEST(std::holds_alternative<FixedJoint>(scene.joints[3].type));
  BOOST_TEST((std::get<DistanceJoint>(scene.joints[4].type).point_a == Vec3(1, 0, 0)));
  BOOST_TEST((std::get<DistanceJoint>(scene.joints[4].type).point_b == Vec3(0, 1, 0)));
  BOOST_TEST((std::get<UniversalJoint>(scene.joints[5].type).axis == Vec3(0, 0, 1)));
  BOOST_TEST((std::get<UniversalJoint>(scene.joints[5].type).axis2 == Vec3(0, 1, 0)));
  BOOST_TEST((std::get<CylindricalJoint>(scene.joints[6].type).anchor == Vec3(1, 2, 3)));
  BOOST_TEST((std::get<CylindricalJoint>(scene.joints[6].type).axis == Vec3(0, 0, 1)));
  for (const Joint& joint : scene.joints) {
    BOOST_TEST(joint.a == kWorld);
    BOOST_TEST(joint.b == 1);
  }
}

BOOST_AUTO_TEST_CASE(a_contact_that_leaves_a_value_out_takes_the_default_one) {
  const Scene scene = scene_of(kBodies + R"(
[[scene.contact]]
a = "ball"
b = "ground"
friction = inf
[[scene.contact]]
a = "ball"
b = "cube"
restitution = 1
friction = "infinite"
[[scene.contact]]
a = "cube"
b = "ground"
rolling_friction = 0.02
[scene.contact_default]
restitution = 0.25
friction = 0.5
rolling_friction = 0.01
torsional_friction = 0.003)");
  BOOST_TEST(scene.contact_law(2, 1).rolling_friction == 0.01);
  BOOST_TEST(scene.contact_law(0, 2).rolling_friction == 0.02);
  BOOST_TEST(scene.contact_law(0, 2).torsional_friction == 0.003);
  BOOST_TEST(scene.contact_default.restitution == 0.25);
  BOOST_TEST(scene.contact_law(2, 1).restitution == 0.25);
  BOOST_TEST(scene.contact_law(2, 1).friction == kInfiniteFriction);
  BOOST_TEST(scene.contact_law(0, 1).restitution == 1);
  BOOST_TEST(scene.contact_law(0, 1).friction == kInfiniteFriction);
  BOOST_TEST(scene.contact_law(0, 2).friction == 0.5);
}

BOOST_AUTO_TEST_CASE(a_pair_may_be_kept_from_touching) {
  const Scene scene = scene_of(kBodies + R"(
[[scene.contact]]
a = "ball"
b = "ground"
collides = false
[[scene.contact]]
a = "ball"
b = "cube"
collides = true
friction = 0.5)");
  BOOST_TEST(!scene.contact_law(2, 1).collides);
  BOOST_TEST((scene.contact_law(0, 1).collides && scene.contact_law(0, 1).friction == 0.5));
  BOOST_TEST(scene.contact_law(0, 2).collides);
}

// Three boxes in a row, joined one to the next: a row of [[scene.contact]] says more than self_contact does.
BOOST_AUTO_TEST_CASE(without_self_contact_joined_bodies_never_touch) {
  std::string text;
  for (const char* name : {"a", "b", "c"})
    text += std::string("[[scene.body]]\nname = '") + name + "'\nmass = 1\nshape = {type = 'sphere', radius = 1}\n";
  text += "[[scene.joint]]\ntype = 'ball'\na = 'a'\nb = 'b'\nanchor = [0, 0, 0]\n";
  text += "[[scene.joint]]\ntype = 'ball'\na = 'c'\nb = 'b'\nanchor = [0, 0, 0]\n";
  text += "[[scene.joint]]\ntype = 'ball'\na = 'world'\nb = 'b'\nanchor = [0, 0, 0]\n";
  const auto collide = [&](const std::string& head) {
    const Scene scene = scene_of(head + text);
    return std::vector<bool>{scene.contact_law(0, 1).collides, scene.contact_law(1, 2).collides,
                             scene.contact_law(0, 2).collides};
  };
  BOOST_TEST((collide("[scene]\n") == std::vector<bool>{true, true, true}));
  BOOST_TEST((collide("[scene]\nself_contact = true\n") == std::vector<bool>{true, true, true}));
  BOOST_TEST((collide("[scene]\nself_contact = false\n") == std::vector<bool>{false, false, true}));
  text += "[[scene.contact]]\na = 'b'\nb = 'a'\nfriction = 0.5\n";
  BOOST_TEST((collide("[scene]\nself_contact = false\n") == std::vector<bool>{true, false, true}));
}

BOOST_AUTO_TEST_CASE(forces_are_read_and_last_for_ever_unless_told) {
  const Scene scene = scene_of(kBodies + R"(
[[scene.force]]
body = "cube"
force = [1, 2, 3]
[[scene.force]]
body = "ball"
torque = [4, 5, 6]
point = [7, 8, 9]
from = 1
until = 2.5)");
  const TimedForce &first = scene.forces.at(0), &second = scene.forces.at(1);
  BOOST_TEST(first.body == 0);
  BOOST_TEST((first.force == Vec3(1, 2, 3)));
  BOOST_TEST((first.torque == Vec3::Zero()));
  BOOST_TEST(first.from == 0);
  BOOST_TEST(first.until == std::numeric_limits<double>::infinity());
  BOOST_TEST(second.body == 1);
  BOOST_TEST((second.torque == Vec3(4, 5, 6)));
  BOOST_TEST((second.point == Vec3(7, 8, 9)));
  BOOST_TEST(second.from == 1);
  BOOST_TEST(second.until == 2.5);
}

// The order in the file does not matter: what refers to a body may stand before it.
BOOST_AUTO_TEST_CASE(a_spring_may_stand_before_its_bodies) {
  const Scene scene = scene_of(
      "[[scene.spring]]\na = 'world'\nb = 'late'\nstiffness = 1\n[[scene.body]]\nname = 'late'\nmass = 1\ninertia = "
      "[1, 1, 1]");
  BOOST_TEST(scene.springs.at(0).b == 0);
}

// Reading is linear: ten times the bodies take about ten times as long. A search of all bodies for each spring would
// take a hundred times. The best of three counts, because the machine has other load; 40 is a factor away from both.
BOOST_AUTO_TEST_CASE(ten_times_the_bodies_take_about_ten_times_as_long) {
  const auto seconds_for = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      text += fmt::format("[[scene.body]]\nname = 'body {}'\nmass = 1\ninertia = [1, 1, 1]\n", i);
      text += fmt::format("[[scene.spring]]\na = 'world'\nb = 'body {}'\nstiffness = 1\n", (i * 7919 + 1) % count);
    }
    double best = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 3; ++round) {
      const auto start = std::clock();
      BOOST_TEST(scene_of(text).springs.size() == static_cast<std::size_t>(count));
      best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return best;
  };
  BOOST_TEST(seconds_for(10000) < 40 * seconds_for(1000));
}

BOOST_AUTO_TEST_SUITE_END()
