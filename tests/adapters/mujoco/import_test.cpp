// Compares MuJoCo's own loader with our import of the same file. Both use the same scheme, so every difference comes
// from the import.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <boost/test/unit_test.hpp>
#include <ctime>
#include <numbers>

#include "adapters/models.h"
#include "adapters/mujoco/mujoco_library.h"
#include "generated/tests/places.h"
#include "tests/adapters/loaded_alike.h"
#include "tests/cases/import/imported.h"
#include "tests/cases/judged.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(adapters_mujoco_import)

namespace {

const std::string kModels = RIGOR_SOURCE_DIR "/tests/cases/import/models/";

// MuJoCo's loader reads the file, without limits, which are soft there, and without contacts.
struct Own {
  mujoco_library::Model model;
  mujoco_library::Data data;

  explicit Own(const std::string& path) {
    mujoco_library::start();
    char error[1000] = "";
    model.reset(mj_loadXML(path.c_str(), nullptr, error, sizeof error));
    BOOST_TEST_REQUIRE((model != nullptr), error);
    model->opt.timestep = kLoadedStep, model->opt.integrator = mjINT_EULER;
    model->opt.disableflags |= mjDSBL_LIMIT | mjDSBL_CONTACT;
    data.reset(mj_makeData(model.get()));
    mj_forward(model.get(), data.get());
  }
  // Starts from this keyframe.
  void start(int keyframe) {
    mj_resetDataKeyframe(model.get(), data.get(), keyframe);
    mj_forward(model.get(), data.get());
  }
  void step() { mj_step(model.get(), data.get()); }
  void place() { mj_kinematics(model.get(), data.get()); }
  int body(const std::string& name) const { return mj_name2id(model.get(), mjOBJ_BODY, name.c_str()); }
  bool has(const std::string& name) const { return body(name) > 0; }
  Vec3 centre(const std::string& name) const { return Eigen::Map<const Vec3>(data->xipos + 3 * body(name)); }
  Quat turn(const std::string& name) const {
    const mjtNum* q = data->xquat + 4 * body(name);
    return {q[0], q[1], q[2], q[3]};
  }
};

void check_start(const Own& own, const Scene& scene) {
  for (const Body& body : scene.bodies) {
    BOOST_TEST((own.centre(body.name) - body.position).norm() < 1e-14, body.name);
    mjtNum velocity[6];  // angular, then linear, of the centre of mass
    mj_objectVelocity(own.model.get(), own.data.get(), mjOBJ_BODY, own.body(body.name), velocity, 0);
    BOOST_TEST((Eigen::Map<Vec3>(velocity) - body.angular_velocity).norm() < 1e-12, body.name);
    BOOST_TEST((Eigen::Map<Vec3>(velocity + 3) - body.velocity).norm() < 1e-12, body.name);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(its_own_loader_and_our_import_move_alike) {
  for (const char* file : {"mechanism.xml", "arm.urdf", "double_pendulum.urdf"}) {
    Own own(kModels + file);
    Scene scene = without_limits(scene_of_file(kModels + file));
    for (Body& body : scene.bodies) body.collides = false;
    scene.contact_pairs.clear();
    check_alike(file, apart_after(own, "mujoco", scene, 1));
  }
}

// Its Newton solver and ours are not asked: nothing touches and no loop is closed.
BOOST_AUTO_TEST_CASE(a_case_that_is_exported_starts_and_moves_there_as_it_does_here) {
  const std::string suite = RIGOR_SOURCE_DIR "/cases/suite/";
  for (const char* id : {"joints/double-pendulum", "joints/cart-pendulum", "joints/slider-oscillator",
                         "springs/body-springs", "ballistic/fast-spin"}) {
    const Scene scene = read_case(suite + id + ".toml", id, words()).scene;
    LeftOut left_out;
    const Folder folder;
    const std::string path = folder.write("case.xml", mjcf_of(scene, left_out));
    BOOST_TEST(left_out.sentences().empty(), id);
    Own own(path);
    if (own.model->nkey > 0) mj_resetDataKeyframe(own.model.get(), own.data.get(), 0);
    mj_forward(own.model.get(), own.data.get());
    check_start(own, scene);
    check_alike(id, apart_after(own, "mujoco", scene, 1));
  }
}

// Friction comes back from the file that it was written to.
BOOST_AUTO_TEST_CASE(friction_of_a_joint_is_exported) {
  const std::string suite = RIGOR_SOURCE_DIR "/cases/suite/";
  const Scene scene = read_case(suite + "drives/friction-slider.toml", "drives/friction-slider", words()).scene;
  LeftOut left_out;
  const Folder folder;
  const Scene back = scene_of_file(folder.write("case.xml", mjcf_of(scene, left_out)));
  BOOST_TEST(left_out.sentences().empty());
  BOOST_TEST_REQUIRE(back.motors.size() == 1u);
  BOOST_TEST((back.motors[0].is_friction && back.motors[0].most == 5));
}

// Two balls and a ground whose margins add up, or of which the larger counts: each is larger by its share. A box has
// sharp edges then, which is said; an ellipsoid would be no ellipsoid.
BOOST_AUTO_TEST_CASE(a_margin_makes_shapes_larger) {
  const auto text = [](const std::string& geom, const std::string& of_ground) {
    return R"(<mujoco><worldbody><geom type="plane" size="1 1 1" pos="0 0 -1" margin=")" + of_ground +
           R"("/><body pos="0 0 1"><freejoint/><geom )" + geom + R"( margin="0.02"/></body></worldbody></mujoco>)";
  };
  const Scene ball = scene_of_text("m.xml", text("size='0.1'", "0.02"));
  const double gap =
      std::get<Sphere>(*ball.bodies[0].shape).radius - 0.1 + std::get<Plane>(*ball.bodies[1].shape).offset + 1;
  BOOST_TEST(std::abs(gap - 0.02) < 1e-15);  // MuJoCo 2.2.2 takes the larger margin of the two
  BOOST_TEST(std::abs(ball.bodies[0].mass - 1000 * 4.0 / 3 * std::numbers::pi * 1e-3) < 1e-12);  // of the ball as drawn
  const std::string box = text("type='box' size='0.1 0.1 0.1'", "0.02");
  BOOST_TEST(some_has(left_out_of_model("m.xml", box), "its edges stay sharp"));
  BOOST_TEST(physics_lost("m.xml", box).empty());
  BOOST_TEST(some_has(physics_lost("m.xml", text("type='ellipsoid' size='0.1 0.2 0.3'", "0.02")), "a margin"));
  BOOST_TEST(some_has(physics_lost("m.xml", text("size='0.1'", "0.01")), "takes the larger of two"));
}

// A pair has the larger numbers of both geoms, and the larger number of dimensions says which count.
BOOST_AUTO_TEST_CASE(torsional_and_rolling_friction_are_imported) {
  const auto law = [](const std::string& of_ball) {
    const Scene scene =
        scene_of_text("m.xml", R"(<mujoco><worldbody><geom type="plane" size="1 1 1" friction="0.5 0.01 0.002"/>
          <body pos="0 0 1"><freejoint/><geom size="0.1" )" +
                                   of_ball + R"(/></body></worldbody></mujoco>)");
    return scene.contact_law(0, 1);
  };
  const ContactLaw six = law(R"(condim="6" friction="0.8 0.003 0.004")");
  BOOST_TEST((six.friction == 0.8 && six.torsional_friction == 0.01 && six.rolling_friction == 0.004));
  const ContactLaw four = law(R"(condim="4" friction="0.8 0.003 0.004")");
  BOOST_TEST((four.friction == 0.8 && four.torsional_friction == 0.01 && four.rolling_friction == 0));
  const ContactLaw three = law(R"(condim="1" friction="0.8 0.003 0.004")");
  BOOST_TEST((three.friction == 0.8 && three.torsional_friction == 0 && three.rolling_friction == 0));
  const ContactLaw chosen = law(R"(condim="1" priority="1")");
  BOOST_TEST((chosen.friction == 0 && chosen.torsional_friction == 0));
}

