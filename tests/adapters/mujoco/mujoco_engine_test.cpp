// MuJoCo's traps, each found again, so that a new MuJoCo that mends or moves one is noticed; and its joints against the
// core's.
#include "adapters/mujoco/mujoco_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "adapters/mujoco/mujoco_calls.h"
#include "adapters/mujoco/mujoco_library.h"
#include "adapters/mujoco/mujoco_options.h"
#include "core/engine/engine_failure.h"
#include "core/engine/run_name.h"
#include "tests/adapters/free_body_measures.h"
#include "tests/adapters/hung_rods.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_mujoco_mujoco_engine)

namespace {

constexpr double kHalfTurn = std::numbers::pi;

double distance_after(const std::string& run, const Scene& scene, double dt, double duration) {
  const auto steps = static_cast<int>(std::lround(duration / dt));
  const auto world = load_run(run, scene), truth = load_run("core:dormand-prince", scene);
  for (int i = 0; i < steps; ++i) world->step(dt), truth->step(dt);
  Snapshot found, expected;
  world->read(found), truth->read(expected);
  double distance = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyState a = found.bodies().body(i), b = expected.bodies().body(i);
    distance =
        std::max({distance, (a.position - b.position).norm(), (a.velocity - b.velocity).norm(),
                  angle_between(a.orientation, b.orientation), (a.angular_velocity - b.angular_velocity).norm()});
  }
  return distance;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_world_that_mujoco_sets_back_to_its_start_is_lost) {
  // The explicit gyroscopic torque spins a top up until a number passes 1e10; MuJoCo then begins again, in silence.
  const auto world = load_run("mujoco", asymmetric_top());
  const BodyState end = body_after(*world, 1.0 / 30, 1800);
  BOOST_TEST(!std::isfinite(end.angular_velocity.norm()));
  BOOST_TEST(world->solver_warning().find("back to its start") != std::string::npos);
}

// MuJoCo takes the convex hull of a mesh, so none is handed over: a geom without a type would be refused.
BOOST_AUTO_TEST_CASE(a_mesh_that_nothing_touches_is_left_out) {
  Scene scene = asymmetric_top();
  Body ground;
  ground.name = "ground", ground.fixed = ground.collides = true;
  ground.shape = Mesh{
      {closed_surface({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, -1}}, {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}})}};
  scene.bodies.push_back(ground);
  const auto world = load_run("mujoco:rk4", scene), alone = load_run("mujoco:rk4", asymmetric_top());
  BOOST_TEST(angle_between(body_after(*world, 0.01, 50).orientation, body_after(*alone, 0.01, 50).orientation) < 1e-12);
}

BOOST_AUTO_TEST_CASE(the_implicit_method_damps_a_free_top_and_rk4_does_not) {
  // Measured with MuJoCo 2.2.2: -76.4 % and -3e-6; the digit after it is the test's margin.
  BOOST_TEST(std::abs(energy_gained_by_top("mujoco:implicit") + 0.764) < 1e-3);
  BOOST_TEST(std::abs(energy_gained_by_top("mujoco:rk4") + 3e-6) < 1e-6);
}

BOOST_AUTO_TEST_CASE(a_full_inertia_is_set_to_rounding) {
  Scene scene;
  scene.bodies = {rod("rod", {0, 0, 0})};
  scene.bodies[0].angular_velocity = {1, -2, 0.5};
  const auto world = load_run("mujoco", scene), twin = load_run("core:mujoco-euler-twin", scene);
  const Quat found = body_after(*world, 1.0 / 240, 100).orientation,
             due = body_after(*twin, 1.0 / 240, 100).orientation;
  BOOST_TEST(angle_between(found, due) < 1e-13);  // MuJoCo's own diagonalisation is off by 2.5e-8 of itself
}

