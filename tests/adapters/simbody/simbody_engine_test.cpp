// Simbody's traps, each found again, so that a new Simbody that mends or moves one is noticed; and its joints against
// the core's.
#include "adapters/simbody/simbody_engine.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "adapters/engines.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"
#include "tests/adapters/free_body_measures.h"
#include "tests/adapters/hung_rods.h"
#include "tests/adapters/seam_runs.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_simbody_simbody_engine)

namespace {

const std::vector<std::string> kFixedSteps = {"explicit-euler",      "merson", "rk2", "rk3",
                                              "semi-explicit-euler", "verlet"};

// The largest difference of any number of two runs after some time [m, rad, m/s, rad/s].
double distance(const std::string& run, const Scene& scene, const std::string& other, const Scene& other_scene,
                double dt, double duration) {
  const auto steps = static_cast<int>(std::lround(duration / dt));
  const BodyTable found = state_after(*load_run(run, scene), dt, steps),
                  due = state_after(*load_run(other, other_scene), dt, steps);
  double worst = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyState a = found.columns().body(i), b = due.columns().body(i);
    worst = std::max({worst, (a.position - b.position).norm(), (a.velocity - b.velocity).norm(),
                      angle_between(a.orientation, b.orientation), (a.angular_velocity - b.angular_velocity).norm()});
  }
  return worst;
}

double distance(const std::string& run, const std::string& other, const Scene& scene, double dt, double duration) {
  return distance(run, scene, other, scene, dt, duration);
}

double distance_from_truth(const std::string& run, const Scene& scene, double dt, double duration) {
  return distance(run, "core:dormand-prince", scene, dt, duration);
}

// A body that is pushed while from <= t < until, no whole number of steps.
Scene pushed(double from, double until) {
  Scene scene = top();
  TimedForce push;
  push.body = 0, push.force = {1, -2, 0.5}, push.torque = {0.2, 0.1, -0.3}, push.point = {0.1, 0.2, -0.1};
  push.from = from, push.until = until;
  scene.forces = {push};
  return scene;
}

bool is_refused_for(const std::string& run, const Scene& scene, const std::string& reason) {
  try {
    load_run(run, scene);
  } catch (const std::exception& error) {
    return std::string(error.what()).find(reason) != std::string::npos;
  }
  return false;
}

// Bodies between the world and the world, each hung on the one before it: the last joint closes the loop.
Scene ring_of(const std::vector<Vec3>& centres, const std::vector<Joint>& joints) {
  Scene scene;
  scene.gravity = {0.5, 1, -9.81};
  for (const Vec3& centre : centres) scene.bodies.push_back(rod("rod " + std::to_string(scene.bodies.size()), centre));
  scene.joints = joints;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    scene.joints[k].a = static_cast<int>(k) - 1;
    scene.joints[k].b = k < centres.size() ? static_cast<int>(k) : kWorld;
  }
  return scene;
}

// Rows of parallel hinges and of sliders in a plane repeat each other.
std::vector<Scene> rings() {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const std::vector<Vec3> centres = {{0, 0, 0.5}, {0.6, 0.1, 1}, {1.1, 0, 0.6}};
  return {ring_of(centres, {{.type = HingeJoint{{0, 0, 0}, y}, .damping = 0.1},
                            {.type = HingeJoint{{0.1, 0, 1}, y}},
                            {.type = HingeJoint{{1.2, 0, 1.1}, y}},
                            {.type = HingeJoint{{1, 0, 0}, y}, .stiffness = 3, .rest = 0.2}}),
          ring_of(centres, {{.type = UniversalJoint{{0, 0, 0}, x, y}},
                            {.type = UniversalJoint{{0.1, 0, 1}, y, x}},
                            {.type = UniversalJoint{{1.2, 0, 1.1}, x, z}},
                            {.type = UniversalJoint{{1, 0.2, 0}, y, x}}}),
          ring_of(centres, {{.type = CylindricalJoint{{0, 0, 0}, y}},
                            {.type = CylindricalJoint{{0.1, 0, 1}, x}},
                            {.type = CylindricalJoint{{1.2, 0, 1.1}, z}},
                            {.type = BallJoint{{1, 0.2, 0}}}}),
          ring_of({{0, 0, 0.5}, {0.6, 0.1, 1}},
                  {{.type = SliderJoint{x}}, {.type = SliderJoint{z}}, {.type = SliderJoint{(x + z).normalized()}}})};
}

}  // namespace

