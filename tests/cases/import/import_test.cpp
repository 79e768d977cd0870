// Robots' files as scenes: inertias in their frames, joints with what acts on them, shapes, and what was left out.
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <numbers>

#include "cases/truth/truth.h"
#include "core/scene/validate.h"
#include "generated/tests/places.h"
#include "tests/cases/import/imported.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_import_import)

namespace {

const std::string kModels = RIGOR_SOURCE_DIR "/tests/cases/import/models/";

double apart(const Vec3& a, const Vec3& b) { return (a - b).norm(); }

// A base that the world holds, and a link on a joint of `type` whose elements are `more`.
std::string urdf_of(const std::string& type, const std::string& more, const std::string& of_link = "") {
  return R"(<robot name="r"><link name="base"/><link name="arm"><inertial><origin xyz="0.5 0 0" rpy="0 0 1.5707963267948966"/>
<mass value="2"/><inertia ixx="1" iyy="2" izz="2.5" ixy="0.1" ixz="0" iyz="0"/></inertial>)" +
         of_link + R"(</link><joint name="j" type=")" + type +
         R"("><parent link="base"/><child link="arm"/><origin xyz="0 0 1" rpy="0 1.5707963267948966 0"/>)" + more +
         "</joint></robot>";
}

std::string sdf_of(const std::string& inside) {
  return R"(<sdf version="1.9"><world name="w">)" + inside + "</world></sdf>";
}

// 2 kg of 0.4 m edges, as a link.
const std::string kBoxInertial =
    "<inertial><mass>2</mass><inertia><ixx>0.05333333333333333</ixx><iyy>0.05333333333333333</iyy>"
    "<izz>0.05333333333333333</izz></inertia></inertial>";

}  // namespace

// The link's frame stands at the joint, turned by a quarter about y: its x points down, its z along W's x. The mass is
// half a metre along the link's x, and its inertia's axes are turned by a quarter about the link's z.
BOOST_AUTO_TEST_CASE(an_inertia_is_turned_into_the_frame_of_its_link_and_the_origin_is_the_centre_of_mass) {
  const Scene scene = scene_of_text("r.urdf", urdf_of("continuous", "<axis xyz='0 0 1'/>"));
  BOOST_TEST_REQUIRE(scene.bodies.size() == 1u);
  const Body& arm = scene.bodies[0];
  BOOST_TEST(apart(arm.position, {0, 0, 0.5}) < 1e-14);
  BOOST_TEST(apart(arm.orientation * Vec3::UnitX(), -Vec3::UnitZ()) < 1e-14);
  Mat3 expected;  // x of the inertia is the link's y, and y its -x
  expected << 2, -0.1, 0, -0.1, 1, 0, 0, 0, 2.5;
  BOOST_TEST((arm.inertia - expected).cwiseAbs().maxCoeff() < 1e-14);
  BOOST_TEST(apart(scene.gravity, {0, 0, -9.81}) == 0);
  const auto& hinge = std::get<HingeJoint>(joint_named(scene, "j").type);
  BOOST_TEST(joint_named(scene, "j").a == kWorld);
  BOOST_TEST(apart(hinge.anchor, {0, 0, 1}) < 1e-14);
  BOOST_TEST(apart(hinge.axis, Vec3::UnitX()) < 1e-14);
}

// An arm with limits is held against the truth; where links may touch there is none, and the file says why.
BOOST_AUTO_TEST_CASE(a_model_gets_the_truth_that_there_is) {
  const auto text = [](const std::string& of_link) {
    const Folder folder;
    const std::string more = "<axis xyz='0 1 0'/><limit lower='-0.4' upper='0.9' effort='10' velocity='3'/>";
    return case_text_of(import_model(folder.write("r.urdf", urdf_of("revolute", more, of_link))));
  };
  BOOST_TEST(text("").ends_with("[truth]\nkind = \"reference\"\n"));
  const std::string with_shape = text("<collision><geometry><sphere radius='0.1'/></geometry></collision>");
  BOOST_TEST(with_shape.ends_with("[truth]\nkind = \"reference\"\n"));  // nothing else is there to touch
  for (const std::string& kind : {text(""), with_shape}) {
    const Case arm = read_case_text(kind, "arm.toml", "arm.toml", words());
    BOOST_TEST(make_truth(arm.truth, arm.scene, 0.5)->error(0.5) < 1e-9);  // s, m: it swings onto its limit at 0.3 s
  }
}