BOOST_AUTO_TEST_CASE(matched_friction_is_a_cone_and_stock_friction_a_pyramid) {
  const double dt = 1e-3;
  for (const double direction : {0.0, kHalfTurn / 8, kHalfTurn / 4}) {
    // Contacts give way: a few parts in a thousand were measured.
    BOOST_TEST(std::abs(stop_distance_ratio("mujoco", direction, dt) - 1) < 5e-3);
  }
  BOOST_TEST(std::abs(stop_distance_ratio("mujoco@stock", kHalfTurn / 4, dt) - std::sqrt(2)) < 5e-3);
}

BOOST_AUTO_TEST_CASE(warnings_and_errors_neither_print_nor_prompt_nor_write_a_file) {
  mujoco_library::start();
  BOOST_TEST(mujoco_library::take_warnings() == "");
  mju_warning("a warning");
  BOOST_TEST(mujoco_library::take_warnings() == "a warning");
  BOOST_CHECK_THROW(mju_error("an error"), std::runtime_error);
  BOOST_TEST(!std::filesystem::exists("MUJOCO_LOG.TXT"));
}

BOOST_AUTO_TEST_CASE(a_tree_of_joints_moves_as_the_cores_whichever_end_hangs) {
  for (Joint joint : joints_of_each_kind()) {
    for (const bool swapped : {false, true}) {
      joint.a = swapped ? 1 : 0, joint.b = swapped ? 0 : 1;
      const Scene scene = hung_by(joint);
      const double coarse = distance_after("mujoco:rk4", scene, 1.0 / 250, 0.6),
                   fine = distance_after("mujoco:rk4", scene, 1.0 / 500, 0.6);
      const std::string what = joint_type_name(joint) + (swapped ? ", ends exchanged: " : ": ");
      BOOST_TEST_MESSAGE(what << coarse << ", " << fine);
      BOOST_TEST(fine < 2e-4, what << fine);  // of some metres and rad/s: the turns of balls are of order 2
      BOOST_TEST(coarse > 3 * fine, what << coarse << " at twice the step, " << fine);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_loop_is_closed_by_springs_that_stiffen_with_the_step) {
  for (Joint joint : {Joint{.type = BallJoint{{2, 0.3, 0.2}}}, Joint{.type = HingeJoint{{2, 0.3, 0.2}, Vec3::UnitX()}},
                      Joint{.type = DistanceJoint{{2, 0.5, -1}, {0.3, 0, 0}}}}) {
    Scene scene = hung_by({.a = 0, .b = 1, .type = BallJoint{{1, 0.1, 0}}});
    joint.a = kWorld, joint.b = 1;
    scene.joints.push_back(joint);
    const double coarse = distance_after("mujoco", scene, 1.0 / 500, 0.4),
                 fine = distance_after("mujoco", scene, 1.0 / 1000, 0.4);
    BOOST_TEST_MESSAGE(joint_type_name(joint) << ": " << coarse << ", " << fine);
    BOOST_TEST(coarse > 1.7 * fine, joint_type_name(joint) << ": " << coarse << ", " << fine);  // order 1
  }
}

BOOST_AUTO_TEST_CASE(a_motor_turns_b_against_a) {
  Scene scene = hung_by({.a = 0, .b = 1, .type = HingeJoint{{1, 0.1, 0}, Vec3::UnitY()}});
  Motor motor{.joint = 1, .speed = {}};
  motor.effort = 2, motor.from = 0.1, motor.until = 0.35;
  scene.motors = {motor};
  BOOST_TEST(distance_after("mujoco:rk4", scene, 1e-3, 0.6) < 1e-4);
  std::swap(scene.joints[1].a, scene.joints[1].b);
  BOOST_TEST(distance_after("mujoco:rk4", scene, 1e-3, 0.6) < 1e-4);
}

// A weight that falls on the stop of its slider, and an arm on that of its hinge, come to rest there. A limit is found
// where a step begins beyond it: by up to v dt, which is left; and as a force it lets through 1e-4 of what presses, so
// that what lies on it sinks by 1e-4 g dt each second.
BOOST_AUTO_TEST_CASE(limits_stop_within_a_step_and_hardly_sink) {
  for (const char* method : {"mujoco", "mujoco:implicit", "mujoco:rk4"}) {
    for (const double dt : {1.0 / 240, 1.0 / 1000}) {
      for (const bool is_b : {true, false}) {
        Scene scene;
        scene.gravity = {0, 0, -9.81};
        scene.bodies = {rod("weight", {1, 0, 0})};
        Joint rail{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitZ()}, .lower = -0.5};
        if (!is_b) rail = {.a = 0, .b = kWorld, .type = SliderJoint{Vec3::UnitZ()}, .upper = 0.5};
        scene.joints = {rail};
        const auto fallen = load_run(method, scene);
        const double fastest = std::sqrt(2 * 9.81 * 0.5),
                     sunk = -0.5 - body_after(*fallen, dt, std::lround(2 / dt)).position.z();
        BOOST_TEST_CONTEXT(method << ", " << dt << ": " << sunk) {
          BOOST_TEST(sunk > -1e-3 * fastest * dt);
          // rk4, in whose stages a limit is a damper of 1/dt, takes as much again to stop.
          BOOST_TEST(sunk < (std::string(method) == "mujoco:rk4" ? 2.1 : 1.1) * fastest * dt);
          const BodyState rest = body_after(*fallen, dt, 1);
          BOOST_TEST(std::abs(rest.velocity.z()) < 2e-4 * 9.81 * dt);
        }
        scene.joints[0].type = HingeJoint{{0, 0, 0}, {0, is_b ? -1.0 : 1.0, 0}};  // up is positive
        if (!is_b) scene.joints[0].type = HingeJoint{{0, 0, 0}, {0, -1, 0}};
        const auto swung = load_run(method, scene);
        const BodyState down = body_after(*swung, dt, std::lround(2 / dt));
        const double angle = std::atan2(down.position.z(), down.position.x());
        BOOST_TEST_CONTEXT(method << ", " << dt << ": " << angle) {
          BOOST_TEST(angle < -0.5 + 1e-3 * 4 * dt);
          BOOST_TEST(angle > -0.5 - 1.1 * 4 * dt);  // rad/s: it comes with 3.7
          BOOST_TEST(down.angular_velocity.norm() < 2e-4 * 15 * dt);
        }
      }
    }
  }
}

// A block of 2 kg on a rail with 5 N of friction. A larger force accelerates it by (F - 5 N) / 2 kg. A smaller one
// holds, but for the softness: 1e-4 of the law's acceleration F/m is let through in each step, and it is gone in the
// next.
BOOST_AUTO_TEST_CASE(the_friction_of_a_joint_holds_or_takes_its_share) {
  const double dt = 1e-3;
  for (const double force : {3.0, -3.0, 9.0, -9.0}) {
    Scene scene;
    scene.bodies = {rod("block", {0, 0, 0})};
    scene.bodies[0].mass = 2;
    scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}}};
    Motor friction{.joint = 0, .speed = 0};
    friction.most = 5, friction.is_friction = true;
    Motor push{.joint = 0, .speed = {}};
    push.effort = force;
    scene.motors = {friction, push};
    const double v = body_after(*load_run("mujoco", scene), dt, 1000).velocity.x();
    const double slides = force > 5 ? (force - 5) / 2 : force < -5 ? (force + 5) / 2 : 0;  // m/s after 1 s
    BOOST_TEST_CONTEXT(force << " N: " << v << " m/s") {
      BOOST_TEST(std::abs(v - slides) < (slides == 0 ? 2e-4 * std::abs(force) / 2 * dt : 1e-9));
    }
  }
}

