// Scenes that no file was read for: whoever makes one is told what is wrong with it.
#include "core/scene/validate.h"

#include <boost/test/unit_test.hpp>
#include <functional>

#include "cases/case/suite.h"
#include "core/base/error.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_validate)

namespace {

// A post and two boxes, a spring, a hinge with a motor, a contact and a force.
Scene sound() {
  Scene scene;
  for (const char* name : {"post", "a", "b"}) {
    Body body;
    body.name = name, body.shape = Box{{1, 1, 1}}, body.collides = true;
    body.fixed = std::string(name) == "post";
    scene.bodies.push_back(body);
  }
  Spring spring;
  spring.a = 1, spring.b = 2;
  scene.springs = {spring};
  Joint hinge;
  hinge.a = 0, hinge.b = 1, hinge.type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()};
  scene.joints = {hinge};
  Motor motor;
  motor.joint = 0;
  scene.motors = {motor};
  scene.contact_pairs = {{1, 2, {0.5, 0.5}}};
  TimedForce force;
  force.body = 1;
  scene.forces = {force};
  return scene;
}

std::string said_of(const Scene& scene) {
  try {
    validate(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Row {
  std::function<void(Scene&)> spoil;
  std::string said;  // what the message begins with
};

const std::vector<Row> kSpoilt = {
    {[](Scene& s) { s.bodies.clear(); }, "there is no body"},
    {[](Scene& s) { s.gravity.x() = kNan; }, "gravity"},
    {[](Scene& s) { s.bodies[1].name = "world"; }, "body 'world': name"},
    {[](Scene& s) { s.bodies[2].name = "a"; }, "body 'a': name"},
    {[](Scene& s) { s.bodies[1].mass = 0; }, "body 'a': mass"},
    {[](Scene& s) { s.bodies[1].mass = kNan; }, "body 'a': mass"},
    {[](Scene& s) { s.bodies[1].inertia = Vec3(1, 1, 3).asDiagonal(); }, "body 'a': inertia"},
    {[](Scene& s) { s.bodies[1].position.y() = kNan; }, "body 'a': position"},
    {[](Scene& s) { s.bodies[1].orientation.w() = 1.1; }, "body 'a': orientation_wxyz"},
    {[](Scene& s) { s.bodies[1].velocity.y() = kNan; }, "body 'a': velocity"},
    {[](Scene& s) { s.bodies[0].angular_velocity.y() = 1; }, "body 'post': angular_velocity"},
    {[](Scene& s) { s.bodies[1].shape = Sphere{-1}; }, "body 'a': shape"},
    {[](Scene& s) {
       s.bodies[1].shape = Capsule{1, 0};
     },
     "body 'a': shape"},
    {[](Scene& s) { s.bodies[1].shape.reset(); }, "body 'a': collides"},
    {[](Scene& s) {
       s.bodies[1].shape = Plane{Vec3::UnitZ(), 0};
     },
     "body 'a': fixed"},
    {[](Scene& s) {
       s.bodies[0].shape = Plane{Vec3(0, 0, 2), 0};
     },
     "body 'post': shape"},
    {[](Scene& s) { s.springs[0].b = 1; }, "spring 1: b"},
    {[](Scene& s) { s.springs[0].b = 9; }, "spring 1: b"},
    {[](Scene& s) { s.springs[0].a = 0, s.springs[0].b = kWorld; }, "spring 1: b"},
    {[](Scene& s) { s.springs[0].stiffness = -1; }, "spring 1: stiffness"},
    {[](Scene& s) { s.springs[0].quadratic_stiffness = -1; }, "spring 1: quadratic_stiffness"},
    {[](Scene& s) { s.springs[0].stiffness = 0, s.springs[0].quadratic_stiffness = 1; },
     "spring 1: quadratic_stiffness"},
    {[](Scene& s) { s.springs[0].point_a.x() = kNan; }, "spring 1: "},
    {[](Scene& s) { s.joints[0].b = kWorld; }, "joint 1: b"},
    {[](Scene& s) {
       s.joints[0].type = HingeJoint{Vec3::Zero(), Vec3::Zero()};
     },
     "joint 1: axis"},
    {[](Scene& s) {
       s.joints[0].type = DistanceJoint{Vec3::Zero(), Vec3::Zero()};
     },
     "joint 1: point_b"},
    {[](Scene& s) {
       s.joints[0].type = UniversalJoint{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitX()};
     },
     "joint 1: axis2"},
    {[](Scene& s) { s.joints[0].lower = 1; }, "joint 1: lower"},
    {[](Scene& s) { s.joints[0].upper = -1; }, "joint 1: upper"},
    {[](Scene& s) { s.joints[0].restitution = 1.5; }, "joint 1: restitution"},
    {[](Scene& s) { s.joints[0].rest = kNan; }, "joint 1: rest"},
    {[](Scene& s) { s.joints[0].damping = -1; }, "joint 1: damping"},
    {[](Scene& s) { s.motors[0].joint = 1; }, "motor 1: joint"},
    {[](Scene& s) { s.joints[0].type = FixedJoint{}; }, "motor 1: joint"},
    {[](Scene& s) { s.motors[0].speed = 1; }, "motor 1: most"},
    {[](Scene& s) { s.motors[0].until = 0; }, "motor 1: until"},
    {[](Scene& s) {
       s.motors[0].speed = 1, s.motors[0].most = 2, s.motors[0].until = 3;
       s.motors.push_back(s.motors[0]);
       s.motors[1].from = 2, s.motors[1].until = 4;
     },
     "motor 1: speed"},
    {[](Scene& s) { s.contact_pairs[0].b = 1; }, "contact 1: b"},
    {[](Scene& s) {
       s.contact_pairs.push_back({2, 1, {}});
     },
     "contact 2: the pair"},
    {[](Scene& s) { s.contact_pairs[0].law.restitution = 1.5; }, "contact 1: restitution"},
    {[](Scene& s) { s.contact_default.friction = -1; }, "contact_default"},
    {[](Scene& s) { s.contact_pairs[0].law.rolling_friction = -1; }, "contact 1: rolling_friction"},
    {[](Scene& s) { s.contact_default.static_friction = kInfiniteFriction; }, "contact_default"},
    {[](Scene& s) { s.contact_pairs[0].law.friction = 0.3, s.contact_pairs[0].law.static_friction = 0.2; },
     "contact 1: static_friction"},
    {[](Scene& s) { s.contact_default.torsional_friction = kInfiniteFriction; }, "contact_default"},
    {[](Scene& s) { s.contact_pairs[0].law.stiffness = 1e4; }, "contact 1: stiffness"},
    {[](Scene& s) { s.contact_pairs[0].law.damping = 1; }, "contact 1: damping"},
    {[](Scene& s) { s.forces[0].body = 0; }, "force 1: body"},
    {[](Scene& s) { s.forces[0].torque.z() = kNan; }, "force 1: "},
    {[](Scene& s) { s.forces[0].from = -1; }, "force 1: from"},
};

}  // namespace

BOOST_AUTO_TEST_CASE(each_thing_that_no_scene_can_have_is_named) {
  BOOST_TEST(said_of(sound()) == "");
  for (const Row& row : kSpoilt) {
    Scene scene = sound();
    row.spoil(scene);
    const std::string said = said_of(scene);
    BOOST_TEST(said.starts_with(row.said), "wanted '" << row.said << "', found '" << said << "'");
  }
}

BOOST_AUTO_TEST_CASE(every_scene_of_the_suite_is_sound) {
  for (const Case& c : select_cases({}, default_suite_dir(), test::words())) {
    BOOST_TEST_CONTEXT(c.id) BOOST_TEST(said_of(c.scene) == "");
  }
}

BOOST_AUTO_TEST_SUITE_END()
