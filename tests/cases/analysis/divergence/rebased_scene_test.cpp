// A scene in a later state of its motion goes on as the motion does.
#include "cases/analysis/divergence/rebased_scene.h"

#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "cases/analysis/repeats/recorded_states.h"
#include "core/engine/run_name.h"
#include "tests/scenes.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_analysis_divergence_rebased_scene)

namespace {

constexpr double kStep = 1e-3;  // s

std::vector<BodyState> state_of(const RecordedStates& states, std::size_t sample) {
  std::vector<BodyState> all;
  for (std::size_t i = 0; i < states.bodies; ++i) {
    const double* x = states.body(sample, i);
    all.push_back(
        {Vec3(x[0], x[1], x[2]), Quat(x[3], x[4], x[5], x[6]), Vec3(x[7], x[8], x[9]), Vec3(x[10], x[11], x[12])});
  }
  return all;
}

// The distance of the motion from the same motion continued from its middle.
PoseDistance continued(const Scene& scene, long steps, long middle, const std::string& run_name = "core:rk4") {
  const RunName run = parse_run_name(run_name, engines().infos());
  const Engine& engine = engines().find(run.engine);
  const RecordedStates whole = recorded(engine, run.settings, scene, kStep, steps);
  JointCoordinates coordinates(scene);
  for (long n = 0; n <= middle; ++n) coordinates.follow(state_of(whole, static_cast<std::size_t>(n)));
  const Scene rest = rebased(scene, state_of(whole, static_cast<std::size_t>(middle)), coordinates.values(),
                             kStep * static_cast<double>(middle));
  RecordedStates again = recorded(engine, run.settings, rest, kStep, steps - middle);
  RecordedStates due;
  due.bodies = whole.bodies;
  due.values.assign(whole.body(static_cast<std::size_t>(middle), 0), whole.values.data() + whole.values.size());
  return pose_distance(due, again, again.samples() - 1);
}

// A cart on a slider with a spring, and a rod on it with a spiral spring, limits and drives in time.
Scene driven_cart() {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {body("cart", 2, {0.1, 0.1, 0.1}), body("rod", 1, {0.08, 0.08, 0.01}, {0, 0, -0.5})};
  Joint rail{kWorld, 0, SliderJoint{Vec3::UnitX()}, "rail"};
  rail.stiffness = 40, rail.rest = 0.3, rail.damping = 0.2;
  Joint pivot{0, 1, HingeJoint{Vec3::Zero(), Vec3::UnitY()}, "pivot"};
  pivot.stiffness = 2, pivot.rest = -0.4;
  scene.joints = {rail, pivot};
  Motor push, turn;
  push.joint = 0, push.efforts = TimeTable{{0, 0.2, 0.7, 1}, {0, 5, -5, 2}, true};
  turn.joint = 1, turn.from = 0.3, turn.until = 0.9;
  turn.servo = Servo{TimeTable{{0, 1}, {0.2, -0.5}, true}, 6, 0.5};
  scene.motors = {push, turn};
  TimedForce force;
  force.body = 1, force.force = {0.5, 0, 0.2}, force.from = 0.1, force.until = 0.55;
  scene.forces = {force};
  return scene;
}

// The joint and behind it a row for each axis, named "axis-1" and so on.
void add_compound(Scene& scene, int a, int b, const std::vector<SeriesAxis>& axes) {
  scene.joints.push_back({a, b, CompoundJoint{axes}});
  for (std::size_t i = 0; i < axes.size(); ++i) {
    scene.joints.push_back({a, b, CompoundAxis{axes, i}});
    scene.joints.back().name = "axis-" + std::to_string(i + 1);
  }
}

// A torso on two sliders and a hinge, as the root of a planar walker, and a leg on a hip of three hinges whose axes
// meet at odd angles; springs, limits, a servo and a torque act on single axes.
Scene jointed_walker() {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {body("torso", 4, {0.1, 0.12, 0.05}, {0, 0, 1}), body("leg", 1, {0.05, 0.06, 0.01}, {0.1, 0.2, 0.5})};
  add_compound(scene, kWorld, 0,
               {{false, Vec3::Zero(), Vec3::UnitX()},
                {false, Vec3::Zero(), Vec3::UnitZ()},
                {true, {0.2, 0, 1.1}, Vec3::UnitY()}});
  add_compound(scene, 0, 1,
               {{true, {0.05, 0.1, 0.8}, Vec3::UnitX()},
                {true, {0.1, 0.1, 0.8}, Vec3(0.2, 0, 1).normalized()},
                {true, {0.1, 0.15, 0.75}, Vec3::UnitY()}});
  scene.joints[2].stiffness = 300, scene.joints[2].rest = -0.1;
  scene.joints[3].stiffness = 20, scene.joints[3].rest = 0.4;
  scene.joints[5].stiffness = 6, scene.joints[5].rest = 0.3;
  scene.joints[7].stiffness = 9, scene.joints[7].rest = -0.5, scene.joints[7].damping = 0.05;
  scene.joints[7].armature = 0.02;
  Motor push, hold;
  push.joint = 1, push.efforts = TimeTable{{0, 0.5, 1}, {0, 20, -10}, true};
  hold.joint = 6, hold.servo = Servo{TimeTable{{0, 1}, {0, 0.6}, true}, 8, 0.3};
  scene.motors = {push, hold};
  return scene;
}

}  // namespace