// A motor, a servo, and a servo whose control its range cuts off, as their keyframe controls them.
const std::string kControlled = R"(<mujoco><compiler angle="radian" autolimits="false"/><worldbody>
  <body name="a" pos="0 0 1"><joint name="ja" axis="0 1 0"/><inertial pos="0.3 0 0" mass="2" diaginertia="0.2 0.25 0.1"/></body>
  <body name="b" pos="0 1 1"><joint name="jb" axis="0 1 0" damping="0.1" limited="true" range="-1 2.5"/><inertial pos="0.3 0 0" mass="1" diaginertia="0.1 0.12 0.05"/></body>
  <body name="c" pos="0 2 1"><joint name="jc" type="slide" axis="1 0 0"/><inertial pos="0.1 0 0" mass="3" diaginertia="0.1 0.2 0.15"/></body>
  </worldbody>
  <actuator><motor name="push" joint="ja" gear="3"/><position name="servo" joint="jb" kp="12" gear="0.5"/>
    <position name="cut" joint="jc" kp="7" ctrllimited="true" ctrlrange="-0.1 0.1"/></actuator>
  <keyframe><key name="held" qpos="0.1 -0.2 0.05" ctrl="0.4 0.9 2"/></keyframe></mujoco>)";

BOOST_AUTO_TEST_CASE(a_keyframe_s_control_drives_the_scene_as_it_drives_mujoco) {
  const Folder folder;
  const std::string path = folder.write("m.xml", kControlled);
  const Import made = import_model(path, {.keyframe = "held"});
  BOOST_TEST(losses_of(made.losses, LossKind::physical).empty());
  const Scene scene = read_case_text(case_text_of(made), path, path, words()).scene;
  BOOST_TEST_REQUIRE(scene.motors.size() == 3u);
  BOOST_TEST(std::abs(scene.motors[0].effort - 1.2) < 1e-15);  // gain 1 × control 0.4 × gear 3
  Own own(path);
  own.start(0);
  check_alike("m.xml", apart_after(own, "mujoco", without_limits(scene), 1));
  // The model's own state has no control, and the notice says so.
  BOOST_TEST(some_has(sentences_of(import_model(path).losses), "actuator 'push': a drive: has control 0"));
}

