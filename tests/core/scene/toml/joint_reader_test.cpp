#include "core/scene/toml/joint_reader.h"

#include <boost/test/unit_test.hpp>

#include "core/scene/features/features.h"
#include "core/scene/joint_rates.h"
#include "tests/core/scene/scene_of.h"
#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_toml_joint_reader)

namespace {

// Lines 1 to 6. What a row adds begins on line 7.
const std::string kBodies = R"([scene]
body = [
  { name = "rod", mass = 1, inertia = [1, 1, 1], position = [1, 0, 0], velocity = [0, 2, 0], angular_velocity = [0, 0, 2] },
  { name = "post", fixed = true },
  { name = "link", mass = 1, inertia = [1, 1, 1], position = [0, 5, 0] },
]
)";

const std::string kHinge =
    "[[scene.joint]]\nname = 'knee'\ntype = 'hinge'\na = 'world'\nb = 'rod'\nanchor = [0, 0, 0]\n";
const std::string kCylinder =
    "[[scene.joint]]\ntype = 'cylindrical'\nname = 'sleeve'\na = 'world'\nb = 'rod'\nanchor = [0, 0, 0]\n"
    "axis = [0, 0, 1]\n";
const std::string kMotor = kHinge + "axis = [0, 0, 1]\n[[scene.motor]]\n";
const std::string kChain = "[[scene.array]]\nbody = 'link'\ncount = [3, 1, 2]\nspacing = 2\n";

// Lines 7 to 20: at rest, one axis twice.
const std::string kTwice =
    "[[scene.joint]]\nname = 'one'\ntype = 'hinge'\na = 'world'\nb = 'link'\nanchor = [0, 0, 0]\naxis = [0, 0, 1]\n"
    "[[scene.joint]]\nname = 'other'\ntype = 'hinge'\na = 'post'\nb = 'link'\nanchor = [0, 0, 0]\naxis = [0, 0, 1]\n";
// Lines 7 to 19: a hinge that turns at 2 rad/s, and a slider at rest.
const std::string kGeared =
    kHinge +
    "axis = [0, 0, 1]\n[[scene.joint]]\nname = 'ankle'\ntype = 'slider'\na = 'world'\nb = 'link'\naxis = [1, 0, 0]\n";
const std::string kAxis = "{ type = 'hinge', anchor = [0, 0, 0], axis = [0, 0, 1] }";