BOOST_AUTO_TEST_CASE(joints_bring_limits_damping_and_friction_and_bounds_of_drives_change_nothing) {
  const std::string more =
      "<axis xyz='0 2 0'/><limit lower='-0.4' upper='0.9' effort='10' velocity='3'/><dynamics damping='0.7' "
      "friction='0.2'/>";
  const Scene scene = scene_of_text("r.urdf", urdf_of("prismatic", more));
  const Joint& joint = joint_named(scene, "j");
  BOOST_TEST(apart(std::get<SliderJoint>(joint.type).axis, Vec3::UnitY()) < 1e-14);
  BOOST_TEST(joint.lower == -0.4);
  BOOST_TEST(joint.upper == 0.9);
  BOOST_TEST(joint.damping == 0.7);
  BOOST_TEST_REQUIRE(scene.motors.size() == 1u);
  BOOST_TEST((scene.motors[0].is_friction && scene.motors[0].most == 0.2));
  const auto left_out = left_out_of_model("r.urdf", urdf_of("prismatic", more));
  for (const char* part : {":2: joint 'j': <limit>: attribute 'effort': bounds a drive", "attribute 'velocity'",
                           "gravity: the format states none"})
    BOOST_TEST(some_has(left_out, part), part);
  BOOST_TEST(physics_lost("r.urdf", urdf_of("prismatic", more)).empty());
}

// Zero is below the limits: the joint starts at the nearer one, and everything beyond it with it.
BOOST_AUTO_TEST_CASE(a_joint_whose_zero_is_beyond_its_limits_starts_at_the_limit) {
  const std::string more = "<axis xyz='0 0 1'/><limit lower='0.5' upper='0.9'/>";
  const Scene scene = scene_of_text("r.urdf", urdf_of("revolute", more));
  const Joint& joint = joint_named(scene, "j");
  BOOST_TEST(joint.lower == 0.0);
  BOOST_TEST(std::abs(joint.upper - 0.4) < 1e-14);
  // The mass stood at 0.5 m below the anchor; about W's x a turn by 0.5 takes it towards y.
  BOOST_TEST(apart(scene.bodies[0].position, {0, 0.5 * std::sin(0.5), 1 - 0.5 * std::cos(0.5)}) < 1e-14);
  BOOST_TEST(some_has(left_out_of_model("r.urdf", urdf_of("revolute", more)),
                      "joint 'j': a start beyond the limits: the joint starts at the nearest limit"));
}

BOOST_AUTO_TEST_CASE(an_arm_of_six_joints_is_held_by_its_base_and_ends_in_frames_without_mass) {
  const Scene scene = scene_of_file(kModels + "arm.urdf");
  BOOST_TEST(scene.bodies.size() == 6u);
  BOOST_TEST(scene.joints.size() == 6u);
  for (const Joint& joint : scene.joints)
    BOOST_TEST((joint.lower == -std::numbers::pi && joint.upper == std::numbers::pi));
  // Stretched out along x, as the tables of the arm have it: 0.425 + 0.39225 m to the first wrist.
  BOOST_TEST(apart(body_named(scene, "wrist_1_link").position, {0.81725, 0.10915, 0.089159}) < 1e-9);
  BOOST_TEST(losses_of(import_model(kModels + "arm.urdf").losses, LossKind::physical).empty());
}

