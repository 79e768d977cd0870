// Joint loads: compared with independent numbers, and with the accelerations of a truth that has no reactions.
#include "cases/metrics/measures/joints/joint_reactions.h"

#include <boost/test/unit_test.hpp>

#include "cases/case/suite.h"
#include "cases/truth/truth.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"
#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_joints_joint_reactions)

namespace {

Scene suite_scene(const std::string& id) {
  return read_scene(TomlFile::read(default_suite_dir() + "/" + id + ".toml").root(case_keys()).at("scene"));
}

BodyTable start_of(const Scene& scene) {
  BodyTable bodies(scene.bodies.size());
  set_initial_state(scene, bodies.columns());
  return bodies;
}

JointReaction first_reaction(const Scene& scene, BodyColumns bodies) {
  JointReactions reactions(scene);
  return reactions.at(bodies, 0).value().front();
}

// A truth's velocities, differentiated, are accelerations that owe nothing to any reaction: m a - m g is what joints
// and springs put on a body, whatever their redundancy.
void check_against_truth(const Scene& scene, const std::string& id) {
  const auto truth = make_truth("reference", scene, 1);
  constexpr double kTime = 0.7, kHalf = 1e-4;  // s; central differences are off by kHalf² a'' / 6
  const std::size_t count = scene.bodies.size();
  const BodyTable before = test::truth_at(*truth, kTime - kHalf, count), now = test::truth_at(*truth, kTime, count),
                  after = test::truth_at(*truth, kTime + kHalf, count);
  JointReactions reactions(scene);
  const auto carried = reactions.at(now.columns(), kTime).value();
  const System system(scene);
  Wrenches sums;
  system.wrenches(now.columns(), kTime, 0, sums);
  for (std::size_t k = 0; k < carried.size(); ++k) {
    const JointGeometry joint(scene, scene.joints[k]);
    const Vec3 place = end_motion(joint.b(), now.columns()).point();
    const auto put = [&](int body, double sign) {
      if (body == kWorld) return;
      const Vec3 arm = place - now.columns().position(body);
      sums[body].force += sign * carried[k].force;
      sums[body].torque += sign * (arm.cross(carried[k].force) + carried[k].couple);
    };
    put(scene.joints[k].a, -1), put(scene.joints[k].b, 1);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Inertia& body = system.bodies[i];
    if (body.fixed) continue;
    const Vec3 a = (after.columns().velocity(i) - before.columns().velocity(i)) / (2 * kHalf),
               turning = (after.columns().angular_velocity(i) - before.columns().angular_velocity(i)) / (2 * kHalf),
               expected = angular_acceleration(body, now.columns().rotation(i), now.columns().angular_velocity(i),
                                               sums[i].torque);
    BOOST_TEST_CONTEXT(id << " '" << scene.bodies[i].name << "'") {
      BOOST_TEST((a - body.inverse_mass * sums[i].force).norm() < 1e-5 * (1 + a.norm()));
      BOOST_TEST((turning - expected).norm() < 1e-5 * (1 + turning.norm()));
    }
  }
}

}  // namespace

// A rod on a hinge: m g/(1 + m d²/I) = m g/4 (nearly) where it is let go, and m (g + w² d) at the bottom.
BOOST_AUTO_TEST_CASE(the_force_on_a_pendulums_hinge) {
  const Scene scene = suite_scene("joints/pendulum-90");
  BodyTable bodies = start_of(scene);
  const JointReaction level = first_reaction(scene, bodies.columns());
  BOOST_TEST((level.force - Vec3(0, 2.457095565, 0)).norm() < 0.5e-9);  // half of its last digit
  BOOST_TEST(level.couple.norm() < 1e-15);
  const double w = std::sqrt(2 * 9.81 * 0.5 / (0.08354166666666667 + 0.25));
  bodies.columns().set_body(0, {{0, -0.5, 0}, Quat(1, 0, 0, -1).normalized(), {-0.5 * w, 0, 0}, {0, 0, -w}});
  BOOST_TEST((first_reaction(scene, bodies.columns()).force - Vec3(0, 24.515808869, 0)).norm() < 0.5e-9);
}

