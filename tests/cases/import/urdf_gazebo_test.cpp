// Gazebo's additions to URDF.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "tests/cases/import/imported.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_import_urdf_gazebo)

namespace {

std::string ball_with(const std::string& gazebo) {
  return R"(<robot name="r"><link name="ball"><inertial><origin xyz="0 0 0.1"/><mass value="2"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision group="default"><geometry><sphere radius="0.2"/></geometry></collision></link>
<link name="other"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<joint name="j" type="continuous"><parent link="ball"/><child link="other"/><origin xyz="1 0 0"/><axis xyz="1 0 0"/></joint>)" +
         gazebo + "</robot>";
}

double apart(const Vec3& a, const Vec3& b) { return (a - b).norm(); }

}  // namespace

// A quarter turn about z takes the arm of the joint from x to y.
BOOST_AUTO_TEST_CASE(the_pose_of_a_model_moves_all_its_links_and_joints) {
  const Scene scene = scene_of_text("r.urdf", ball_with("<gazebo><pose>3 0 5 0 0 1.5707963267948966</pose></gazebo>"));
  BOOST_TEST(apart(body_named(scene, "ball").position, {3, 0, 5.1}) < 1e-14);
  BOOST_TEST(apart(body_named(scene, "other").position, {3, 1, 5}) < 1e-14);
  BOOST_TEST(apart(*anchor_of(joint_named(scene, "j")), {3, 1, 5}) < 1e-14);
  BOOST_TEST(apart(*axis_of(joint_named(scene, "j")), {0, 1, 0}) < 1e-14);
}

BOOST_AUTO_TEST_CASE(a_pose_in_another_frame_is_a_loss) {
  const auto lost = physics_lost("r.urdf", ball_with("<gazebo><pose relative_to='ball'>3 0 5 0 0 0</pose></gazebo>"));
  BOOST_TEST(some_has(lost, "a pose: is relative to a frame"));
}

BOOST_AUTO_TEST_CASE(the_pose_of_a_link_is_a_loss) {
  const auto lost = physics_lost("r.urdf", ball_with("<gazebo reference='ball'><pose>3 0 5 0 0 0</pose></gazebo>"));
  BOOST_TEST(some_has(lost, "<pose>: is not of the format"));
}

BOOST_AUTO_TEST_CASE(friction_is_a_text_or_as_in_older_files_an_attribute) {
  const auto friction = [](const std::string& mu) {
    const auto text =
        ball_with("<gazebo reference='ball'>" + mu + "</gazebo><gazebo reference='other'>" + mu + "</gazebo>");
    BOOST_TEST(physics_lost("r.urdf", text).empty());
    const Folder folder;
    ImportOptions options;
    options.ground = true;
    const std::string path = folder.write("r.urdf", text);
    const Scene scene = read_case_text(case_text_of(import_model(path, options)), path, path, words()).scene;
    return scene.contact_law(0, static_cast<int>(scene.bodies.size()) - 1).friction;
  };
  BOOST_TEST(friction("<mu1>0.4</mu1><mu2>0.4</mu2>") == 0.4);
  BOOST_TEST(friction("<mu1 value='0.4'/><mu2 value='0.4'/>") == 0.4);
  BOOST_TEST(refusal_of("r.urdf", ball_with("<gazebo reference='ball'><mu1/></gazebo>")).find("<mu1>") !=
             std::string::npos);
  BOOST_TEST(refusal_of("r.urdf", ball_with("<gazebo reference='ball'><mu1 value='-1'/></gazebo>")).find("<mu1>") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(gravity_is_switched_off_by_a_text_or_an_attribute) {
  const auto force = [](const std::string& gazebo) {
    const Scene scene = scene_of_text("r.urdf", ball_with("<gazebo reference='ball'>" + gazebo + "</gazebo>"));
    return scene.forces.empty() ? 0 : scene.forces[0].force.z();
  };
  const double weight = 2 * 9.81;
  BOOST_TEST(std::abs(force("<turnGravityOff>true</turnGravityOff>") - weight) < 0.01);
  BOOST_TEST(force("<turnGravityOff value='true'/>") == force("<turnGravityOff>true</turnGravityOff>"));
  BOOST_TEST(force("<gravity value='0'/>") == force("<turnGravityOff value='1'/>"));
  BOOST_TEST(force("<turnGravityOff value='false'/>") == 0);
  BOOST_TEST(refusal_of("r.urdf", ball_with("<gazebo reference='ball'><turnGravityOff value='yes'/></gazebo>"))
                 .find("found 'yes'; allowed: true, false") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(controllers_and_sensors_of_old_files_change_nothing_and_bodies_do) {
  const std::string old =
      "<gazebo xmlns:controller='http://c' xmlns:sensor='http://s' xmlns:body='http://b'><controller:imu name='i'/>"
      "<sensor:ray name='s'/><canonicalBody>ball</canonicalBody>";
  BOOST_TEST(physics_lost("r.urdf", ball_with(old + "</gazebo>")).empty());
  BOOST_TEST(some_has(physics_lost("r.urdf", ball_with(old + "<body:box name='b'/></gazebo>")), "<body:box>"));
}

// An old attribute of a collision geometry, of which the format's readers make nothing.
BOOST_AUTO_TEST_CASE(the_group_of_a_collision_changes_nothing) {
  BOOST_TEST(physics_lost("r.urdf", ball_with("")).empty());
}

BOOST_AUTO_TEST_SUITE_END()