// A leg of three hinges with drives that act on sums of its angles, which start away from zero.
std::string leg_with(const std::string& more) {
  return R"(<mujoco><compiler angle="radian"/><worldbody>
  <body name="hip" pos="0 0 2"><joint name="a" axis="0 1 0" range="-2 2" limited="true"/>
    <inertial pos="0.1 0 -0.3" mass="2" diaginertia="0.05 0.06 0.02"/>
    <body name="shin" pos="0 0 -0.5"><joint name="b" axis="0 -1 0" range="-2 2" limited="true" damping="0.3"/>
      <inertial pos="0 0 -0.2" mass="1" diaginertia="0.02 0.02 0.01"/>
      <body name="foot" pos="0 0 -0.4"><joint name="c" axis="0 1 0" range="-2 2" limited="true"/>
        <inertial pos="0.1 0 0" mass="0.4" diaginertia="0.003 0.004 0.003"/></body></body></body></worldbody>
  <tendon><fixed name="lift"><joint joint="a" coef="0.5"/><joint joint="c" coef="-0.25"/></fixed>
    <fixed name="sum"><joint joint="a" coef="0.4"/><joint joint="b" coef="-0.8"/><joint joint="c" coef="0.2"/></fixed></tendon>)" +
         more + R"(<keyframe><key name="bent" qpos="0.3 0.2 0.2" ctrl="3"/></keyframe></mujoco>)";
}