BOOST_AUTO_TEST_CASE(what_it_cannot_say_is_refused) {
  Scene scene = hung_by({.a = 0, .b = 1, .type = SliderJoint{Vec3::UnitX()}});
  scene.joints.push_back({.a = kWorld, .b = 1, .type = SliderJoint{Vec3::UnitX()}});
  scene.joints.push_back({.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}});
  BOOST_CHECK_EXCEPTION(load_run("mujoco", scene), EngineFailure, [](const EngineFailure& failure) {
    return failure.kind() == FailureKind::unsupported &&
           std::string(failure.what()).find("closes a loop") != std::string::npos;
  });
  for (const double damping : {0.0, 0.1}) {  // a hinge that closes a loop, driven
    Scene loop = hung_by({.a = 0, .b = 1, .type = BallJoint{{1, 0.1, 0}}});
    loop.joints.pop_back();
    loop.joints.push_back({.a = 0, .b = 1, .type = HingeJoint{{1, 0.1, 0}, Vec3::UnitY()}});
    loop.joints.push_back({.a = kWorld, .b = 1, .type = HingeJoint{{2, 0.3, 0.2}, Vec3::UnitY()}, .damping = damping});
    loop.joints.push_back({.a = kWorld, .b = 0, .type = HingeJoint{{0, 0, 0}, Vec3::UnitY()}, .damping = damping});
    Motor motor{.joint = 1, .speed = {}};
    motor.effort = 1;
    if (damping == 0) loop.motors = {motor, motor, motor}, loop.motors[1].joint = 2, loop.motors[2].joint = 3;
    BOOST_CHECK_EXCEPTION(load_run("mujoco", loop), EngineFailure, [](const EngineFailure& failure) {
      return std::string(failure.what()).find("no spring, damper, limit, motor, armature or coupling") !=
             std::string::npos;
    });
  }
  Scene chain;
  for (int i = 0; i < 96; ++i) {
    chain.bodies.push_back(rod(fmt::format("link{}", i), {1.0 * i, 0, 0}));
    chain.joints.push_back({.a = i - 1, .b = i, .type = BallJoint{{i - 0.5, 0, 0}}});
  }
  BOOST_CHECK_EXCEPTION(load_run("mujoco", chain), EngineFailure, [](const EngineFailure& failure) {
    return std::string(failure.what()).find("'link95' hangs on 95 others") != std::string::npos;
  });
  chain.bodies.pop_back(), chain.joints.pop_back();
  BOOST_CHECK_NO_THROW(load_run("mujoco", chain));
  const EngineInfo info = MujocoEngine().info();
  Scene bouncing = sliding_box(0, 0, 0);
  bouncing.contact_default.restitution = 0.5;
  const std::string why = why_unsupported(info, parse_run_name("mujoco", {info}).settings, bouncing, 0.01);
  BOOST_TEST(why.find("no restitution") != std::string::npos, why);
  BOOST_TEST(why.find("a run that names contact-damping has it") != std::string::npos, why);
  const RunName named = parse_run_name("mujoco,contact-damping=0.1", {info});
  BOOST_TEST(why_unsupported(info, named.settings, bouncing, 0.01) == "");
  BOOST_TEST(!info.features.contains(Feature::friction_infinite));
}