BOOST_AUTO_TEST_CASE(a_quadruped_is_free_and_has_thirteen_bodies) {
  const Scene scene = scene_of_file(kModels + "quadruped.urdf");
  BOOST_TEST(scene.bodies.size() == 13u);
  const auto is_hinge = [](const Joint& joint) { return std::holds_alternative<HingeJoint>(joint.type); };
  BOOST_TEST(std::count_if(scene.joints.begin(), scene.joints.end(), is_hinge) == 12);
  const auto left_out = sentences_of(import_model(kModels + "quadruped.urdf").losses);
  BOOST_TEST(some_has(left_out, "it is free"));
  BOOST_TEST(some_has(left_out, "joint 'FR_calf_joint': a start beyond the limits"));
}

BOOST_AUTO_TEST_CASE(every_shape_of_a_robot_collides_and_no_two_links_of_a_joint_do) {
  const Scene scene = scene_of_file(kModels + "quadruped.urdf");
  int shapes = 0;
  for (const Body& body : scene.bodies) {
    if (body.shape) for_each_part(*body.shape, [&](const Shape&, const BodyPose&) { ++shapes; });
    BOOST_TEST(body.collides == body.shape.has_value(), body.name);
  }
  BOOST_TEST(shapes == 17);  // a trunk, and on each leg a hip, a thigh, a calf and a foot
  for (const Joint& joint : scene.joints) {
    if (joint.a == kWorld || joint.b == kWorld) continue;
    const Body &a = scene.bodies[joint.a], &b = scene.bodies[joint.b];
    if (a.collides && b.collides) BOOST_TEST(!scene.contact_law(joint.a, joint.b).collides, a.name << " " << b.name);
  }
  const auto index = [&](const std::string& name) {
    return static_cast<int>(&body_named(scene, name) - scene.bodies.data());
  };
  // Legs may touch each other.
  BOOST_TEST(scene.contact_law(index("FR_hip"), index("FL_hip")).collides);
}

// A link of another model, or a plane that is added later, meets all shapes. Links of one model never touch each other.
BOOST_AUTO_TEST_CASE(links_of_an_sdf_model_touch_each_other_only_if_it_says_so) {
  const auto model = [](const std::string& flag) {
    std::string text = "<model name='m'>" + flag;
    for (const char* x : {"0", "5"})
      text += std::string("<link name='l") + x + "'><pose>" + x + " 0 1 0 0 0</pose>" + kBoxInertial +
              "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>";
    return sdf_of(text + "</model>");
  };
  for (const auto& [flag, touches] : {std::pair{"", false}, {"<self_collide>1</self_collide>", true}}) {
    const Scene scene = scene_of_text("m.sdf", model(flag));
    BOOST_TEST((scene.bodies[0].collides && scene.bodies[1].collides));
    BOOST_TEST(scene.contact_law(0, 1).collides == touches);
  }
}

// The tensor of a plate needs izz <= ixx + iyy. In the space of the six numbers the nearest one shares the excess.
BOOST_AUTO_TEST_CASE(an_inertia_that_no_body_has_is_repaired_to_the_nearest_if_asked) {
  const Folder folder;
  const std::string path =
      folder.write("r.urdf",
                   "<robot name='r'><link name='a'><inertial><mass value='1'/>\n<inertia ixx='1' iyy='1' izz='2.3' "
                   "ixy='0' ixz='0' iyz='0'/></inertial></link></robot>");
  BOOST_CHECK_EXCEPTION(import_model(path), InputError, [](const InputError& error) {
    return std::string(error.what()).find("r.urdf:2: link 'a': <inertia>: no body has this inertia") !=
               std::string::npos &&
           std::string(error.what()).find("--repair-inertia") != std::string::npos;
  });
  const Import made = import_model(path, {.repair_inertia = true});
  const Mat3& inertia = made.scene.bodies.at(0).inertia;
  BOOST_TEST(why_no_inertia(inertia) == "");
  // Without the least thickness: (1.1, 1.1, 2.2), 0.17 away of 2.7. The thickness moves each by 0.1 % of their sum.
  BOOST_TEST((inertia - Mat3(Vec3(1.1, 1.1, 2.2).asDiagonal())).norm() < 3e-3 * 4.3 / 2);
  BOOST_TEST(some_has(sentences_of(made.losses), "--repair-inertia changed it by 6."));
  BOOST_TEST(losses_of(made.losses, LossKind::physical).empty());
}