// Its own words: a first stepTo() after a start returns without a step, and setFixedStepSize() alone changes nothing
// once it runs. Steps of three lengths, in turn, are each taken as one.
BOOST_AUTO_TEST_CASE(each_step_is_one_step_whatever_the_one_before_it_was) {
  const Scene scene = hanging_cube();
  for (const std::string& method : kFixedSteps) {
    const auto world = load_run("simbody:" + method, scene), twin = load_run("core:simbody-" + method + "-twin", scene);
    for (int i = 0; i < 60; ++i) {
      const double dt = i % 3 == 0 ? 1.0 / 30 : i % 3 == 1 ? 1.0 / 240 : 1.0 / 50;
      world->step(dt), twin->step(dt);
    }
    const BodyState found = state_of(*world).columns().body(0), due = state_of(*twin).columns().body(0);
    // Sixty steps of some metres and m/s, and an explicit step's swing grows by roundings too.
    BOOST_TEST((found.position - due.position).norm() < 1e-12, method);
    BOOST_TEST((found.velocity - due.velocity).norm() < 1e-11, method);
  }
}

// If the error of a step exceeds 2^p times its accuracy, Simbody does not normalise quaternions. At its own accuracy of
// 1e-3 a coarse step of a top would do this.
BOOST_AUTO_TEST_CASE(quaternions_stay_of_length_one_at_coarse_steps) {
  for (const std::string& method : kFixedSteps) {
    const auto world = load_run("simbody:" + method, top());
    for (int i = 0; i < 30; ++i) {
      world->step(1.0 / 10);
      BOOST_TEST(std::abs(state_of(*world).columns().orientation(0).norm() - 1) < 1e-14, method);  // a few roundings
    }
  }
}

BOOST_AUTO_TEST_CASE(a_tree_of_joints_moves_as_the_cores_whichever_end_hangs) {
  for (Joint joint : joints_of_each_kind()) {
    for (const bool swapped : {false, true}) {
      joint.a = swapped ? 1 : 0, joint.b = swapped ? 0 : 1;
      const Scene scene = hung_by(joint);
      const double coarse = distance_from_truth("simbody", scene, 1.0 / 60, 0.6),
                   fine = distance_from_truth("simbody", scene, 1.0 / 120, 0.6);
      const std::string what = joint_type_name(joint) + (swapped ? ", ends exchanged: " : ": ");
      BOOST_TEST_MESSAGE(what << coarse << ", " << fine);
      BOOST_TEST(fine < 1e-4, what << fine);                                             // of some metres and rad/s
      BOOST_TEST(coarse > 11 * fine, what << coarse << " at twice the step, " << fine);  // order 4: 16, less a third
    }
  }
}