const std::vector<Refusal> kBadJoints = {
    {kHinge + "axis = [0, 0, 1]\narmature = -1", "14:12: scene.joint.armature: ", {"found -1"}},
    {kGeared + "[[scene.coupling]]\njoint = 'ankl'\nto = 'knee'\nratio = 2",
     "21:9: scene.coupling.joint: ",
     {"no joint 'ankl'", "'ankle'"}},
    {kGeared + "[[scene.coupling]]\njoint = 'ankle'\nto = 'knee'\nratio = 0",
     "23:9: scene.coupling.ratio: ",
     {"found 0"}},
    {kGeared + "[[scene.coupling]]\njoint = 'ankle'\nto = 'ankle'\nratio = 1",
     "22:6: scene.coupling.to: ",
     {"the same joint"}},
    {kGeared + "[[scene.coupling]]\njoint = 'ankle'\nto = 'knee'\nratio = 2\noffset = 0.1",
     "24:10: scene.coupling.offset: ",
     {"0 at t = 0", "violates"}},
    {kGeared + "[[scene.coupling]]\njoint = 'ankle'\nto = 'knee'\nratio = 2",
     "20:1: scene.coupling: ",
     {"initial velocities break it", "rigor settle"}},
    {kGeared + "[[scene.coupling]]\njoint = 'ankle'\nto = ['knee', 'knee']\nratio = 2",
     "23:9: scene.coupling.ratio: ",
     {"found 1 for 2 joints", "one for each"}},
    {kGeared + "[[scene.coupling]]\njoint = 'ankle'\nto = ['knee', 'knee']\nratio = [2, 3]",
     "22:6: scene.coupling.to: ",
     {"twice"}},
    {kTwice + "[[scene.coupling]]\njoint = 'one'\nto = 'other'\nratio = 1\n[[scene.coupling]]\njoint = 'other'\nto = "
              "'one'\nratio = 1",
     "27:6: scene.coupling.to: ",
     {"coupled already", "circle"}},
    {kCylinder + "[[scene.coupling]]\njoint = 'sleeve'\nto = 'sleeve'\nratio = 1",
     "15:9: scene.coupling.joint: ",
     {"a cylindrical joint", "no coordinate of its own"}},
    {"[[scene.joint]]\ntype = 'compound'\na = 'world'\nb = 'link'\naxes = [" + kAxis + ", " + kAxis + "]",
     "11:8: scene.joint.axes: ",
     {"hinges 1 and 2", "same axis"}},
    {"[[scene.joint]]\ntype = 'screw'\na = 'world'\nb = 'link'\nanchor = [0, 0, 0]\naxis = [0, 0, 1]\npitch = 0",
     "13:9: scene.joint.pitch: ",
     {"found 0", "m per turn"}},
    {kHinge + "axis = [0, 1, 0]", "7:1: scene.joint: ", {"break it by 0 m/s and 2 rad/s", "rigor settle"}},
    {"[[scene.joint]]\ntype = 'hinge'\na = 'world'\nb = 'rod'\nanchor = [1, 0, 0]\naxis = [0, 0, 1]",
     "7:1: scene.joint: ",
     {"'world' and 'rod'", "2 m/s"}},
    {kHinge + "axis = [0, 0, 1]\nlower = 1\nupper = -1", "15:9: scene.joint.upper: ", {"found -1", "lower is 1"}},
    {kHinge + "axis = [0, 0, 1]\nlower = 0.5", "14:9: scene.joint.lower: ", {"0.5 below it"}},
    {kHinge + "axis = [0, 0, 1]\nrestitution = 0.5", "14:15: scene.joint.restitution: ", {"no limit"}},
    {kHinge + "axis = [0, 0, 1]\nquadratic_stiffness = 2",
     "14:23: scene.joint.quadratic_stiffness: ",
     {"adds to stiffness", "allowed: a stiffness above 0, too"}},
    {kHinge + "axis = [0, 0, 1]\nstiffness = 1\nquadratic_stiffness = -2",
     "15:23: scene.joint.quadratic_stiffness: ",
     {"found -2"}},
    {kHinge + "axis = [0, 0, 1]\nrest = 0.5", "14:8: scene.joint.rest: ", {"stiffness"}},
    {"[[scene.joint]]\ntype = 'ball'\na = 'world'\nb = 'rod'\nanchor = [0, 0, 0]\ndamping = 1",
     "12:1: scene.joint.damping: a ball joint has no such key",
     {}},
    {kCylinder + "damping = 1", "14:1: scene.joint.damping: a cylindrical joint has no such key", {"anchor, axis"}},
    {kCylinder + "lower = -1", "14:1: scene.joint.lower: a cylindrical joint has no such key", {}},
    {kCylinder + "[[scene.motor]]\njoint = 'sleeve'\nspeed = 1\nmost = 1",
     "15:9: scene.motor.joint: ",
     {"a cylindrical joint", "no coordinate of its own", "a hinge, a slider"}},
    {"[[scene.joint]]\ntype = 'universal'\na = 'world'\nb = 'rod'\nanchor = [0, 0, 0]\naxis = [1, 0, 0]\naxis2 = [1, "
     "0, 1]",
     "13:9: scene.joint.axis2: ",
     {"45°", "right angle"}},
    {kHinge + "axis = [0, 0, 1]\n" + kHinge + "axis = [0, 0, 1]",
     "15:8: scene.joint.name: ",
     {"already a joint 'knee'"}},
    {kMotor + "joint = 'kne'\ntorque = 1", "15:9: scene.motor.joint: ", {"no joint 'kne'", "'knee'"}},
    {kGeared + "[[scene.motor]]\njoint = 'ankle'\nplus = 'knee'\nratio = 1\nkp = 1\ntarget = 0",
     "22:8: scene.motor.plus: ",
     {"may turn round", "less than a turn apart"}},
    {kGeared + "[[scene.motor]]\njoint = 'ankle'\nplus = 'knee'\nratio = 1\nforce = 2",
     "22:8: scene.motor.plus: ",
     {"for servos"}},
    {kGeared + "[[scene.motor]]\njoint = 'ankle'\nplus = 'knee'\nratio = 1\nkp = 1\ntarget = 0\nmost = 3",
     "26:8: scene.motor.most: ",
     {"no bound"}},
    {kGeared + "[[scene.motor]]\njoint = 'ankle'\nplus = 'knee'\nratio = 1\nkp = 1\ntarget = 0\nperiod = 0.1",
     "26:10: scene.motor.period: ",
     {"does not sample"}},
    {kGeared + "[[scene.motor]]\njoint = 'ankle'\nratio = 1\nkp = 1\ntarget = 0",
     "22:9: scene.motor.ratio: ",
     {"allowed: plus"}},
    {kMotor + "joint = 'knee'\nforce = 1", "16:9: scene.motor.force: ", {"a hinge takes a torque"}},
    {kMotor + "joint = 'knee'", "14:1: scene.motor: ", {"neither", "speed and most"}},
    {kMotor + "joint = 'knee'\nspeed = 1", "14:1: scene.motor.most: missing", {}},
    {kMotor + "joint = 'knee'\ntorque = 1\nmost = 2", "17:8: scene.motor.most: ", {"speed"}},
    {kMotor + "joint = 'knee'\ntorque = 1\nfrom = 2\nuntil = 1", "18:9: scene.motor.until: ", {"after from"}},
    {"[[scene.array]]\nbody = 'lnk'\ncount = [2, 1, 1]\nspacing = 1",
     "8:8: scene.array.body: ",
     {"no body 'lnk'", "'link'"}},
    {"[[scene.array]]\nbody = 'link'\ncount = [2, 0, 1]\nspacing = 1",
     "9:9: scene.array.count: ",
     {"found 0", "whole"}},
    {"[[scene.array]]\nbody = 'link'\ncount = [2e3, 1e3, 1e3]\nspacing = 1",
     "9:9: scene.array.count: ",
     {"2e+09 copies"}},
    {kChain + kChain, "12:8: scene.array.body: ", {"already an array of 'link'"}},
    {kChain + "[[scene.force]]\nbody = 'link'\nforce = [1, 0, 0]",
     "12:8: scene.force.body: ",
     {"an array of 6 bodies", "'link-1-1'"}},
    {kChain + "[[scene.joint]]\ntype = 'fixed'\na = 'link'\nb = 'link+y'", "14:5: scene.joint.b: ", {"no next"}},
    {kChain + "[[scene.joint]]\ntype = 'fixed'\na = 'link'\nb = 'link'",
     "14:5: scene.joint.b: ",
     {"itself", "'link+x'"}},
};

}  // namespace