BOOST_AUTO_TEST_CASE(settings_are_read_back) {
  const Scene scene = sliding_box(1, 0, 0.5);
  const auto matched = load_run("mujoco,iterations=77", scene)->settings_in_force();
  BOOST_TEST(setting(matched, "friction cone") == "elliptic");
  BOOST_TEST(setting(matched, "solver") == "Newton, at most 77 iterations to 1e-10");
  BOOST_TEST(setting(matched, "contacts") == "solref 0.02 1, solimp 0.999 0.999 0.001");
  const auto stock = load_run("mujoco@stock", scene)->settings_in_force();
  BOOST_TEST(setting(stock, "friction cone").starts_with("pyramidal"));
  BOOST_TEST(setting(stock, "contacts") == "solref 0.02 1, solimp 0.9 0.95 0.001");
}

// The options of contacts: each is read back, and has the effect that its row promises.
namespace {

Scene ball(double height) {
  Scene scene = sliding_box(0, 0, 0);
  Body& body = scene.bodies[0];
  body.shape = Sphere{0.1}, body.inertia = inertia_of(*body.shape, body.mass), body.position.z() = 0.1 + height;
  return scene;
}

// The ball's state after a time, at 1/4000 s.
BodyState after(const std::string& run, const Scene& scene, double time) {
  const auto world = load_run(run, scene);
  for (int i = 0; i < static_cast<int>(std::lround(4000 * time)); ++i) world->step(1.0 / 4000);
  Snapshot found;
  world->read(found);
  return found.bodies().body(0);
}

double sunk_by(const std::string& run) { return 0.1 - after(run, ball(0), 2).position.z(); }

}  // namespace

