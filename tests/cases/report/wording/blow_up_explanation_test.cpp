// Why runs blew up, on real runs whose reason is known.
#include "cases/report/wording/explanations/blow_up_explanation.h"

#include <boost/test/unit_test.hpp>

#include "cases/report/wording/explanations/explanation.h"
#include "cases/runner/grid.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_blow_up_explanation)

namespace {

Results ran(Scene scene, const std::vector<std::string>& names, const StepSize& dt, double duration = 5) {
  Case definition;
  definition.id = "a/case", definition.title = "a case", definition.scene = std::move(scene);
  definition.duration = duration, definition.dt = {dt};
  std::vector<RunName> runs;
  for (const std::string& name : names) runs.push_back(parse_run_name(name, engines().infos()));
  Results grid = plan_grid({definition}, runs, engines(), {false});
  GridOptions options;
  options.stable_steps = false;
  run_grid(grid, engines(), options, [](std::size_t, std::size_t) {});
  return grid;
}

std::string said_of(const Results& grid) {
  std::string text;
  for (const Message& message : explanations(grid, grid.cases.front())) text += message.text + "\n";
  return text;
}

const Claim* claim_of(const std::vector<Message>& messages, const std::string& quantity, const std::string& run = "") {
  for (const Message& message : messages)
    for (const Claim& claim : message.claims)
      if (claim.quantity == quantity && claim.of_run == run) return &claim;
  return nullptr;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const StepSize kThirtieth{1.0 / 30, "1/30"};

}  // namespace

// 1 kg on 100 N/m and 100 N s/m: c dt/m = 3.33. Explicit Euler's step has the eigenvalue -2.2997, and its energy grows
// by 5.29 in each step, not by 1 + (omega dt)^2 = 1.11.
BOOST_AUTO_TEST_CASE(a_straight_damper_is_no_swing_that_turns_its_spring) {
  Scene scene;
  scene.bodies = {test::body("piston", 1, {0.01, 0.01, 0.01}, {1, 0, 0})};
  scene.bodies[0].velocity = {2, 0, 0};
  scene.springs = {test::spring(kWorld, Vec3::Zero(), 0, Vec3::Zero(), 100, 1, 100)};
  const Results grid =
      ran(scene, {"core:explicit-euler", "core:semi-implicit-euler", "core:rk4", "ode"}, kThirtieth, 2);
  const std::string said = said_of(grid);
  BOOST_TEST(has(said, "c dt/m = 3.3; a semi-implicit step needs less than 2"), said);
  BOOST_TEST(has(said, "5.29 (core:explicit-euler)"), said);
  BOOST_TEST(has(said, "Remedy: dt below 20 ms"), said);
  for (const char* part : {"swings", "1.11", "Not explained"}) BOOST_TEST(!has(said, part), said);
}

// A robot's wrist: 0.5 N m s on 8e-5 kg m^2.
BOOST_AUTO_TEST_CASE(a_joint_damper_too_strong_for_the_step_is_named_with_its_joint_and_a_remedy) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {test::body("arm", 2, {0.1, 0.1, 0.1}, {0.5, 0, 0}),
                  test::body("hand", 0.1, {8e-5, 8e-5, 8e-5}, {1, 0, 0})};
  scene.joints = {
      {.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3(0, 1, 0)}, .name = "shoulder", .damping = 0.5},
      {.a = 0, .b = 1, .type = HingeJoint{Vec3(1, 0, 0), Vec3(1, 0, 0)}, .name = "wrist", .damping = 0.5}};
  scene.bodies[1].angular_velocity = {1, 0, 0};
  const Results grid = ran(scene, {"core:semi-implicit-euler", "ode", "mujoco"}, kThirtieth, 2);
  const std::string said = said_of(grid);
  BOOST_TEST(has(said, "joint 'wrist' has a damper of 0.5 N m s/rad on an inertia of 8e-5 kg m²"), said);
  BOOST_TEST(has(said, "c dt/I = 210; a semi-implicit step needs less than 2"), said);
  BOOST_TEST(has(said, "Remedy: dt below 320 µs, or less damping"), said);
  BOOST_TEST(!has(said, "search for the largest stable step"), said);
}