BOOST_AUTO_TEST_CASE(a_servo_over_a_tendon_drives_the_scene_as_it_drives_mujoco) {
  const Folder folder;
  const std::string path = folder.write(
      "leg.xml", leg_with(R"(<actuator><general name="m" tendon="lift" gear="2" gainprm="9" biastype="affine"
                             biasprm="0.3 -30 -0.7"/></actuator>)"));
  const Import made = import_model(path, {.keyframe = "bent"});
  BOOST_TEST(losses_of(made.losses, LossKind::physical).empty());
  const Scene scene = read_case_text(case_text_of(made), path, path, words()).scene;
  BOOST_TEST_REQUIRE(scene.motors.size() == 1u);
  BOOST_TEST_REQUIRE(scene.motors[0].plus.size() == 1u);
  BOOST_TEST(scene.motors[0].plus[0].ratio == -0.5);
  BOOST_TEST(scene.motors[0].servo->kp == 30);  // times the square of the gear and the first coefficient
  for (const char* engine : {"mujoco", "mujoco:euler,servo=native"}) {
    Own own(path);
    own.start(0);
    check_alike(engine, apart_after(own, engine, scene, 1));
  }
}

BOOST_AUTO_TEST_CASE(an_equality_of_a_tendon_couples_all_its_joints) {
  const std::string equality = R"(<equality><tendon tendon1="sum"/></equality><actuator><motor joint="a"/></actuator>)";
  const Folder folder;
  const std::string path = folder.write("leg.xml", leg_with(equality));
  const Import made = import_model(path, {.keyframe = "bent"});  // 0.4 0.3 - 0.8 0.2 + 0.2 0.2 = 0
  BOOST_TEST(losses_of(made.losses, LossKind::physical).empty());
  const Scene scene = read_case_text(case_text_of(made), path, path, words()).scene;
  BOOST_TEST_REQUIRE(scene.couplings.size() == 1u);
  const Coupling& row = scene.couplings[0];
  BOOST_TEST(scene.joints[static_cast<std::size_t>(row.joint)].name == "a");
  BOOST_TEST_REQUIRE(row.to.size() == 2u);
  BOOST_TEST((std::abs(row.to[0].ratio - 2) < 1e-15 && std::abs(row.to[1].ratio + 0.5) < 1e-15));
  const std::string open = leg_with(R"(<equality><tendon tendon1="sum" polycoef="0.1 1 0 0 0"/></equality>
                                       <actuator><motor joint="a"/></actuator>)");
  BOOST_CHECK_EXCEPTION(import_model(folder.write("open.xml", open), {.keyframe = "bent"}), InputError,
                        says("is open by 0.25"));
}

BOOST_AUTO_TEST_CASE(a_bounded_servo_over_a_tendon_is_a_loss) {
  const auto lost = physics_lost("leg.xml", leg_with(R"(<actuator><position name="m" tendon="lift" kp="9"
                                                          forcelimited="true" forcerange="-1 1"/></actuator>)"));
  BOOST_TEST(some_has(lost, "actuator 'm': a drive: is a servo over a tendon with a bound of its force"));
}

const std::string kBent = R"(<mujoco><compiler angle="radian" autolimits="false"/><worldbody>
  <body name="upper" pos="0 0 2"><joint name="shoulder" axis="0 1 0" range="-1 2" limited="true" stiffness="3"/>
    <inertial pos="0.1 0 -0.5" mass="2" fullinertia="0.2 0.25 0.1 0.01 0 0"/>
    <body name="lower" pos="0 0 -1"><joint name="elbow" type="ball" damping="0"/>
      <inertial pos="0 0.05 -0.4" mass="1" diaginertia="0.1 0.12 0.02"/></body></body>
  <body name="free" pos="3 0 1"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="0.1 0.2 0.25"/></body>
</worldbody>
<keyframe><key name="home"/><key name="bent" qpos="0.4 0.9 0.3 -0.2 0.1 4 1 2 0.8 0 0.6 0" qvel="1 0.5 -0.3 0.2 1 2 3 0.4 0.5 0.6"/>
</keyframe></mujoco>)";

// Positions and velocities, of a body that is free and of some that hang together; a scene's joint counts from there.
BOOST_AUTO_TEST_CASE(a_keyframe_is_a_state_to_start_from) {
  const Folder folder;
  const std::string path = folder.write("bent.xml", kBent);
  const Scene scene = read_case_text(case_text_of(import_model(path, {.keyframe = "bent"})), path, path, words()).scene;
  Own own(path);
  own.start(1);
  check_start(own, scene);
  BOOST_TEST(body_named(scene, "free").angular_velocity.norm() > 0.5);
  BOOST_TEST(std::abs(joint_named(scene, "shoulder").upper - 1.6) < 1e-15);
  BOOST_TEST(std::abs(joint_named(scene, "shoulder").rest + 0.4) < 1e-15);
  check_alike("bent", apart_after(own, "mujoco", without_limits(scene), 1));
  BOOST_TEST(scene_of_file(path).bodies[0].velocity.isZero(0));  // the model's own is at rest
  BOOST_CHECK_EXCEPTION(import_model(path, {.keyframe = "bend"}), InputError,
                        says("has no keyframe 'bend' (did you mean 'bent'?)"));
  BOOST_CHECK_EXCEPTION(import_model(kModels + "arm.urdf", {.keyframe = "home"}), InputError,
                        says("a file of this format has none"));
}

// A later joint of a body does not turn the axes of those before it. At this start the body's frame has all three
// turns.
const std::string kThreeAxes = R"(<mujoco><compiler angle="radian" autolimits="false"/><worldbody>
  <body name="carried" pos="0 0 2"><joint name="along" type="slide" axis="1 0 0.5"/><joint name="about" axis="0 0 1"/>
    <inertial pos="0.1 0 -0.2" mass="2" fullinertia="0.2 0.25 0.1 0.01 0 0"/>
    <body name="waist" pos="0 0 -0.5"><joint name="z" axis="0 0 1" pos="0 0 0.1" damping="0.2"/>
      <joint name="y" axis="0 1 0.2" pos="0 0 0.1" stiffness="4" limited="true" range="-2 2"/><joint name="x" axis="1 0 0" armature="0.02"/>
      <inertial pos="0 0.05 -0.4" mass="1" diaginertia="0.1 0.12 0.02"/></body></body></worldbody>
  <actuator><motor joint="z" gear="2"/><position joint="y" kp="3"/></actuator>
  <keyframe><key name="bent" qpos="0.2 0.7 0.5 -0.8 0.9" qvel="0.3 -0.4 1 0.5 -0.6" ctrl="0.5 0.3"/></keyframe></mujoco>)";