BOOST_AUTO_TEST_CASE(the_tension_of_the_conical_pendulum) {
  const Scene scene = suite_scene("joints/conical");
  const JointReaction pull = first_reaction(scene, start_of(scene).columns());
  BOOST_TEST(std::abs(pull.force.norm() - 11.327612282) < 0.6e-9);  // m g/cos 30°, printed to nine decimals
  BOOST_TEST((pull.force.normalized() - Vec3(-0.5, 0, std::sqrt(0.75))).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(what_holds_a_level_gyroscope) {
  const Scene scene = suite_scene("joints/gyroscope");
  const Vec3 force = first_reaction(scene, start_of(scene).columns()).force;
  BOOST_TEST((force - Vec3(-1.5397776, 0, 19.62)).norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(the_bearings_of_unbalanced_rotors) {
  const Scene level = suite_scene("joints/rotor-unbalanced");
  const JointReaction rotor = first_reaction(level, start_of(level).columns());
  BOOST_TEST((rotor.force - Vec3(0, -36.5291391, 149.2712583)).norm() < 1e-7);
  BOOST_TEST((rotor.couple - Vec3(0, -116.200593, -14.2874553)).norm() < 1e-6);  // its last digit is of 1e-6
  const Scene off_axis = suite_scene("joints/hinge-off-axis");
  const JointReaction wobbling = first_reaction(off_axis, start_of(off_axis).columns());
  BOOST_TEST((wobbling.couple - Vec3(0.6, -2.64, 2.04)).norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(reactions_and_loads_move_each_body_as_the_truth_moves) {
  for (const char* id : {"joints/cart-pendulum", "joints/welded-pair", "mechanisms/cardan-shaft", "mechanisms/four-bar",
                         "mechanisms/slider-crank", "mechanisms/satellite", "joints/spherical-pendulum"})
    check_against_truth(suite_scene(id), id);
}

// Of a slider that two moving bodies share the force on a acts where b is; a link that turns pulls for turning.
BOOST_AUTO_TEST_CASE(a_bead_on_a_turning_rod_and_one_on_a_link_move_as_the_truth_moves) {
  Scene scene;
  scene.gravity = {1, -9.81, 2};
  scene.bodies = {test::body("rod", 3, {0.02, 0.3, 0.31}), test::body("bead", 1, {0.01, 0.02, 0.015}, {0.4, 0, 0})};
  scene.bodies[0].angular_velocity = scene.bodies[1].angular_velocity = {0, 0, 2};
  scene.bodies[1].velocity = {0.3, 0.8, 0};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}},
                  {.a = 0, .b = 1, .type = SliderJoint{Vec3::UnitX()}}};
  check_against_truth(scene, "rod and bead");
  scene.bodies.resize(1);
  scene.bodies[0].position = {0.6, 0, 0}, scene.bodies[0].angular_velocity = {1, 2, 3};
  // The link's end, 0.2 m beside the centre, moves at (0.5, 1.5, 0.3) m/s, across the link.
  scene.bodies[0].velocity = {-0.1, 1.5, 0.5};
  scene.joints = {{.a = kWorld, .b = 0, .type = DistanceJoint{Vec3::Zero(), {0, -0.2, 0}}}};
  check_against_truth(scene, "link");
  // Held by a fixed body, which comes first, instead of the world.
  scene.bodies.insert(scene.bodies.begin(), test::body("post", 1, {1, 1, 1}));
  scene.bodies[0].fixed = true;
  scene.joints = {{.a = 0, .b = 1, .type = BallJoint{Vec3::Zero()}}};
  scene.bodies[1].velocity = scene.bodies[1].angular_velocity.cross(scene.bodies[1].position);
  check_against_truth(scene, "post");
}

// Hinges that all turn about y leave of each other's reactions unknown what acts along y or bends them.
BOOST_AUTO_TEST_CASE(only_in_its_plane_a_plane_loop_tells_what_its_joints_carry) {
  const Scene scene = suite_scene("mechanisms/four-bar");
  JointReactions reactions(scene);
  BOOST_REQUIRE(reactions.at(start_of(scene).columns(), 0).has_value());
  const auto found = reactions.unique().value();
  for (const UniqueReaction& unique : found) {
    BOOST_TEST((unique.force - Mat3(Vec3(1, 0, 1).asDiagonal())).norm() < 1e-9);
    BOOST_TEST(unique.couple.norm() == 0);
  }
  const Scene tree = suite_scene("joints/double-pendulum");
  JointReactions of_tree(tree);
  BOOST_REQUIRE(of_tree.at(start_of(tree).columns(), 0).has_value());
  const auto all = of_tree.unique().value();
  for (const UniqueReaction& unique : all)
    BOOST_TEST((unique.force - Mat3::Identity()).norm() + (unique.couple - Mat3::Identity()).norm() < 1e-14);
}

// The loads of two equal hinges are not determined individually; their effect on the motion is the same.
BOOST_AUTO_TEST_CASE(nothing_is_unique_in_a_joint_that_is_there_twice) {
  Scene scene = suite_scene("joints/pendulum-90");
  scene.joints.push_back(scene.joints[0]);
  JointReactions reactions(scene);
  BOOST_REQUIRE(reactions.at(start_of(scene).columns(), 0).has_value());
  const auto none = reactions.unique().value();
  for (const UniqueReaction& unique : none) BOOST_TEST(unique.force.norm() + unique.couple.norm() == 0);
  const auto carried = reactions.at(start_of(scene).columns(), 0).value();
  BOOST_TEST((carried[0].force + carried[1].force - Vec3(0, 2.457095565, 0)).norm() < 0.5e-9);
}

// A body held at two points: what acts along the line between them may be of either.
BOOST_AUTO_TEST_CASE(what_two_points_of_a_body_carry_is_unique_but_along_their_line) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::body("held", 2, {1, 2, 3})};
  const Vec3 apart(0.3, 0.5, -0.7), along = apart.normalized();
  scene.joints = {{.a = kWorld, .b = 0, .type = BallJoint{Vec3::Zero()}},
                  {.a = kWorld, .b = 0, .type = BallJoint{apart}}};
  JointReactions reactions(scene);
  BOOST_REQUIRE(reactions.at(start_of(scene).columns(), 0).has_value());
  const auto found = reactions.unique().value();
  for (const UniqueReaction& unique : found)
    BOOST_TEST((unique.force - (Mat3::Identity() - along * along.transpose())).norm() < 1e-12);
}

// A hair out of its plane a plane loop would hold itself by forces that have no end.
BOOST_AUTO_TEST_CASE(which_rows_are_in_use_is_decided_at_the_start_whatever_is_asked_first) {
  const Scene scene = suite_scene("mechanisms/four-bar");
  BodyTable bent = start_of(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyState state = std::as_const(bent).columns().body(i);
    bent.columns().set_orientation(
        i, rotation_by(1e-3 * static_cast<double>(i + 1) * Vec3(1, 0.3, 0.5)) * state.orientation);
  }
  JointReactions first(scene), later(scene);
  BOOST_REQUIRE(later.at(start_of(scene).columns(), 0).has_value());
  const auto one = first.at(bent.columns(), 0).value(), other = later.at(bent.columns(), 0).value();
  for (std::size_t k = 0; k < one.size(); ++k) {
    BOOST_TEST((one[k].force - other[k].force).norm() == 0);
    BOOST_TEST((one[k].couple - other[k].couple).norm() == 0);
  }
}

// At an instant, not over what comes after it.
BOOST_AUTO_TEST_CASE(a_force_that_will_end_is_carried_whole_until_it_does) {
  Scene scene;
  scene.gravity.setZero();
  scene.bodies = {test::body("welded", 2, {1, 1, 1})};
  scene.joints = {{.b = 0, .type = FixedJoint{}}};
  scene.forces = {{.body = 0, .force = Vec3(3, 0, 0), .until = 0.5}};
  const BodyTable start = start_of(scene);
  JointReactions reactions(scene);
  for (const auto& [time, carried] : {std::pair(0.2, 3.0), {0.7, 0.0}}) {
    const auto found = reactions.at(start.columns(), time);
    BOOST_TEST_REQUIRE(found.has_value());
    BOOST_TEST(found->front().force.norm() == carried, boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_SUITE_END()
