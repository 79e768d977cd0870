// Models without symmetry: turned frames, inertias askew, joints against the tree, contacts of one direction.
#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "tests/cases/import/imported.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_import_turned_models)

namespace {

std::string sdf_model(const std::string& inside) {
  return R"(<sdf version="1.9"><model name="m">)" + inside + "</model></sdf>";
}

// A link of 2 kg whose mass is half a metre below its origin.
std::string hanging(const std::string& name) {
  return "<link name='" + name +
         "'><inertial><pose>0 0 -0.5 0 0 0</pose><mass>2</mass><inertia><ixx>0.2</ixx><iyy>0.25</iyy><izz>0.1</izz>"
         "</inertia></inertial></link>";
}

std::string revolute(const std::string& name, const std::string& parent, const std::string& child,
                     const std::string& limits, const std::string& more = "") {
  return "<joint name='" + name + "' type='revolute'><parent>" + parent + "</parent><child>" + child +
         "</child><axis><xyz>0 1 0</xyz><limit>" + limits + "</limit>" + more + "</axis></joint>";
}

const std::string kFromHalf = "<lower>0.5</lower><upper>0.9</upper>", kAtZero = "<lower>-1</lower><upper>1</upper>";

// The total inertia of all bodies that move about their common centre, in W.
Mat3 total_inertia(const Scene& scene) {
  double mass = 0;
  Vec3 centre = Vec3::Zero();
  for (const Body& body : scene.bodies) mass += body.mass, centre += body.mass * body.position;
  centre /= mass;
  Mat3 inertia = Mat3::Zero();
  for (const Body& body : scene.bodies) {
    const Mat3 turn = matrix_of(body.orientation);
    const Vec3 arm = body.position - centre;
    inertia += turn * body.inertia * turn.transpose() +
               body.mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  return inertia;
}

bool may_touch(const Scene& scene, const std::string& a, const std::string& b) {
  const auto index = [&](const std::string& name) {
    return static_cast<int>(&body_named(scene, name) - scene.bodies.data());
  };
  return scene.contact_law(index(a), index(b)).collides;
}

}  // namespace

// A link without moments of inertia is a point of the body that carries it.
BOOST_AUTO_TEST_CASE(a_point_on_a_body_in_other_axes_adds_to_its_inertia) {
  const std::string text =
      "<robot name='r'><link name='arm'><inertial><origin xyz='0.1 0.2 -0.1' rpy='0.3 -0.4 0.5'/><mass value='3'/>"
      "<inertia ixx='0.5' iyy='0.7' izz='0.9' ixy='0.02' ixz='-0.03' iyz='0.04'/></inertial></link>"
      "<link name='tip'><inertial><mass value='1'/><inertia ixx='0' iyy='0' izz='0' ixy='0' ixz='0' iyz='0'/>"
      "</inertial></link><joint name='holds' type='fixed'><parent link='arm'/><child link='tip'/>"
      "<origin xyz='0.5 -0.2 0.3'/></joint></robot>";
  const Scene scene = scene_of_text("r.urdf", text);
  BOOST_TEST_REQUIRE(scene.bodies.size() == 1u);
  Mat3 whole;
  whole << 0.5, 0.02, -0.03, 0.02, 0.7, 0.04, -0.03, 0.04, 0.9;
  const Mat3 turn = (Eigen::AngleAxisd(0.5, Vec3::UnitZ()) * Eigen::AngleAxisd(-0.4, Vec3::UnitY()) *
                     Eigen::AngleAxisd(0.3, Vec3::UnitX()))
                        .toRotationMatrix();
  // Two bodies about their common centre: by the reduced mass and their distance.
  const Vec3 apart(0.4, -0.4, 0.4);
  const Mat3 expected = turn * whole * turn.transpose() +
                        3.0 * 1.0 / 4.0 * (apart.squaredNorm() * Mat3::Identity() - apart * apart.transpose());
  BOOST_TEST(scene.bodies[0].mass == 4);
  BOOST_TEST((scene.bodies[0].position - Vec3(0.2, 0.1, 0)).norm() < 1e-14);
  BOOST_TEST((total_inertia(scene) - expected).cwiseAbs().maxCoeff() < 1e-14);
}

// The link, its inertia and its box each have axes of their own.
BOOST_AUTO_TEST_CASE(a_shape_in_other_axes_stands_where_the_file_has_it) {
  const std::string text =
      "<robot name='r'><link name='arm'><inertial><origin xyz='0.1 0.2 -0.1' rpy='0.3 -0.4 0.5'/><mass value='3'/>"
      "<inertia ixx='0.5' iyy='0.7' izz='0.9' ixy='0.02' ixz='-0.03' iyz='0.04'/></inertial><collision>"
      "<origin xyz='0.3 0.1 0.2' rpy='0.7 0.2 -0.6'/><geometry><box size='0.4 0.2 0.1'/></geometry></collision>"
      "</link></robot>";
  const auto turned = [](double roll, double pitch, double yaw) {
    return Quat(Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(pitch, Vec3::UnitY()) *
                Eigen::AngleAxisd(roll, Vec3::UnitX()));
  };
  const Scene scene = scene_of_text("r.urdf", text);
  BOOST_TEST_REQUIRE(scene.bodies.size() == 1u);
  Mat3 whole;
  whole << 0.5, 0.02, -0.03, 0.02, 0.7, 0.04, -0.03, 0.04, 0.9;
  const Mat3 turn = matrix_of(turned(0.3, -0.4, 0.5));
  BOOST_TEST((scene.bodies[0].position - Vec3(0.1, 0.2, -0.1)).norm() < 1e-14);
  BOOST_TEST((total_inertia(scene) - turn * whole * turn.transpose()).cwiseAbs().maxCoeff() < 1e-14);
  const PlacedShape& box = std::get<Compound>(*scene.bodies[0].shape).parts.at(0);
  const BodyPose in_W = scene.pose(0) * box.pose;
  BOOST_TEST((in_W.position - Vec3(0.3, 0.1, 0.2)).norm() < 1e-14);
  BOOST_TEST(angle_between(in_W.orientation, turned(0.7, 0.2, -0.6)) < 1e-14);
}

BOOST_AUTO_TEST_CASE(a_slider_s_axis_turns_with_its_frame) {
  const std::string text =
      "<robot name='r'><link name='base'/><link name='arm'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' "
      "ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j' type='prismatic'><parent link='base'/><child "
      "link='arm'/><origin rpy='0 1.5707963267948966 0'/><axis xyz='0 0 1'/><limit lower='-1' "
      "upper='1'/></joint></robot>";
  const Scene scene = scene_of_text("r.urdf", text);
  BOOST_TEST((std::get<SliderJoint>(joint_named(scene, "j").type).axis - Vec3::UnitX()).norm() < 1e-15);
}

BOOST_AUTO_TEST_CASE(limits_the_wrong_way_round_are_refused) {
  for (const char* limits : {"lower='0.5' upper='-0.5'", "lower='0.5' upper='0.2'"}) {
    const std::string text =
        "<robot name='r'><link name='base'/><link name='arm'><inertial><mass value='1'/><inertia ixx='1' iyy='1' "
        "izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>\n<joint name='j' type='revolute'><parent "
        "link='base'/><child link='arm'/><limit " +
        std::string(limits) + "/></joint></robot>";
    const std::string says = refusal_of("r.urdf", text);
    BOOST_TEST(says.starts_with("r.urdf:2: joint 'j': <limit>: lower is 0.5"), says);
  }
}

BOOST_AUTO_TEST_CASE(an_sdf_surface_brings_its_restitution) {
  const std::string collision =
      "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry><surface><bounce>"
      "<restitution_coefficient>0.7</restitution_coefficient></bounce></surface></collision>";
  const Scene scene = scene_of_text("m.sdf", sdf_model("<link name='a'>" + collision + "</link>"));
  BOOST_TEST(scene.contact_default.restitution == 0.7);
}

BOOST_AUTO_TEST_CASE(a_pose_in_degrees_is_one_in_radians) {
  for (const char* flag : {"true", "1"}) {
    const Scene scene = scene_of_text(
        "m.sdf", sdf_model("<link name='a'><pose degrees='" + std::string(flag) + "'>0 0 0 90 0 0</pose></link>"));
    const Vec3 turned = scene.bodies[0].orientation * Vec3::UnitY();
    BOOST_TEST((turned - Vec3::UnitZ()).norm() < 1e-15, flag);
  }
}

// 0.3 of the file is 0.2 below the start at 0.5.
BOOST_AUTO_TEST_CASE(a_spring_s_rest_counts_from_the_start) {
  const std::string spring =
      "<dynamics><spring_stiffness>7</spring_stiffness><spring_reference>0.3</spring_reference></dynamics>";
  const Scene scene = scene_of_text("m.sdf", sdf_model(hanging("a") + revolute("j", "world", "a", kFromHalf, spring)));
  BOOST_TEST(std::abs(joint_named(scene, "j").rest - -0.2) < 1e-15);
  BOOST_TEST(joint_named(scene, "j").lower == 0);
}

// The joint's child is held by the world, so it is the parent that turns: back by the angle of the start.
BOOST_AUTO_TEST_CASE(a_joint_against_the_tree_moves_its_parent_the_other_way) {
  const std::string base = "<joint name='f' type='fixed'><parent>world</parent><child>base</child></joint>";
  const Scene scene = scene_of_text(
      "m.sdf", sdf_model(hanging("base") + hanging("arm") + base + revolute("j", "arm", "base", kFromHalf)));
  const Vec3 expected(0.5 * std::sin(0.5), 0, -0.5 * std::cos(0.5));
  BOOST_TEST((body_named(scene, "arm").position - expected).norm() < 1e-14);
}

// Two arms on the world, joined to each other: the first starts beyond zero, so that the last joint would open.
BOOST_AUTO_TEST_CASE(a_loop_that_its_start_opens_is_refused) {
  const auto loop = [](const std::string& first) {
    return sdf_model(hanging("a") + hanging("b") + revolute("j1", "world", "a", first) +
                     revolute("j2", "world", "b", kAtZero) + revolute("j3", "a", "b", kAtZero));
  };
  BOOST_TEST(refusal_of("m.sdf", loop(kAtZero)) == "");
  const std::string says = refusal_of("m.sdf", loop(kFromHalf));
  BOOST_TEST(says.find("closes a loop of joints that do not all start at their zeros") != std::string::npos, says);
}

// MuJoCo lets two geoms touch if the type of either is in the affinity of the other.
BOOST_AUTO_TEST_CASE(one_direction_of_contype_and_conaffinity_is_enough) {
  const auto& missing = missing_engines();
  const bool has_mujoco =
      std::none_of(missing.begin(), missing.end(), [](const auto& one) { return one.name == "mujoco"; });
  if (!has_mujoco) return;
  const auto body = [](const std::string& name, const std::string& x, const std::string& bits) {
    return "<body name='" + name + "' pos='" + x + " 0 1'><freejoint/><geom size='0.1' " + bits + "/></body>";
  };
  const std::string giver = "contype='1' conaffinity='0'", taker = "contype='0' conaffinity='1'",
                    other = "contype='2' conaffinity='4'";
  for (const bool giver_is_first : {true, false}) {
    const std::string first = body("first", "0", giver_is_first ? giver : taker),
                      second = body("second", "1", giver_is_first ? taker : giver);
    const Scene scene = scene_of_text(
        "m.xml", "<mujoco><worldbody>" + first + second + body("third", "2", other) + "</worldbody></mujoco>");
    BOOST_TEST(may_touch(scene, "first", "second"));
    BOOST_TEST(!may_touch(scene, "first", "third"));
    BOOST_TEST(!may_touch(scene, "second", "third"));
  }
}

// A mount between two links is part of the first one, so the second touches neither.
BOOST_AUTO_TEST_CASE(links_on_fixed_joints_count_as_one_when_joints_keep_links_apart) {
  const auto link = [](const std::string& name) {
    return "<link name='" + name +
           "'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
           "<collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
  };
  const auto joint = [](const std::string& type, const std::string& a, const std::string& b) {
    return "<joint name='" + a + b + "' type='" + type + "'><parent link='" + a + "'/><child link='" + b +
           "'/><origin xyz='1 0 0'/></joint>";
  };
  const Scene scene =
      scene_of_text("r.urdf", "<robot name='r'>" + link("arm") + link("mount") + link("hand") + link("tool") +
                                  joint("fixed", "arm", "mount") + joint("continuous", "mount", "hand") +
                                  joint("continuous", "hand", "tool") + "</robot>");
  BOOST_TEST(
      (!may_touch(scene, "arm", "mount") && !may_touch(scene, "mount", "hand") && !may_touch(scene, "arm", "hand")));
  BOOST_TEST(
      (!may_touch(scene, "hand", "tool") && may_touch(scene, "arm", "tool") && may_touch(scene, "mount", "tool")));
}

// MuJoCo's own rule: a body touches a parent that is part of the world.
BOOST_AUTO_TEST_CASE(a_mjcf_body_touches_a_parent_that_stands_still_and_no_other) {
  const auto& missing = missing_engines();
  if (std::any_of(missing.begin(), missing.end(), [](const auto& one) { return one.name == "mujoco"; })) return;
  const Scene scene = scene_of_text("m.xml", R"(<mujoco><worldbody><body name="post"><geom name="post" size="0.1"/>
    <body name="arm" pos="0 0 1"><joint axis="0 1 0"/><geom size="0.1"/>
    <body name="hand" pos="0 0 1"><joint axis="0 1 0"/><geom size="0.1"/></body></body></body></worldbody></mujoco>)");
  BOOST_TEST((may_touch(scene, "post", "arm") && may_touch(scene, "post", "hand") && !may_touch(scene, "arm", "hand")));
}

BOOST_AUTO_TEST_SUITE_END()