// A servo of 1 N m/rad and 0.05 N m s/rad on 9e-4 kg m²: 1.23 + 3.70 at 1/30 s. Its eigenvalue there is -1.61, so that
// the energy grows by 2.61 a step.
BOOST_AUTO_TEST_CASE(a_servo_too_stiff_for_the_step_is_named_with_its_joint_and_a_remedy) {
  Scene scene;
  scene.bodies = {test::body("hand", 0.7, {9e-4, 9e-4, 9e-4}, {0, 0, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3(1, 0, 0)}, .name = "wrist"}};
  Servo servo;
  servo.kp = 1, servo.kd = 0.05, servo.target = TimeTable::constant(0.3);
  Motor motor{.joint = 0, .speed = {}};
  motor.servo = servo;
  scene.motors = {motor};
  const Results grid = ran(scene, {"core:semi-implicit-euler", "ode", "mujoco", "simbody"}, kThirtieth, 5);
  const std::string said = said_of(grid);
  BOOST_TEST(
      has(said, "the servo of joint 'wrist' has kp = 1 N m/rad and kd = 0.05 N m s/rad on an inertia of 9e-4 kg m²"),
      said);
  BOOST_TEST(has(said, "At dt = 1/30 s this is 4.9"), said);
  BOOST_TEST(has(said, "2.61 ("), said);
  BOOST_TEST(has(said, "Remedy: dt below 28 ms, or smaller gains"), said);
  for (const char* part : {"Not explained", "has a damper"}) BOOST_TEST(!has(said, part), said);
  motor.servo->period = 1.0 / 30, scene.motors = {motor};  // sampled: its period decides, and no smaller dt would help
  BOOST_TEST(!has(said_of(ran(scene, {"ode"}, kThirtieth, 5)), "Remedy: dt below"));
}

BOOST_AUTO_TEST_CASE(an_orientation_that_is_no_rotation_is_the_reason_with_springs_and_without) {
  const std::string additive = "core:semi-implicit-euler,orientation=matrix-additive";
  Scene tumbling = test::tumbling_body();
  tumbling.bodies[0].angular_velocity *= 10;
  for (const Scene& scene : {test::fixed_spring(), tumbling}) {
    const Results grid =
        ran(scene, {additive, "core:semi-implicit-euler,orientation=matrix-rodrigues"}, kThirtieth, 10);
    const std::string said = said_of(grid);
    BOOST_TEST((grid.cases[0].cells[0].stability.verdict == Verdict::blown_up));
    BOOST_TEST(has(said, "the orientation is no rotation any more"), said);
    BOOST_TEST(has(said, additive + " "), said);
    BOOST_TEST(has(said, "Remedy: orientation=matrix-rodrigues"), said);
    for (const char* part : {"swings", "Not explained"}) BOOST_TEST(!has(said, part), said);
  }
}

// At omega dt = 1.8 a semi-implicit step is stable and the core's Adams method is not: its own bound is smaller.
BOOST_AUTO_TEST_CASE(a_method_with_a_smaller_bound_is_explained_by_what_it_does_to_an_oscillator) {
  Scene scene;
  scene.bodies = {test::body("weight", 1, {1, 1, 1}, {0, 1.1, 0})};
  scene.springs = {test::spring(kWorld, Vec3::Zero(), 0, Vec3::Zero(), 54 * 54, 1)};
  const Results grid = ran(scene, {"core:adams", "core:semi-implicit-euler"}, kThirtieth);
  const auto messages = blow_up_explanations(grid, grid.cases.front());
  const Claim* growth = claim_of(messages, "energy growth", "core:adams");
  BOOST_TEST_REQUIRE(growth);
  BOOST_TEST(growth->value > 1.5);
  BOOST_TEST(!claim_of(messages, "energy growth", "core:semi-implicit-euler"));
  BOOST_TEST(!has(said_of(grid), "swings"), said_of(grid));
}

// Bodies that stand, and one whose error of the first second is by chance that of a fall.
BOOST_AUTO_TEST_CASE(nothing_misses_a_fall_where_bodies_may_stand) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  scene.bodies = {test::body("ball", 1, {1, 1, 1}, {0, 100, 0})};
  const Results falling = ran(scene, {"core:semi-implicit-euler"}, kThirtieth, 2);
  Case with_truth = falling.cases[0].definition;
  Results grid = falling;
  grid.cases[0].cells[0].metrics["position_error"].not_applicable = "";
  grid.cases[0].cells[0].metrics["position_error"].first_second = 9.81 / 60;
  BOOST_TEST(
      has(said_of(grid), "After 1 s at dt = 1/30 s a fall is off by g dt t/2 = 160 mm: core:semi-implicit-euler"),
      said_of(grid));
  Scene& standing = grid.cases[0].definition.scene;
  standing.bodies[0].shape = Sphere{1}, standing.bodies[0].collides = true;
  standing.bodies.push_back(test::body("ground", 1, {1, 1, 1}));
  standing.bodies[1].fixed = standing.bodies[1].collides = true, standing.bodies[1].shape = Plane{Vec3(0, 1, 0), 0};
  BOOST_TEST(!has(said_of(grid), "a fall is off"), said_of(grid));
}

BOOST_AUTO_TEST_SUITE_END()
