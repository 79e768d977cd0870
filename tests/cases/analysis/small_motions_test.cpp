#include "cases/analysis/small_motions/small_motions.h"

#include <boost/test/unit_test.hpp>

#include "cases/analysis/small_motions/oscillator_growth.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_small_motions)

namespace {

const auto kRounding = boost::test_tools::tolerance(1e-9);  // of dense factors

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_without_springs_and_dampers_has_no_small_motions) {
  BOOST_TEST(!SmallMotions::of(test::tumbling_body()));
}

BOOST_AUTO_TEST_CASE(a_mass_on_a_spring_and_damper_has_its_own_frequency_and_rate) {
  Scene scene;
  scene.bodies = {test::body("weight", 4, {1, 2, 3}, {0, 1, 0})};
  scene.springs = {test::spring(kWorld, {0, 2, 0}, 0, Vec3::Zero(), 100, 1, 8)};
  const auto motions = SmallMotions::of(scene).value();
  BOOST_TEST(motions.stiffest().frequency == 5, kRounding);
  BOOST_TEST(motions.stiffest().rate == 2, kRounding);
  BOOST_TEST(motions.elements()[0].inertia == 4, kRounding);
}

// A rod on a hinge turns about the hinge: its inertia there, m l²/3, counts, whatever its inertia about the centre.
BOOST_AUTO_TEST_CASE(a_joint_adds_the_mass_that_it_carries) {
  Scene scene;
  scene.bodies = {test::body("rod", 3, {0.01, 0.25, 0.25}, {0.5, 0, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3(0, 0, 1)}, .stiffness = 4, .damping = 2}};
  const auto motions = SmallMotions::of(scene).value();
  BOOST_TEST(motions.elements()[0].inertia == 1, kRounding);  // 0.25 + 3 × 0.5²
  BOOST_TEST(motions.stiffest().frequency == 2, kRounding);
  BOOST_TEST(motions.most_damped()->damping_rate() == 2, kRounding);
}

// Two masses on a rail and a slider between them: the reduced mass.
BOOST_AUTO_TEST_CASE(a_slider_between_two_bodies_moves_their_reduced_mass) {
  Scene scene;
  scene.bodies = {test::body("a", 3, {1, 1, 1}), test::body("b", 6, {1, 1, 1}, {1, 0, 0})};
  scene.joints = {{.a = 0, .b = 1, .type = SliderJoint{Vec3(1, 0, 0)}, .damping = 1}};
  BOOST_TEST(SmallMotions::of(scene).value().elements()[0].inertia == 2, kRounding);
}

// The rotor turns with the rod, so its inertia counts beside the rod's.
BOOST_AUTO_TEST_CASE(a_rotor_adds_its_inertia) {
  Scene scene;
  scene.bodies = {test::body("rod", 3, {0.01, 0.25, 0.25}, {0.5, 0, 0})};
  scene.joints = {{.a = kWorld,
                   .b = 0,
                   .type = HingeJoint{Vec3::Zero(), Vec3(0, 0, 1)},
                   .stiffness = 4,
                   .damping = 2,
                   .armature = 3}};
  BOOST_TEST(SmallMotions::of(scene).value().elements()[0].inertia == 1 + 3, kRounding);
}

// x = 3 y: an effort on y moves I_y + 3² I_x.
BOOST_AUTO_TEST_CASE(a_coupling_moves_both_wheels) {
  Scene scene;
  scene.bodies = {test::body("fast", 1, {1, 1, 0.2}), test::body("slow", 1, {1, 1, 0.7}, {1, 0, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}},
                  {.a = kWorld, .b = 1, .type = HingeJoint{Vec3(1, 0, 0), Vec3::UnitZ()}, .damping = 1}};
  scene.couplings = {{.joint = 0, .to = {{1, 3}}}};
  BOOST_TEST(SmallMotions::of(scene).value().elements()[0].inertia == 0.7 + 9 * 0.2, kRounding);
}