// A tetrahedron as OBJ, scaled and mirrored; and as COLLADA in centimetres, moved by a node.
BOOST_AUTO_TEST_CASE(a_mesh_collides_as_the_hull_of_its_points) {
  const Folder folder;
  folder.write("robot/meshes/t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  folder.write("robot/meshes/t.dae",
               "<COLLADA><asset><unit meter='0.01'/></asset><library_geometries><geometry id='g'><mesh><source id='p'>"
               "<float_array>0 0 0 100 0 0 0 100 0 0 0 100</float_array></source><vertices id='v'><input "
               "semantic='POSITION' source='#p'/></vertices></mesh></geometry></library_geometries>"
               "<library_visual_scenes><visual_scene><node><translate>100 0 0</translate><instance_geometry "
               "url='#g'/></node></visual_scene></library_visual_scenes></COLLADA>");
  const auto hull = [&](const std::string& mesh) {
    const std::string path = folder.write(
        "robot/urdf/r.urdf",
        "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
        "iyz='0'/></inertial><collision><geometry>" +
            mesh + "</geometry></collision></link></robot>");
    const Import made = import_model(path);
    BOOST_TEST(losses_of(made.losses, LossKind::physical).empty());
    return volume_of(*made.scene.bodies.at(0).shape);
  };
  BOOST_TEST(std::abs(hull("<mesh filename='package://robot/meshes/t.obj'/>") - 1.0 / 6) < 1e-14);
  BOOST_TEST(std::abs(hull("<mesh filename='package://robot/meshes/t.obj' scale='-2 1 0.5'/>") - 1.0 / 6) < 1e-14);
  BOOST_TEST(std::abs(hull("<mesh filename='package://robot/meshes/t.dae'/>") - 1.0 / 6) < 1e-14);
  BOOST_CHECK_EXCEPTION(
      hull("<mesh filename='package://robot/../../secret.stl'/>"), InputError,
      [](const InputError& error) { return std::string(error.what()).find("leaves the folder") != std::string::npos; });
}

BOOST_AUTO_TEST_CASE(a_mesh_of_a_package_that_is_not_here_is_a_loss_of_physics) {
  const auto lost = physics_lost(
      "r.urdf",
      "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' "
      "ixz='0' iyz='0'/></inertial><collision><geometry>\n<mesh filename='package://else/a.stl'/></geometry>"
      "</collision></link></robot>");
  BOOST_TEST_REQUIRE(lost.size() == 1u);
  BOOST_TEST(some_has(
      lost, "r.urdf:2: link 'a': <mesh>: a mesh of another package: no folder above the model is the package 'else'"));
}

// Dummy roots: a vehicle of two wheels is free, an arm is bolted down. The import says which it took.
BOOST_AUTO_TEST_CASE(a_root_frame_without_mass_holds_an_arm_and_not_a_vehicle) {
  const auto link = [](const std::string& name) {
    return "<link name='" + name +
           "'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>";
  };
  const auto joint = [](const std::string& type, const std::string& a, const std::string& b) {
    return "<joint name='" + a + b + "' type='" + type + "'><parent link='" + a + "'/><child link='" + b +
           "'/></joint>";
  };
  const std::string arm = "<link name='root'/>" + link("base") + link("l") + joint("fixed", "root", "base") +
                          joint("continuous", "base", "l");
  const Scene held = scene_of_text("r.urdf", "<robot name='r'>" + arm + "</robot>");
  BOOST_TEST(held.bodies.size() == 1u);
  const std::string vehicle = arm + link("r") + joint("continuous", "base", "r");
  const Scene free = scene_of_text("r.urdf", "<robot name='r'>" + vehicle + "</robot>");
  BOOST_TEST(free.bodies.size() == 3u);
  BOOST_TEST(falls_freely(free) != "");
  BOOST_TEST(some_has(left_out_of_model("r.urdf", "<robot name='r'>" + arm + "</robot>"), "is held by the world"));
}

