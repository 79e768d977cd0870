// Compares the special code for ball joints and hinges with the general joint code: the same motion, the same bits on
// every instruction set, and in trees no gap but the rounding of positions and of directions.
#include "core/dynamics/joints/ball_joints.h"

#include <boost/test/unit_test.hpp>

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/joints/joints.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_joints_ball_joints)

namespace {

constexpr double kStep = 1.0 / 240;  // s

// Links of full inertia, each turned its own way; link i hangs from parents[i] by a joint beside its centre.
Scene linked(const std::vector<int>& parents) {
  Scene scene;
  scene.gravity = {0.3, 0, -9.81};
  for (std::size_t i = 0; i < parents.size(); ++i) {
    const double s = std::sin(2.4 * static_cast<double>(i));
    const Vec3 from = parents[i] < 0 ? Vec3::Zero() : scene.bodies[parents[i]].position;
    Body link =
        test::body("link " + std::to_string(i), 1 + 0.5 * s, {0.02, 0.03, 0.035}, from + Vec3(0.3, 0.4 * s, -0.2));
    link.inertia(0, 1) = link.inertia(1, 0) = 0.004 * s;
    link.orientation = Quat(1, 0.3 * s, 0.2, -0.4 * s).normalized();
    scene.bodies.push_back(link);
    scene.joints.push_back(
        {.a = parents[i], .b = static_cast<int>(i), .type = BallJoint{0.5 * (from + link.position)}});
  }
  return scene;
}

Scene chain(int links) {
  std::vector<int> parents;
  for (int i = 0; i < links; ++i) parents.push_back(i - 1);
  return linked(parents);
}

// Three limbs of three links about a trunk that nothing else holds, and goes along and round.
Scene floating_star() {
  Scene scene = linked({kWorld, 0, 1, 2, 0, 4, 5, 0, 7, 8});
  scene.joints.erase(scene.joints.begin());
  for (Body& body : scene.bodies)
    body.angular_velocity = {0.2, 1, 0}, body.velocity = body.angular_velocity.cross(body.position);
  return scene;
}

// A chain from a body that is fixed back to the world: a loop.
Scene garland() {
  Scene scene = chain(7);
  scene.bodies[0].fixed = true;
  scene.joints.erase(scene.joints.begin());
  scene.joints.push_back({.a = 6, .b = kWorld, .type = BallJoint{scene.bodies[6].position + Vec3(0.2, 0, 0)}});
  return scene;
}

// Every second joint, and the first, a hinge about an axis of its own.
Scene hinged(Scene scene) {
  for (std::size_t k = 0; k < scene.joints.size(); k += 2) {
    const auto s = static_cast<double>(k);
    const Vec3 axis = Vec3(std::cos(s), 0.5 + std::sin(3 * s), 0.3).normalized();
    scene.joints[k].type = HingeJoint{std::get<BallJoint>(scene.joints[k].type).anchor, axis};
  }
  return scene;
}

// A hinge with a spring, and one with a motor of given torque, on bodies that turn as it allows.
Scene driven_hinges() {
  Scene scene = linked({kWorld, 0});
  for (Joint& joint : scene.joints) joint.type = HingeJoint{std::get<BallJoint>(joint.type).anchor, Vec3(0.6, 0, 0.8)};
  scene.joints[0].stiffness = 2, scene.joints[0].damping = 0.1;
  scene.motors.push_back({.joint = 1, .effort = 0.3, .speed = {}, .until = 1});
  const Vec3 w = Vec3(1.2, 0, 1.6), at = std::get<HingeJoint>(scene.joints[0].type).anchor;
  for (Body& body : scene.bodies) body.angular_velocity = w, body.velocity = w.cross(body.position - at);
  return scene;
}

const std::vector<std::pair<std::string, Scene>>& scenes() {
  static const std::vector<std::pair<std::string, Scene>> all = {
      {"one link", chain(1)},
      {"chain", chain(21)},
      {"tree", linked({kWorld, 0, 0, 0, 1, 1, 2, 6, 6, 6, 6})},
      {"floating star", floating_star()},
      {"garland", garland()},
      {"one hinge", hinged(chain(1))},
      {"chain of hinges and balls", hinged(chain(21))},
      {"tree of hinges and balls", hinged(linked({kWorld, 0, 0, 0, 1, 1, 2, 6, 6, 6, 6}))},
      {"floating star of hinges and balls", hinged(floating_star())},
      {"garland of hinges and balls", hinged(garland())},
      {"driven hinges", driven_hinges()}};
  return all;
}

// Without the scene a stepper knows only that there are joints.
BodyTable stepped(const Scene& scene, bool knows_scene, int steps, double dt = kStep) {
  const System system(scene);
  Joints joints(scene, system);
  BodyTable state(system.size());
  set_initial_state(scene, state.columns());
  StepperParts parts{system, nullptr, &orientation_update("quaternion-exponential"), {}, &joints};
  if (knows_scene) parts.scene = &scene;
  const auto stepper = integrator("semi-implicit-euler").make(parts);
  for (int n = 0; n < steps; ++n) stepper->step(state.columns(), n * dt, dt);
  BOOST_REQUIRE_EQUAL(joints.warning(), "");
  return state;
}

double largest_difference(const BodyTable& a, const BodyTable& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const test::Difference d = test::difference(a.columns().body(i), b.columns().body(i));
    largest = std::max({largest, d.pose, d.velocity});
  }
  return largest;
}

}  // namespace