BOOST_AUTO_TEST_CASE(joints_in_series_start_about_the_axes_that_the_state_gives_them) {
  const Folder folder;
  const std::string path = folder.write("three.xml", kThreeAxes);
  const Import made = import_model(path, {.keyframe = "bent"});
  BOOST_TEST(losses_of(made.losses, LossKind::physical).empty());
  const Scene scene = read_case_text(case_text_of(made), path, path, words()).scene;
  Own own(path);
  own.start(0);
  check_start(own, scene);
  check_alike("three.xml", apart_after(own, "mujoco", without_limits(scene), 1));
}

// A scene's joints would hold the bodies as they find them, apart.
BOOST_AUTO_TEST_CASE(a_keyframe_at_which_a_loop_is_open_is_refused) {
  const auto with = [](const std::string& equality) {
    return R"(<mujoco><worldbody><body name="a"><joint axis="0 1 0"/><inertial pos="0 0 -1" mass="1" diaginertia="1 1 1"/></body>
      <body name="b" pos="0 0 -2"><joint axis="1 0 0"/><inertial pos="0 0 -1" mass="1" diaginertia="1 1 1"/></body></worldbody>
      <equality>)" +
           equality +
           R"(</equality><keyframe><key name="shut" qpos="0 0"/><key name="open" qpos="0.1 0"/></keyframe></mujoco>)";
  };
  for (const char* equality : {R"(<connect body1="a" body2="b" anchor="0 0 -2"/>)", R"(<weld body1="a" body2="b"/>)"}) {
    const Folder folder;
    const std::string path = folder.write("loop.xml", with(equality));
    BOOST_CHECK_NO_THROW(import_model(path, {.keyframe = "shut"}));
    BOOST_CHECK_EXCEPTION(import_model(path, {.keyframe = "open"}), InputError, says("is open by"));
  }
}