BOOST_AUTO_TEST_CASE(what_falls_without_end_is_found) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies.resize(3);
  scene.bodies[0].name = "a", scene.bodies[1].name = "b", scene.bodies[2].name = "c";
  BOOST_TEST(falls_freely(scene) == "a");
  scene.joints = {{1, 2, FixedJoint{}}, {0, 1, BallJoint{Vec3::Zero()}}, {kWorld, 2, BallJoint{Vec3::Zero()}}};
  BOOST_TEST(falls_freely(scene) == "");
  scene.joints.pop_back();
  scene.springs = {{0, kWorld}};
  BOOST_TEST(falls_freely(scene) == "");
  scene.springs.clear();
  scene.bodies[2].fixed = true;
  BOOST_TEST(falls_freely(scene) == "");
  scene.joints.clear();
  BOOST_TEST(falls_freely(scene) == "a");
  scene.bodies[2].collides = true;  // a ground
  BOOST_TEST(falls_freely(scene) == "");
  scene.bodies[2].collides = false, scene.gravity.setZero();
  BOOST_TEST(falls_freely(scene) == "");
}

BOOST_AUTO_TEST_CASE(sdf_and_urdf_of_the_same_pendulum_are_the_same_scene) {
  const Scene urdf = scene_of_file(kModels + "double_pendulum.urdf"),
              sdf = scene_of_file(kModels + "double_pendulum.sdf");
  BOOST_TEST_REQUIRE(urdf.bodies.size() == 2u);
  BOOST_TEST_REQUIRE(sdf.bodies.size() == 2u);
  for (const Body& a : urdf.bodies) {
    const Body& b = body_named(sdf, a.name);
    BOOST_TEST(apart(a.position, b.position) < 1e-14);
    BOOST_TEST(angle_between(a.orientation, b.orientation) < 1e-14);
    BOOST_TEST((a.inertia - b.inertia).cwiseAbs().maxCoeff() < 1e-14);
    BOOST_TEST(a.mass == b.mass);
  }
  for (const Joint& a : urdf.joints) {
    const Joint& b = joint_named(sdf, a.name);
    BOOST_TEST(urdf.body_name(a.a) == sdf.body_name(b.a));
    BOOST_TEST(urdf.body_name(a.b) == sdf.body_name(b.b));
    BOOST_TEST(apart(std::get<HingeJoint>(a.type).anchor, std::get<HingeJoint>(b.type).anchor) < 1e-14);
    BOOST_TEST(apart(std::get<HingeJoint>(a.type).axis, std::get<HingeJoint>(b.type).axis) < 1e-14);
    BOOST_TEST(a.damping == b.damping);
    BOOST_TEST(!b.has_limits());
  }
}

