// A servo on several joints of which one is no joint of the scene.
#include <boost/test/unit_test.hpp>

#include "cases/import/assembly/assembly.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_import_lost_servo)

namespace {

// An arm on the world, and a joint between two links that stand still.
LinkModel arm_with(const Motor& motor) {
  LinkModel model;
  Link arm{"arm", "m.xml:2: link 'arm'", {}};
  arm.inertial = {{2, {{0.5, 0, 0}, Quat::Identity()}, 0.1 * Mat3::Identity()}};
  Link post{"post", "m.xml:3: link 'post'", {}}, rail{"rail", "m.xml:4: link 'rail'", {}};
  post.is_static = rail.is_static = true;
  model.links = {arm, post, rail};
  LinkJoint shoulder, still;
  shoulder.joint = {.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitY()}, .name = "shoulder"};
  shoulder.joint.lower = -1, shoulder.joint.upper = 1, shoulder.where = "m.xml:5: joint 'shoulder'";
  still.joint = {.a = 1, .b = 2, .type = SliderJoint{Vec3::UnitX()}, .name = "still"};
  still.where = "m.xml:6: joint 'still'";
  model.joints = {shoulder, still};
  model.motors = {motor};
  return model;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_is_a_loss_and_one_on_a_joint_that_is_there_is_kept) {
  const Servo servo{.target = TimeTable::constant(0.5), .kp = 3};
  LinkModel alone = arm_with({.joint = 0, .servo = servo});
  BOOST_TEST(scene_of(alone, false).motors.size() == 1u);
  BOOST_TEST(losses_of(alone.left_out.all(), LossKind::physical).empty());
  LinkModel summed = arm_with({.joint = 0, .servo = servo, .plus = {{1, 2}}});
  BOOST_TEST(scene_of(summed, false).motors.empty());
  const std::vector<Loss> lost = losses_of(summed.left_out.all(), LossKind::physical);
  BOOST_TEST_REQUIRE(lost.size() == 1u);
  BOOST_TEST(lost[0].what == "a servo on several joints");
}

BOOST_AUTO_TEST_SUITE_END()