// Anchors that close again and renormalised orientations leave roundings, which a second amplifies little.
BOOST_AUTO_TEST_CASE(joints_springs_drives_and_forces_go_on_from_any_state) {
  for (const long middle : {1L, 250L, 600L, 950L}) {
    const PoseDistance off = continued(driven_cart(), 1200, middle);
    BOOST_TEST(off.position < 1e-9, "from step " << middle);
    BOOST_TEST(off.angle < 1e-9, "from step " << middle);
  }
}

// The hip's angles are coordinates of one rotation: that of an axis is not the angle between the bodies about it.
BOOST_AUTO_TEST_CASE(axes_in_series_go_on_from_any_state) {
  for (const long middle : {1L, 300L, 700L, 1100L}) {
    const PoseDistance off = continued(jointed_walker(), 1200, middle);
    BOOST_TEST(off.position < 1e-9, "from step " << middle << ": " << off.position);
    BOOST_TEST(off.angle < 1e-9, "from step " << middle << ": " << off.angle);
  }
}

// Limits of a middle axis: after 1.2 rad of its 1.5 the rest is left, though both neighbours have turned, too.
BOOST_AUTO_TEST_CASE(a_limit_of_an_axis_in_series_is_what_is_left_of_it) {
  Scene scene;
  scene.bodies = {body("top", 1, {0.1, 0.1, 0.1})};
  add_compound(scene, kWorld, 0,
               {{true, Vec3::Zero(), Vec3::UnitZ()},
                {true, Vec3::Zero(), Vec3::UnitX()},
                {true, Vec3::Zero(), Vec3::UnitZ() + 0.5 * Vec3::UnitX().cross(Vec3::UnitZ())}});
  for (std::size_t k : {0, 1, 2, 3}) {
    auto* axis = std::get_if<CompoundAxis>(&scene.joints[k].type);
    for (SeriesAxis& one : axis ? axis->axes : std::get<CompoundJoint>(scene.joints[k].type).axes) one.axis.normalize();
  }
  scene.joints[2].lower = -0.2, scene.joints[2].upper = 1.5;
  const Vec3 last = std::get<CompoundAxis>(scene.joints[3].type).own().axis;
  const auto state_at = [&](double share) {
    const Quat turn =
        rotation_by(Vec3(0, 0, 4 * share)) * rotation_by(Vec3(1.2 * share, 0, 0)) * rotation_by((-0.7 * share) * last);
    return std::vector<BodyState>{{Vec3::Zero(), turn, Vec3::Zero(), Vec3::Zero()}};
  };
  JointCoordinates coordinates(scene);
  for (int n = 0; n <= 20; ++n) coordinates.follow(state_at(0.05 * n));
  BOOST_TEST(coordinates.values()[1] == 4, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(coordinates.values()[2] == 1.2, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(coordinates.values()[3] == -0.7, boost::test_tools::tolerance(1e-12));
  const Scene rest = rebased(scene, state_at(1), coordinates.values(), 1);
  BOOST_TEST(rest.joints[2].upper == 0.3, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(rest.joints[2].lower == -1.4, boost::test_tools::tolerance(1e-12));
  const Vec3 middle = std::get<CompoundAxis>(rest.joints[2].type).own().axis;
  BOOST_TEST((middle - Vec3(std::cos(4.0), std::sin(4.0), 0)).norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(springs_of_free_bodies_go_on) {
  const PoseDistance off = continued(coupled_bodies(0.3), 1000, 333);
  BOOST_TEST(off.position < 1e-10);
  BOOST_TEST(off.angle < 1e-10);
}

// Limits count whole turns: after one and a half turns one more quarter is left.
BOOST_AUTO_TEST_CASE(a_limit_counts_whole_turns) {
  Scene scene;
  scene.bodies = {body("wheel", 1, {0.1, 0.1, 0.1})};
  scene.bodies[0].angular_velocity = {0, 0, 10};
  Joint axle{kWorld, 0, HingeJoint{Vec3::Zero(), Vec3::UnitZ()}, "axle"};
  axle.lower = -1, axle.upper = 11;
  scene.joints = {axle};
  JointCoordinates coordinates(scene);
  std::vector<BodyState> now;
  for (int n = 0; n <= 100; ++n) {
    const double angle = 0.1 * n;
    now = {{Vec3::Zero(), rotation_by(Vec3(0, 0, angle)), Vec3::Zero(), Vec3(0, 0, 10)}};
    coordinates.follow(now);
  }
  BOOST_TEST(coordinates.values()[0] == 10, boost::test_tools::tolerance(1e-12));
  const Scene rest = rebased(scene, now, coordinates.values(), 1);
  BOOST_TEST(rest.joints[0].upper == 1, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(rest.joints[0].lower == -11, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(what_has_ended_is_gone) {
  Scene scene = driven_cart();
  const std::vector<BodyState> start = {{}, {Vec3(0, 0, -0.5)}};
  const Scene late = rebased(scene, start, {0, 0}, 0.95);
  BOOST_TEST(late.forces.empty());
  BOOST_TEST(late.motors.size() == 1u);
}

BOOST_AUTO_TEST_SUITE_END()