BOOST_AUTO_TEST_CASE(shapes_stand_where_they_are_on_one_body_with_the_link_s_mass_and_inertia) {
  const auto part = [](const std::string& name, const std::string& pose, const std::string& shape) {
    return "<collision name='" + name + "'><pose>" + pose + "</pose><geometry>" + shape + "</geometry></collision>";
  };
  const Scene scene = scene_of_text(
      "w.sdf",
      sdf_of("<model name='floor'><static>1</static><link name='l'><collision name='c'><pose>0 0 0.1 0 0 "
             "0</pose><geometry><plane/></geometry></collision></link></model><model name='thing'><pose>0 0 2 0.3 0 "
             "0</pose><link name='l'>" +
             kBoxInertial + part("ball", "0 0 -0.35 0 0 0", "<sphere><radius>0.1</radius></sphere>") +
             part("box", "0 0 0 0 0 0", "<box><size>0.4 0.4 0.4</size></box>") +
             part("can", "0.2 0 0 0 0 0", "<cylinder><radius>0.1</radius><length>0.3</length></cylinder>") +
             "</link></model>"));
  BOOST_TEST_REQUIRE(scene.bodies.size() == 2u);
  const Body& floor = body_named(scene, "floor::l");
  BOOST_TEST(std::get<Plane>(*floor.shape).offset == 0.1);
  BOOST_TEST((floor.fixed && floor.collides));
  const Body& thing = body_named(scene, "thing::l");
  BOOST_TEST(thing.mass == 2);
  BOOST_TEST((thing.inertia - 2 * 0.16 / 6 * Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14);
  const auto& parts = std::get<Compound>(*thing.shape).parts;
  BOOST_TEST_REQUIRE(parts.size() == 3u);
  BOOST_TEST((std::holds_alternative<Sphere>(parts[0].shape) && std::holds_alternative<Cylinder>(parts[2].shape)));
  BOOST_TEST(apart(parts[0].pose.position, {0, 0, -0.35}) < 1e-14);
  BOOST_TEST(apart(parts[2].pose.position, {0.2, 0, 0}) < 1e-14);
  BOOST_TEST(scene.contact_default.friction == 1.0);  // which the format takes where nothing is said
}

// 1 kg at the origin with an inertia, and a point of 3 kg two metres along x: the centre of mass is at 1.5 m, and the
// inertia has Steiner's part.
BOOST_AUTO_TEST_CASE(a_point_of_mass_on_a_fixed_joint_adds_to_the_link_that_carries_it) {
  const auto link = [](const std::string& name, const std::string& mass, const std::string& moment) {
    return "<link name='" + name + "'><inertial><mass value='" + mass + "'/><inertia ixx='" + moment + "' iyy='" +
           moment + "' izz='" + moment +
           "' ixy='0' ixz='0' iyz='0'/></inertial><collision><geometry><sphere "
           "radius='0.1'/></geometry></collision></link>";
  };
  const Scene scene = scene_of_text("r.urdf", "<robot name='r'>" + link("a", "1", "1") + link("b", "3", "0") +
                                                  "<joint name='j' type='fixed'><parent link='a'/><child "
                                                  "link='b'/><origin xyz='2 0 0'/><axis xyz='0 0 0'/></joint></robot>");
  BOOST_TEST_REQUIRE(scene.bodies.size() == 1u);
  BOOST_TEST(scene.joints.empty());
  BOOST_TEST(scene.bodies[0].mass == 4);
  BOOST_TEST(apart(scene.bodies[0].position, {1.5, 0, 0}) < 1e-15);
  const double steiner = 1 * 1.5 * 1.5 + 3 * 0.5 * 0.5;
  BOOST_TEST((scene.bodies[0].inertia - Mat3(Vec3(1, 1 + steiner, 1 + steiner).asDiagonal())).norm() < 1e-14);
  BOOST_TEST(std::get<Compound>(*scene.bodies[0].shape).parts.size() == 2u);
  // A point alone cannot be a body.
  BOOST_TEST(
      refusal_of("r.urdf", "<robot name='r'>" + link("a", "1", "0") + "</robot>").find("r.urdf:1: link 'a': no body") ==
      0);
}

// A chain of boxes that reach into each other, as links of robots do: all land on the floor, and none on another.
BOOST_AUTO_TEST_CASE(links_that_overlap_collide_with_the_floor_and_not_with_each_other) {
  std::string links;
  for (int k = 0; k < 3; ++k) {
    links += "<link name='l" + std::to_string(k) + "'><pose>" + std::to_string(0.3 * k) + " 0 1 0 0 0</pose>" +
             kBoxInertial +
             "<collision name='c'><geometry><box><size>0.4 0.4 0.4</size></box></geometry></collision></link>";
    if (k > 0) {
      links += "<joint name='j" + std::to_string(k) + "' type='revolute'><parent>l" + std::to_string(k - 1) +
               "</parent><child>l" + std::to_string(k) + "</child><axis><xyz>0 1 0</xyz></axis></joint>";
    }
  }
  const std::string text = sdf_of(
      "<model name='floor'><static>true</static><link name='l'><collision "
      "name='c'><geometry><plane/></geometry></collision></link></model>"
      "<model name='chain'>" +
      links + "</model>");
  const Scene scene = scene_of_text("w.sdf", text);
  BOOST_TEST_REQUIRE(scene.bodies.size() == 4u);
  int floor = 0;
  while (!scene.bodies[floor].fixed) ++floor;
  for (int a = 0; a < 4; ++a) {
    BOOST_TEST(scene.bodies[a].collides);
    for (int b = 0; b < a; ++b) BOOST_TEST(scene.contact_law(a, b).collides == (a == floor || b == floor));
  }
}

// The file does not say that the shin may not touch the trunk. They overlap from the start, so they never do.
BOOST_AUTO_TEST_CASE(links_of_a_urdf_that_overlap_at_the_start_never_touch_and_it_is_named) {
  const auto link = [](const std::string& name) {
    return "<link name='" + name +
           "'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
           "<collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
  };
  const auto joint = [](const std::string& name, const std::string& a, const std::string& b, const std::string& x) {
    return "<joint name='" + name + "' type='continuous'><parent link='" + a + "'/><child link='" + b +
           "'/><origin xyz='" + x + " 0 0'/></joint>";
  };
  const std::string text = "<robot name='r'>" + link("trunk") + link("thigh") + link("shin") + link("foot") +
                           joint("a", "trunk", "thigh", "0.08") + joint("b", "thigh", "shin", "0.08") +
                           joint("c", "shin", "foot", "0.3") + "</robot>";
  const Scene scene = scene_of_text("r.urdf", text);
  BOOST_TEST(!scene.contact_law(0, 2).collides);
  BOOST_TEST(
      (!scene.contact_law(0, 1).collides && scene.contact_law(0, 3).collides && scene.contact_law(1, 3).collides));
  BOOST_TEST(
      some_has(left_out_of_model("r.urdf", text), "touching: overlaps 'shin' at the start: these two never touch"));
}

BOOST_AUTO_TEST_CASE(sdf_takes_universal_ball_and_spring_and_models_in_models) {
  const std::string link = "<link name='b'><pose>0 0 1 0 0 0</pose>" + kBoxInertial + "</link>";
  const Scene scene = scene_of_text(
      "w.sdf", sdf_of("<gravity>0 -3 0</gravity><model name='m'><link name='a'>" + kBoxInertial +
                      "</link><model name='in'><pose relative_to='a'>1 0 0 0 0 0</pose>" + link +
                      "</model><joint name='u' type='universal'><parent>a</parent><child>in::b</child><axis><xyz>1 0 "
                      "0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2></joint>"
                      "<joint name='s' type='prismatic'><parent>world</parent><child>a</child><axis><xyz "
                      "expressed_in='__model__'>0 0 1</xyz><dynamics><spring_stiffness>7</spring_stiffness>"
                      "<spring_reference>-0.2</spring_reference></dynamics></axis></joint></model>"));
  BOOST_TEST(apart(scene.gravity, {0, -3, 0}) == 0);
  BOOST_TEST(apart(body_named(scene, "in::b").position, {1, 0, 1}) < 1e-14);
  const auto& universal = std::get<UniversalJoint>(joint_named(scene, "u").type);
  BOOST_TEST(apart(universal.anchor, {1, 0, 1}) < 1e-14);
  BOOST_TEST((joint_named(scene, "s").stiffness == 7 && joint_named(scene, "s").rest == -0.2));
}

// Parts from files of simulators: a rail of mass 0, and a matrix with both halves.
BOOST_AUTO_TEST_CASE(a_mass_of_zero_is_none_and_half_a_matrix_is_enough) {
  const std::string rail =
      "<robot name='r'><link name='rail'><inertial><mass value='0'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
      "izz='1'/></inertial></link><link name='cart'><inertial><mass value='2'/><inertia ixx='1' ixy='0.1' ixz='0.2' "
      "iyx='0' iyy='2' iyz='0.3' izx='0' izy='0' izz='2.5'/></inertial></link><joint name='j' "
      "type='continuous'><parent "
      "link='rail'/><child link='cart'/></joint></robot>";
  const Scene scene = scene_of_text("r.urdf", rail);
  BOOST_TEST_REQUIRE(scene.bodies.size() == 1u);
  BOOST_TEST(scene.joints[0].a == kWorld);
  BOOST_TEST((scene.bodies[0].inertia(0, 1) == 0.1 && scene.bodies[0].inertia(2, 0) == 0.2));
  const auto left_out = left_out_of_model("r.urdf", rail);
  for (const char* part : {"link 'rail': <mass>: its inertia: a mass of 0 is none", "'iyx'", "'izx'", "'izy'"})
    BOOST_TEST(some_has(left_out, part), part);
}

// What a scene's bodies do anyway is not named, so that what they do not do can be seen.
BOOST_AUTO_TEST_CASE(only_flags_that_a_scene_does_not_keep_are_named) {
  const auto left_out = [](const std::string& flags) {
    return left_out_of_model("m.sdf",
                             sdf_of("<model name='m'><link name='l'>" + flags + kBoxInertial + "</link></model>"));
  };
  BOOST_TEST(left_out("<gravity>1</gravity><kinematic>0</kinematic><self_collide>false</self_collide>").empty());
  const auto named = left_out("<gravity>false</gravity><kinematic>1</kinematic><enable_wind>true</enable_wind>");
  for (const char* part : {"<kinematic>", "<enable_wind>"}) BOOST_TEST(some_has(named, part), part);
  // A link without weight is one that a constant force carries.
  const Scene floating = scene_of_text(
      "m.sdf", sdf_of("<model name='m'><link name='l'><gravity>0</gravity>" + kBoxInertial + "</link></model>"));
  BOOST_TEST_REQUIRE(floating.forces.size() == 1u);
  BOOST_TEST(apart(floating.forces[0].force, {0, 0, 2 * 9.8}) < 1e-14);
}

BOOST_AUTO_TEST_CASE(a_file_may_include_another_one_of_its_folder) {
  const Folder folder;
  folder.write("parts/leg.sdf",
               "<sdf version='1.7'><model name='leg'><link name='l'>" + kBoxInertial + "</link></model></sdf>");
  const std::string path = folder.write(
      "w.sdf", sdf_of("<include><uri>parts/leg.sdf</uri><name>left</name><pose>0 1 0 0 0 0</pose></include>"
                      "<include><uri>parts/leg.sdf</uri><name>right</name></include>"));
  const Scene scene = scene_of_file(path);
  BOOST_TEST(apart(body_named(scene, "left::l").position, {0, 1, 0}) == 0);
  BOOST_TEST(apart(body_named(scene, "right::l").position, {0, 0, 0}) == 0);
}

BOOST_AUTO_TEST_CASE(twenty_thousand_links_take_seconds) {
  std::string text = "<robot name='r'><link name='l0'/>";
  for (int k = 1; k <= 20000; ++k) {
    const std::string n = std::to_string(k);
    text += "<link name='l" + n +
            "'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
            "iyz='0'/></inertial></link><joint name='j" +
            n + "' type='continuous'><parent link='l" + std::to_string(k - 1) + "'/><child link='l" + n +
            "'/><origin xyz='0 0 1'/></joint>";
  }
  const Folder folder;
  const std::string path = folder.write("long.urdf", text + "</robot>");
  const std::clock_t start = std::clock();
  BOOST_TEST(case_text_of(import_model(path)).size() > 1000000u);
  // Time that grew with the square of the links would be minutes.
  BOOST_TEST(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC < 10);
}

BOOST_AUTO_TEST_SUITE_END()