BOOST_AUTO_TEST_CASE(named_options_are_in_force_on_both_tracks_and_others_stay) {
  const std::string all =
      "mujoco,contact-d0=0.5,contact-damping=0.3,contact-dmax=0.8,contact-margin=0.01,contact-time=0.03,contact-width="
      "0.002";
  for (const char* track : {"", "@stock"}) {
    const auto found = load_run(all + track, ball(1))->settings_in_force();
    BOOST_TEST(setting(found, "contacts") == "solref 0.03 0.3, solimp 0.5 0.8 0.002");
    BOOST_TEST(setting(found, "contact margin") == "0.01 m: bodies rest that far apart");
  }
  const auto one = load_run("mujoco,contact-damping=0.3@stock", ball(1))->settings_in_force();
  BOOST_TEST(setting(one, "contacts") == "solref 0.02 0.3, solimp 0.9 0.95 0.001");
  BOOST_TEST(setting(one, "contact margin").empty());
}

// The impact of 4.43 m/s is over by 0.6 s. A contact of critical damping returns almost nothing.
BOOST_AUTO_TEST_CASE(a_contact_below_critical_damping_bounces) {
  const double critical = after("mujoco", ball(1), 0.6).velocity.z(),
               lively = after("mujoco,contact-damping=0.1", ball(1), 0.6).velocity.z();
  BOOST_TEST(critical < 0.5);
  BOOST_TEST(lively > 1.5);
}

// At rest (1 - d) g = d k r, with the impedance d and the stiffness k = d / (dmax time damping)².
BOOST_AUTO_TEST_CASE(the_impedance_decides_how_deep_a_body_rests) {
  const double stiff = sunk_by("mujoco"), soft = sunk_by("mujoco,contact-d0=0.5,contact-dmax=0.5");
  const auto due = [](double d, double dmax) { return (1 - d) / (d * d) * 9.81 * std::pow(dmax * 0.02, 2); };
  BOOST_TEST(std::abs(stiff - due(0.999, 0.999)) < 0.01 * stiff);
  BOOST_TEST(std::abs(soft - due(0.5, 0.5)) < 0.01 * soft);
  // From d0 = 0.5 the impedance rises to dmax = 0.999 at the width. A ball that sinks through the width rests on the
  // latter; with a wide one it stays near the former.
  const double narrow = sunk_by("mujoco,contact-d0=0.5,contact-width=1e-6"),
               wide = sunk_by("mujoco,contact-d0=0.5,contact-width=0.1");
  BOOST_TEST(std::abs(narrow - stiff) < 0.01 * stiff);
  BOOST_TEST(std::abs(wide - due(0.5, 0.999)) < 0.05 * wide);
}

BOOST_AUTO_TEST_CASE(a_margin_holds_bodies_apart) {
  BOOST_TEST(std::abs(sunk_by("mujoco,contact-margin=0.01") - sunk_by("mujoco") + 0.01) < 1e-4);
}

BOOST_AUTO_TEST_CASE(the_calls_of_a_run_set_the_same) {
  Settings settings;
  settings.method = "euler";
  settings.options = {{"contact-damping", "0.3"}, {"contact-margin", "0.01"}};
  const std::vector<std::string> calls = mujoco_calls(settings, "0.001", kMujoco2);
  for (const std::string call : {"m->geom_solref[mjNREF*i + 1] = 0.3;", "m->geom_margin[i] = 0.01;"}) {
    const bool is_there = std::any_of(calls.begin(), calls.end(),
                                      [&](const std::string& line) { return line.find(call) != std::string::npos; });
    BOOST_TEST(is_there, call);
  }
}

BOOST_AUTO_TEST_SUITE_END()