BOOST_AUTO_TEST_CASE(each_joint_motor_and_array_that_cannot_be_is_refused) {
  for (const Refusal& row : kBadJoints) check_refusal(row, "s.toml", [&] { scene_of(kBodies + row.text); });
}

// What is refused for its velocities is read as given for those who will mend it.
BOOST_AUTO_TEST_CASE(velocities_that_break_a_joint_can_be_read_as_given) {
  const TomlFile file = TomlFile::parse(kBodies + kHinge + "axis = [0, 1, 0]", "s.toml");
  const Scene scene = read_scene(file.root({"scene"}).at("scene"), InitialVelocities::as_given);
  const JointRates rates = initial_rates(scene, scene.joints.at(0));
  BOOST_TEST(rates.speed == 0);
  BOOST_TEST(rates.turn_rate == 2);
}

BOOST_AUTO_TEST_CASE(a_joints_coordinate_and_its_motor_are_read) {
  const Scene scene = scene_of(kBodies + kHinge +
                               "axis = [0, 0, 2]\nstiffness = 3\ndamping = 4\nrest = 0.5\nlower = -1\nupper = 2\n"
                               "restitution = 0.25\n[[scene.motor]]\njoint = 'knee'\nspeed = -1\nmost = 7\nfrom = 1\n"
                               "until = 2\n[[scene.motor]]\njoint = 'knee'\ntorque = 6");
  const Joint& joint = scene.joints.at(0);
  BOOST_TEST(joint.name == "knee");
  BOOST_TEST(joint.stiffness == 3);
  BOOST_TEST(joint.damping == 4);
  BOOST_TEST(joint.rest == 0.5);
  BOOST_TEST(joint.lower == -1);
  BOOST_TEST(joint.upper == 2);
  BOOST_TEST(joint.restitution == 0.25);
  BOOST_TEST((*free_axis(joint) == Vec3(0, 0, 1)));
  BOOST_TEST(scene.motors.at(0).speed.value() == -1);
  BOOST_TEST(scene.motors.at(0).most == 7);
  BOOST_TEST(scene.motors.at(0).until == 2);
  BOOST_TEST(scene.motors.at(1).effort == 6);
  BOOST_TEST(!scene.motors.at(1).speed.has_value());

  Features features;
  for (const Need& need : needs_of(scene)) features.insert(need.feature);
  BOOST_TEST((features == Features{Feature::fixed_body, joint_feature<HingeJoint>(), Feature::joint_spring,
                                   Feature::joint_damper, Feature::joint_limit, Feature::joints_with_dampers,
                                   Feature::motor_effort, Feature::motor_speed}));
}