// MuJoCo's own reader would not take the file either.
BOOST_AUTO_TEST_CASE(a_chain_that_mjcf_cannot_nest_is_refused) {
  const Scene scene = read_case(RIGOR_SOURCE_DIR "/cases/suite/joints/cable-100.toml", "cable", words()).scene;
  LeftOut left_out;
  BOOST_CHECK_EXCEPTION(mjcf_of(scene, left_out), InputError, says("hangs on 95 others; no file of MJCF holds it"));
}

BOOST_AUTO_TEST_CASE(the_compiled_model_comes_with_all_that_a_scene_can_say) {
  const Scene scene = scene_of_file(kModels + "mechanism.xml");
  BOOST_TEST(scene.bodies.size() == 7u);
  BOOST_TEST(joint_named(scene, "shoulder").stiffness == 4);
  BOOST_TEST(joint_named(scene, "shoulder").rest == 0.3);
  // It counts from where it is at t = 0, which the file calls 0.2.
  BOOST_TEST(std::abs(joint_named(scene, "rail").rest - 0.3) < 1e-15);
  BOOST_TEST(std::holds_alternative<BallJoint>(joint_named(scene, "wrist").type));
  BOOST_TEST(std::holds_alternative<UniversalJoint>(joint_named(scene, "tilt").type));
  BOOST_TEST_REQUIRE(scene.motors.size() == 1u);
  BOOST_TEST(scene.motors[0].servo->kp == 3);  // times the square of the gear
  BOOST_TEST_REQUIRE(scene.springs.size() == 1u);
  BOOST_TEST((scene.springs[0].stiffness == 50 && scene.springs[0].rest_length == 1.5));
  BOOST_TEST((scene.gravity - Vec3(0.3, -0.2, -9.7)).norm() == 0);
}

BOOST_AUTO_TEST_CASE(what_it_says_and_a_scene_does_not_is_named) {
  const std::string text =
      R"(<mujoco><compiler angle="radian"/><worldbody><geom name="floor" type="plane" size="1 1 1"/><body name="b" pos="0 0 1">
    <joint name="j" type="hinge" axis="0 1 0" armature="0.1" frictionloss="0.2" range="-0.5 0.7" limited="true"/>
    <geom name="c" type="cylinder" size="0.1 0.2"/></body></worldbody><actuator><motor name="m" joint="j"/></actuator></mujoco>)";
  const auto left_out = left_out_of_model("m.xml", text);
  BOOST_TEST(some_has(left_out, "actuator 'm': a drive: has control 0"));
  BOOST_TEST_REQUIRE(scene_of_text("m.xml", text).motors.size() == 1u);
  BOOST_TEST(
      (scene_of_text("m.xml", text).motors[0].is_friction && scene_of_text("m.xml", text).motors[0].most == 0.2));
  const Joint joint = joint_named(scene_of_text("m.xml", text), "j");
  BOOST_TEST((joint.lower == -0.5 && joint.upper == 0.7));
  BOOST_TEST(refusal_of("m.xml", "<mujoco>\n<worldbody>\n<boddy/></worldbody></mujoco>")
                 .starts_with("m.xml:3: MuJoCo refuses the model: "));
}