// s = x - 2 y: a unit of effort on s pushes x by 1/m_x and y by -2/m_y, so s by 1/m_x + 4/m_y.
BOOST_AUTO_TEST_CASE(a_servo_on_two_sliders_feels_both_masses) {
  Scene scene;
  scene.bodies = {test::body("x", 0.5, {1, 1, 1}), test::body("y", 3, {1, 1, 1}, {0, 1, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}},
                  {.a = kWorld, .b = 1, .type = SliderJoint{Vec3::UnitX()}}};
  scene.motors = {{.joint = 0, .servo = Servo{.target = TimeTable::constant(1), .kp = 7}, .plus = {{1, -2}}}};
  BOOST_TEST(SmallMotions::of(scene).value().elements()[0].inertia == 1 / (1 / 0.5 + 4 / 3.0), kRounding);
}

// A slider and a hinge in series carry a rod: the hinge's damper sees the rod's inertia about the anchor, less what the
// free slider gives way: I + m l² - (m l)²/m with the rod across the slider.
BOOST_AUTO_TEST_CASE(axes_of_a_compound_joint_are_coordinates) {
  Scene scene;
  scene.bodies = {test::body("rod", 3, {0.25, 0.25, 0.25}, {0, 0.5, 0})};
  const std::vector<SeriesAxis> axes = {{false, Vec3::Zero(), Vec3::UnitX()}, {true, Vec3::Zero(), Vec3::UnitZ()}};
  scene.joints = {
      {kWorld, 0, CompoundJoint{axes}}, {kWorld, 0, CompoundAxis{axes, 0}}, {kWorld, 0, CompoundAxis{axes, 1}}};
  scene.joints[2].damping = 1;
  BOOST_TEST(SmallMotions::of(scene).value().elements()[0].inertia == 0.25, kRounding);
  // With the slider kept by a rotor of the rod's mass: half of the rod's m l gives way.
  scene.joints[1].armature = 3;
  BOOST_TEST(SmallMotions::of(scene).value().elements()[0].inertia == 0.25 + 0.75 - 1.5 * 1.5 / 6, kRounding);
}

BOOST_AUTO_TEST_CASE(a_semi_implicit_step_is_bounded_by_frequency_and_damping) {
  BOOST_TEST(largest_semi_implicit_step({10, 0}) == 0.2, kRounding);
  BOOST_TEST(largest_semi_implicit_step({0, 10}) == 0.2, kRounding);
  const double both = largest_semi_implicit_step({10, 100});  // 100 h² + 200 h = 4
  BOOST_TEST(100 * both * both + 200 * both == 4, kRounding);
}

// Explicit Euler on an undamped oscillator multiplies its energy by 1 + (omega dt)² in every step; on a damper alone by
// (1 - c dt)².
BOOST_AUTO_TEST_CASE(methods_grow_an_oscillator_as_theory_has_it) {
  using Kind = ForceElement::Kind;
  const auto kMeasured = boost::test_tools::tolerance(1e-5);  // 1e-7 of rounding in a place of 1 m
  BOOST_TEST(energy_growth("core:explicit-euler", Kind::spring, {10, 0}, 0.03).value() == 1.09, kMeasured);
  BOOST_TEST(energy_growth("core:explicit-euler", Kind::hinge, {0, 100}, 0.03).value() == 4, kMeasured);
  BOOST_TEST(energy_growth("core:explicit-euler", Kind::slider, {0, 100}, 0.03).value() == 4, kMeasured);
  BOOST_TEST(energy_growth("core:semi-implicit-euler", Kind::spring, {10, 0}, 0.19).value() < 1.001);
  BOOST_TEST(energy_growth("core:semi-implicit-euler", Kind::spring, {10, 0}, 0.21).value() > 1.5);
  BOOST_TEST(energy_growth("core:rk4", Kind::spring, {10, 0}, 0.27).value() < 1.001);  // bound 2.83
  BOOST_TEST(energy_growth("core:rk4", Kind::spring, {10, 0}, 0.29).value() > 1.01);
  BOOST_TEST(!energy_growth("ode", Kind::spring, {10, 0}, 0.1));        // no run of the core
  BOOST_TEST(!energy_growth("core:adams", Kind::hinge, {10, 0}, 0.1));  // no joints
  BOOST_TEST(!energy_growth("core:no-such-method", Kind::spring, {10, 0}, 0.1));
}

BOOST_AUTO_TEST_SUITE_END()