// A grid of 3 by 2, joined along x, with each copy of the first row hung from the world.
BOOST_AUTO_TEST_CASE(an_array_copies_its_body_and_the_joints_to_the_next) {
  const Scene scene =
      scene_of(kBodies + kChain + "[[scene.joint]]\nname = 'j'\ntype = 'ball'\na = 'link'\nb = 'link+x'\n" +
               "anchor = [1, 5, 0]\n[[scene.spring]]\na = 'world'\nb = 'link'\nstiffness = 1\npoint_a = [0, 6, 0]\n" +
               "[[scene.joint]]\ntype = 'ball'\na = 'world'\nb = 'link-3-2'\nanchor = [4, 5, 3]");
  BOOST_TEST(scene.bodies.size() == 8u);
  BOOST_TEST(scene.bodies[2].name == "link-1-1");
  BOOST_TEST(scene.bodies[7].name == "link-3-2");
  BOOST_TEST((scene.bodies[7].position == Vec3(4, 5, 2)));
  BOOST_TEST(scene.joints.size() == 5u);  // two along each of the two rows, and the one that is named
  BOOST_TEST(scene.joints[3].a == 6);
  BOOST_TEST(scene.joints[3].b == 7);
  BOOST_TEST(scene.joints[3].name == "j-2-2");
  BOOST_TEST((std::get<BallJoint>(scene.joints[3].type).anchor == Vec3(3, 5, 2)));
  BOOST_TEST(scene.springs.size() == 6u);
  for (const Spring& spring : scene.springs) BOOST_TEST(spring.rest_length == 1);
  BOOST_TEST(scene.joints[4].b == 7);
}

BOOST_AUTO_TEST_CASE(jitter_moves_each_copy_within_its_bound_and_repeats_with_its_seed) {
  const std::string jittered = kBodies + kChain + "jitter = 0.125\nseed = ";
  const Scene one = scene_of(jittered + "1"), again = scene_of(jittered + "1"), two = scene_of(jittered + "2");
  const Scene grid = scene_of(kBodies + kChain);
  double most = 0;
  for (std::size_t i = 2; i < one.bodies.size(); ++i) {
    BOOST_TEST((one.bodies[i].position == again.bodies[i].position));
    BOOST_TEST((one.bodies[i].position != two.bodies[i].position));
    most = std::max(most, (one.bodies[i].position - grid.bodies[i].position).cwiseAbs().maxCoeff());
  }
  BOOST_TEST(most <= 0.125);
  BOOST_TEST(most > 0.0625);  // of 18 numbers none beyond the half: 4e-6
}

BOOST_AUTO_TEST_SUITE_END()