// Both worlds belong to one model, so a setting that is off in only one of them would change the motion.
BOOST_AUTO_TEST_CASE(what_a_file_switches_off_is_not_in_the_scene) {
  const auto with = [](const std::string& flags) {
    return "<mujoco><option><flag " + flags + R"(/></option><worldbody>
      <geom name="floor" type="plane" size="1 1 1"/>
      <body name="a" pos="0 0 1"><joint name="j" axis="0 1 0" stiffness="30" springref="60" damping="0.4" limited="true" range="-10 10" frictionloss="1"/>
        <geom name="g" type="capsule" fromto="0 0 0 0.4 0 0" size="0.05"/></body>
      <body name="b" pos="0.4 0 1"><freejoint/><geom name="h" size="0.1"/></body></worldbody>
      <equality><connect name="e" body1="a" body2="b" anchor="0.4 0 0"/></equality>
      <actuator><position name="servo" joint="j" kp="5"/></actuator></mujoco>)";
  };
  const auto scene_with = [&](const std::string& flags) { return scene_of_text("m.xml", with(flags)); };
  const Scene all = scene_with("warmstart='enable'");
  BOOST_TEST((all.joints.size() == 2u && joint_named(all, "j").stiffness == 30 && joint_named(all, "j").upper < 1));
  BOOST_TEST(body_named(all, "b").collides);
  BOOST_TEST(!body_named(scene_with("contact='disable'"), "b").collides);
  BOOST_TEST(std::isinf(joint_named(scene_with("limit='disable'"), "j").upper));
  BOOST_TEST(scene_with("equality='disable'").joints.size() == 1u);
  BOOST_TEST(scene_with("gravity='disable'").gravity.isZero(0));
  const Scene passive = scene_with("passive='disable'"), still = scene_with("actuation='disable'");
  BOOST_TEST((joint_named(passive, "j").stiffness == 0 && joint_named(passive, "j").damping == 0));
  BOOST_TEST(joint_named(still, "j").stiffness == 30);
  const Scene none = scene_with("constraint='disable'");
  BOOST_TEST((none.joints.size() == 1u && std::isinf(none.joints[0].upper) && !body_named(none, "b").collides));
  BOOST_TEST(!some_has(left_out_of_model("m.xml", with("contact='disable' frictionloss='disable'")), "frictionloss"));
  BOOST_TEST(some_has(left_out_of_model("m.xml", with("filterparent='disable'")), "contacts with parents"));

  // Its Euler step has dampers in its mass matrix, switched off or not: here without.
  std::string off =
      with("contact='disable' passive='disable' equality='disable' actuation='disable' frictionloss='disable'");
  off.replace(off.find("damping=\"0.4\""), 13, "damping=\"0\"");
  const Folder folder;
  const std::string path = folder.write("m.xml", off);
  Own own(path);
  check_alike("switched off", apart_after(own, "mujoco", without_limits(scene_of_file(path)), 0.3));
}

BOOST_AUTO_TEST_CASE(a_thousand_bodies_take_less_than_a_second) {
  std::string text = "<mujoco><option gravity='0 0 -9.81'/><worldbody>";
  for (int k = 0; k < 1000; ++k) {
    text += fmt::format(
        "<body name='b{0}' pos='{1} {2} 1'><{3}/><geom type='capsule' size='0.1 0.2' contype='0' "
        "conaffinity='0'/></body>",
        k, k % 40, k / 40, k % 2 ? "freejoint" : "joint type='hinge' axis='0 1 0'");
  }
  const Folder folder;
  const std::string path = folder.write("many.xml", text + "</worldbody></mujoco>");
  const std::clock_t start = std::clock();
  const Import made = import_model(path);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  BOOST_TEST_MESSAGE(fmt::format("a model of 1000 bodies is imported in {:.2f} s of CPU time", seconds));
  BOOST_TEST(seconds < 1);
  BOOST_TEST(scene_of_file(path).bodies.size() == 1000u);
}

BOOST_AUTO_TEST_SUITE_END()