// Both stop at 1e-11 of the longest arm, .3 m; of a chain of 21 links such gaps add up to 6e-11 m at its end, which in
// a step of 1/240 s is 1.5e-8 m/s. In a quarter of a second a falling chain spreads that less than tenfold.
BOOST_AUTO_TEST_CASE(they_move_as_joints_of_every_kind_do) {
  for (const auto& [name, scene] : scenes()) {
    BOOST_TEST_CONTEXT(name) {
      BOOST_REQUIRE(BallJoints::are_all_of(scene));
      const BodyTable all = stepped(scene, true, 60), general = stepped(scene, false, 60);
      BOOST_TEST(largest_difference(all, general) < 1.5e-7);
      BOOST_TEST(largest_difference(all, stepped(scene, true, 59)) > 1e-3);  // something moves
    }
  }
}

BOOST_AUTO_TEST_CASE(every_instruction_set_gives_the_same_bits) {
  const Kernels* tables[kMostKernelTables];
  const std::size_t count = available_kernels(tables);
  for (const auto& [name, scene] : scenes()) {
    std::vector<BodyTable> ends;
    for (std::size_t k = 0; k < count; ++k) {
      const KernelsInPlace use(*tables[k]);
      ends.push_back(stepped(scene, true, 60));
      for (std::size_t i = 0; i < ends[k].size(); ++i) {
        BOOST_TEST_CONTEXT(name << ", " << tables[k]->name << ", body " << i) {
          for (int c = 0; c < kRotation; ++c)
            BOOST_TEST(ends[0].columns().column(c)[i] == ends[k].columns().column(c)[i]);
        }
      }
    }
  }
}

// Bodies that are put on their joints leave what a sum of three numbers of up to 8 m rounds: three times 8.9e-16 m.
BOOST_AUTO_TEST_CASE(trees_keep_no_gap_but_rounding) {
  for (const auto& [name, scene] : scenes()) {
    if (name.starts_with("garland")) continue;
    const bool has_hinges = name.find("hinge") != std::string::npos;
    const System system(scene);
    Joints joints(scene, system);
    // Directions are closed to 1e-11 and not put where they belong.
    BOOST_TEST_CONTEXT(name) {
      BOOST_TEST(joints.gap(stepped(scene, true, 240).columns()) < (has_hinges ? 1e-11 : 3e-15));
    }
  }
}

// In steps of a third of a second bodies turn so far that no impulse closes the joints. The step then equals that of
// the general code, to the bit.
BOOST_AUTO_TEST_CASE(steps_without_such_an_impulse_are_handed_on) {
  Scene scene = chain(2);
  for (Body& body : scene.bodies) body.angular_velocity = {0, 9, 0}, body.velocity = Vec3(0, 9, 0).cross(body.position);
  const BodyTable all = stepped(scene, true, 3, 1.0 / 3), general = stepped(scene, false, 3, 1.0 / 3);
  BOOST_TEST(largest_difference(all, general) == 0);
}

BOOST_AUTO_TEST_CASE(other_joints_and_pairs_held_twice_are_not_taken) {
  const Scene taken = hinged(chain(3));
  BOOST_TEST(BallJoints::are_all_of(taken));
  Scene sliding = taken, limited = taken, driven = taken, twice = taken;
  sliding.joints[1].type = SliderJoint{Vec3::UnitX()};
  limited.joints[2].upper = 1;
  driven.motors.push_back({.joint = 0, .speed = 1.0, .most = 2});
  twice.joints.push_back({.a = 1, .b = 0, .type = BallJoint{Vec3(1, 2, 3)}});
  for (const Scene* scene : {&sliding, &limited, &driven, &twice}) BOOST_TEST(!BallJoints::are_all_of(*scene));
}

BOOST_AUTO_TEST_SUITE_END()