BOOST_AUTO_TEST_CASE(a_tree_of_joints_moves_as_its_twin_to_rounding) {
  for (Joint joint : joints_of_each_kind()) {
    for (const bool swapped : {false, true}) {
      joint.a = swapped ? 1 : 0, joint.b = swapped ? 0 : 1;
      Scene scene = hung_by(joint);
      Motor motor{.joint = 1, .speed = {}};
      motor.effort = 2, motor.from = 0.1, motor.until = 0.35;
      if (free_axis(joint)) scene.motors = {motor};
      for (const std::string& method : kFixedSteps) {
        const double apart = distance("simbody:" + method, "core:simbody-" + method + "-twin", scene, 1.0 / 60, 0.6);
        BOOST_TEST(apart < 1e-11, joint_type_name(joint) << " by " << method << ": " << apart);  // 36 steps' roundings
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(rings_of_one_kind_of_joint_are_closed_by_constraints) {
  for (const Scene& scene : rings()) {
    const double coarse = distance_from_truth("simbody", scene, 1.0 / 120, 0.3),
                 fine = distance_from_truth("simbody", scene, 1.0 / 240, 0.3);
    const std::string what = joint_type_name(scene.joints[0]);
    BOOST_TEST_MESSAGE(what << ": " << coarse << ", " << fine);
    // For lengths of some metres and speeds of some rad/s; a motion without scheme error keeps its rounding.
    BOOST_TEST(fine < 1e-5, what << ": " << fine);
    BOOST_TEST((coarse > 11 * fine || coarse < 1e-11), what << ": " << coarse << " at twice the step, " << fine);
  }
}

// Constraints that say no more than the tree does leave Simbody a matrix of roundings, of which it makes forces that
// are none.
BOOST_AUTO_TEST_CASE(a_joint_said_twice_is_refused) {
  for (Joint joint : joints_of_each_kind()) {
    joint.a = 0, joint.b = 1;
    Scene scene = hung_by(joint);
    scene.joints.push_back(joint);
    BOOST_TEST(is_refused_for("simbody", scene, "no forces for the joints that close loops"), joint_type_name(joint));
  }
}

BOOST_AUTO_TEST_CASE(loops_keep_the_order) {
  Scene scene = hung_by({.a = 0, .b = 1, .type = BallJoint{{1, 0.1, 0}}});
  for (const Joint& joint : {Joint{.a = kWorld, .b = 1, .type = BallJoint{{2, 0.3, 0.2}}},
                             Joint{.a = kWorld, .b = 1, .type = DistanceJoint{{2, 0.5, -1}, {0.3, 0, 0}}}}) {
    scene.joints.resize(2);
    scene.joints.push_back(joint);
    const double coarse = distance_from_truth("simbody", scene, 1.0 / 60, 0.4),
                 fine = distance_from_truth("simbody", scene, 1.0 / 120, 0.4);
    BOOST_TEST_MESSAGE(joint_type_name(joint) << ": " << coarse << ", " << fine);
    BOOST_TEST(coarse > 11 * fine, joint_type_name(joint) << ": " << coarse << " at twice the step, " << fine);
  }
}

// A projection that closes a loop after a first-order step gives energy: only what cannot open is left to this method.
BOOST_AUTO_TEST_CASE(semi_explicit_euler_takes_trees_alone) {
  Scene rod_pendulum = hung_by({.a = 0, .b = 1, .type = BallJoint{{1, 0.1, 0}}});
  BOOST_CHECK_NO_THROW(load_run("simbody:semi-explicit-euler", rod_pendulum));
  rod_pendulum.joints[1].type = DistanceJoint{{0.3, 0, 0}, {0.3, 0, 0}};
  BOOST_TEST(is_refused_for("simbody:semi-explicit-euler", rod_pendulum, "joint:distance"));
  BOOST_CHECK_NO_THROW(load_run("simbody", rod_pendulum));
}

// Held over a step a force would make every method one of first order; and so would a step across where it begins.
BOOST_AUTO_TEST_CASE(timed_forces_keep_the_order) {
  const Scene scene = pushed(0.1037, 0.5511);
  const double coarse = distance_from_truth("simbody", scene, 1.0 / 30, 1),
               fine = distance_from_truth("simbody", scene, 1.0 / 60, 1);
  BOOST_TEST(coarse > 11 * fine, coarse << " at twice the step, " << fine);
  BOOST_TEST(distance("simbody", "core:simbody-merson-twin", scene, 1.0 / 30, 1) < 1e-12);
  BOOST_TEST(distance_from_truth("simbody:cpodes", scene, 1.0 / 30, 1) < 1e-6);  // its accuracy is 1e-9 an inner step
  BOOST_TEST(distance_from_truth("simbody:feldberg", scene, 1.0 / 30, 1) < 1e-6);
}

BOOST_AUTO_TEST_CASE(a_world_that_blows_up_is_not_a_number_from_then_on) {
  const auto world = load_run("simbody:semi-explicit-euler", asymmetric_top());
  const BodyState end = body_after(*world, 1.0 / 30, 1800);
  BOOST_TEST(!std::isfinite(end.angular_velocity.norm()));
}

// Explicit Euler's swing grows for ever; what Simbody then throws ends the run, and not the program.
BOOST_AUTO_TEST_CASE(what_simbody_throws_at_numbers_without_bounds_is_a_blow_up) {
  Scene scene = hanging_cube();
  scene.springs[0].stiffness = 1e12;
  for (const std::string& method : kFixedSteps) {
    const auto world = load_run("simbody:" + method, scene);
    const Vec3 position = state_after(*world, 1.0 / 30, 2000).columns().position(0);
    BOOST_TEST((!position.allFinite() || position.norm() > 1e3), method);
  }
}

BOOST_AUTO_TEST_CASE(what_it_would_make_nonsense_of_is_refused) {
  Scene scene = hanging_cube();
  scene.springs[0].point_a = scene.bodies[0].position + scene.bodies[0].orientation * scene.springs[0].point_b;
  BOOST_TEST(is_refused_for("simbody", scene, "at one point"));
  // Its headers check this only without NDEBUG; a build that defines it would take the body.
  Scene plate = scene_of(moving_body());
  plate.bodies[0].inertia = Vec3(1, 1, 3).asDiagonal();
  BOOST_TEST(is_refused_for("simbody", plate, "none may be greater than the sum of the other two"));
  plate.bodies[0].inertia = Vec3(1, 1, 2).asDiagonal();
  BOOST_CHECK_NO_THROW(load_run("simbody", plate));
  const EngineInfo info = SimbodyEngine().info();
  for (const Feature feature :
       {Feature::restitution, Feature::joint_limit, Feature::motor_speed, contact_feature<Plane, Sphere>()})
    BOOST_TEST(!info.features.contains(feature), word_of(feature));
}

// A spring that does not converge at this step is Verlet's own doing: it says so, and its twin does likewise.
BOOST_AUTO_TEST_CASE(verlet_says_where_its_iteration_does_not_converge) {
  Scene scene = hanging_cube();
  scene.springs[0].damping = 2e4;
  const auto world = load_run("simbody:verlet", scene), twin = load_run("core:simbody-verlet-twin", scene);
  world->step(1.0 / 30), world->step(1.0 / 30), twin->step(1.0 / 30), twin->step(1.0 / 30);
  BOOST_TEST(world->solver_warning() != "");
  BOOST_TEST(twin->solver_warning() != "");
  BOOST_TEST(load_run("simbody:verlet", hanging_cube())->solver_warning() == "");
}

BOOST_AUTO_TEST_CASE(settings_are_read_back) {
  Scene scene = hung_by({.a = 0, .b = 1, .type = DistanceJoint{{0.3, 0, 0}, {0.3, 0, 0}}});
  const auto matched = load_run("simbody", scene)->settings_in_force();
  BOOST_TEST(setting(matched, "integrator") == "RungeKuttaMerson");
  BOOST_TEST(setting(matched, "step") == "dt");
  BOOST_TEST(setting(matched, "coordinates") == "9 speeds of joints and free bodies");
  BOOST_TEST(setting(matched, "loops") == "1 constraints, projected to 0.001 after each step");
  BOOST_TEST(setting(load_run("simbody@stock", scene)->settings_in_force(), "step") ==
             "as its error asks: accuracy 0.001");
  BOOST_TEST(setting(load_run("simbody:cpodes,accuracy=1e-6", scene)->settings_in_force(), "step") ==
             "as its error asks: accuracy 1e-06");
}

BOOST_AUTO_TEST_CASE(its_settings_are_said_as_its_own_calls) {
  const auto calls = [](const std::string& run) {
    return engine_calls(parse_run_name(run, infos_of(engines())), "1.0/30");
  };
  BOOST_TEST(calls("simbody").front() == "RungeKuttaMersonIntegrator integ(system);");
  BOOST_TEST(calls("simbody").at(1) == "integ.setFixedStepSize(1.0/30);");
  BOOST_TEST(calls("simbody:semi-explicit-euler").front() == "SemiExplicitEulerIntegrator integ(system, 1.0/30);");
  BOOST_TEST(calls("simbody:feldberg,accuracy=1e-7").at(1) == "integ.setAccuracy(1e-07);");
  BOOST_TEST(calls("simbody@stock").at(1) == "integ.initialize(state);");
}

BOOST_AUTO_TEST_SUITE_END()
