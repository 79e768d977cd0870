// Laws of jointed bodies that need no truth: the same mechanism, described in another way, must move in the same way.
// The tests run over every method of the core that takes joints. Engines that correct a share of a joint's gap, or
// sweep over joints in an order, satisfy these laws only approximately; their own tests check them.
//
// The allowed difference is rounding, magnified like a small change of the start (see laws_test.cpp), plus the residual
// of a projection, which stops within 1e-12 of the joints' scale.
#include <algorithm>
#include <limits>

#include "cases/metrics/measures/joints/joint_geometry.h"
#include "core/dynamics/model/energy.h"
#include "core/scene/turned.h"
#include "tests/adapters/seam_runs.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_jointed_laws)

namespace {

constexpr double kStep = 1.0 / 240;  // s
constexpr int kSteps = 120;

States end_of(const Run& run, const Scene& scene) { return states_of(state_after(*run.load(scene), kStep, kSteps)); }

// The largest difference in m, rad, m/s and rad/s.
double difference(const States& a, const States& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest =
        std::max({largest, (a[i].position - b[i].position).norm(), angle_between(a[i].orientation, b[i].orientation),
                  (a[i].velocity - b[i].velocity).norm(), (a[i].angular_velocity - b[i].angular_velocity).norm()});
  }
  return largest;
}

// A body of each joint, hung from the world at the first: askew, of full inertia, and let go.
Scene tree() {
  Scene scene;
  scene.gravity = {0.5, -1, -9.81};
  const Vec3 places[] = {{0.3, 0, -0.2},   {0.7, 0.1, -0.4}, {1.1, 0, -0.9},   {0.4, -0.5, -0.3},
                         {1.3, 0.4, -0.9}, {0.9, 0.6, -0.5}, {0.6, -0.8, -0.2}};
  for (int i = 0; i < 7; ++i) {
    Body body = test::body("body " + std::to_string(i), 1 + 0.3 * i, {0.05, 0.06, 0.08}, places[i]);
    body.inertia(0, 1) = body.inertia(1, 0) = 0.01;
    body.orientation = Quat(0.8, 0.2 + 0.1 * i, -0.4, 0.4).normalized();
    scene.bodies.push_back(body);
  }
  const Vec3 axis = Vec3(1, 2, 2) / 3, axis2 = Vec3(2, 1, -2) / 3;
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{{0, 0, 0}, axis}},
                  {.a = 0, .b = 1, .type = UniversalJoint{{0.5, 0.05, -0.3}, axis, axis2}},
                  {.a = 1, .b = 2, .type = BallJoint{{0.9, 0, -0.6}}},
                  {.a = 0, .b = 3, .type = SliderJoint{axis2}},
                  {.a = 2, .b = 4, .type = FixedJoint{}},
                  {.a = 1, .b = 5, .type = DistanceJoint{{0.1, 0, 0}, {0, 0.05, 0}}},
                  {.a = 3, .b = 6, .type = CylindricalJoint{{0.5, -0.6, -0.2}, axis}}};
  return scene;
}

// Two rods in a plane on hinges across it, which are principal axes.
Scene plane_pendulum() {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  scene.bodies = {test::body("upper", 1, {0.002, 0.085, 0.083}, {0.5, 0, 0}),
                  test::body("lower", 1, {0.002, 0.085, 0.083}, {1.5, 0, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{{0, 0, 0}, Vec3::UnitZ()}},
                  {.a = 0, .b = 1, .type = HingeJoint{{1, 0, 0}, Vec3::UnitZ()}}};
  return scene;
}

Scene parallel_cranks() {
  Scene scene = plane_pendulum();
  scene.bodies[1].position = {1, 0.5, 0}, scene.bodies[1].orientation = rotation_by({0, 0, std::acos(0.0)});
  scene.bodies.push_back(test::body("rocker", 1, {0.002, 0.085, 0.083}, {0.5, 1, 0}));
  scene.joints.push_back({.a = 1, .b = 2, .type = HingeJoint{{1, 1, 0}, Vec3::UnitZ()}});
  scene.joints.push_back({.a = kWorld, .b = 2, .type = HingeJoint{{0, 1, 0}, Vec3::UnitZ()}});
  return scene;
}

void for_each_core_run(const Scene& scene, const std::function<void(const Run&)>& check) {
  int checked = 0;
  for (const Run& run : all_runs()) {
    const bool is_own = run.info.name == "core" && run.method().twin_of.empty() && run.settings.track == Track::matched;
    if (!is_own || !run.supports(scene, kStep)) continue;
    BOOST_TEST_CONTEXT(run.name()) check(run);
    ++checked;
  }
  BOOST_TEST(checked >= 8, "of the core's methods that take joints only " << checked);
}

// The growth of a small change of the motion until the end. The change is one of gravity, because moving one body would
// violate its joint.
double growth(const Run& run, const Scene& scene) {
  constexpr double kNudge = 1e-7;
  Scene nudged = scene;
  nudged.gravity += kNudge * Vec3(1, 1, scene.gravity.z() == 0 ? 0 : 1);
  return std::max(1.0, difference(end_of(run, scene), end_of(run, nudged)) / kNudge);
}

// Each step rounds numbers of size ten. Its projection leaves at most 1e-12 of the joints' scale, and mostly far less,
// because each iteration squares the residual. Semi-implicit Euler closes its joints to 1e-11 of a metre in each step;
// divided by the step this is a velocity error.
double tolerance(const Run& run, const Scene& scene) {
  constexpr double kOfAStep = 10 * std::numeric_limits<double>::epsilon();
  const double closing = run.settings.method == "semi-implicit-euler" ? 1e-11 / kStep : 1e-12;
  return kOfAStep * kSteps * growth(run, scene) + closing;
}

const Quat kTurn = rotation_by({0.7, -1.1, 0.4});

Scene ends_exchanged(Scene scene) {
  for (Joint& joint : scene.joints) {
    std::swap(joint.a, joint.b);
    if (auto* distance = std::get_if<DistanceJoint>(&joint.type)) std::swap(distance->point_a, distance->point_b);
    if (auto* universal = std::get_if<UniversalJoint>(&joint.type)) std::swap(universal->axis, universal->axis2);
  }
  return scene;
}

Scene joints_reversed(Scene scene) {
  std::reverse(scene.joints.begin(), scene.joints.end());
  return scene;
}

Scene anchors_along_their_axes(Scene scene) {
  for (Joint& joint : scene.joints) {
    if (auto* hinge = std::get_if<HingeJoint>(&joint.type)) hinge->anchor += 0.7 * hinge->axis;
  }
  return scene;
}

Scene first_joint_twice(Scene scene) {
  scene.joints.push_back(scene.joints.front());
  return scene;
}

Scene balls_for_hinges(Scene scene) {
  for (Joint& joint : scene.joints) joint.type = BallJoint{std::get<HingeJoint>(joint.type).anchor};
  return scene;
}

void check_law(const Scene& scene, Scene (*tell_otherwise)(Scene)) {
  const Scene other = tell_otherwise(scene);
  for_each_core_run(scene, [&](const Run& run) {
    const States here = end_of(run, scene), there = end_of(run, other);
    BOOST_TEST(difference(here, there) <= tolerance(run, scene));
    BOOST_TEST(difference(here, states_of(state_of(*run.load(scene)))) > 0.1);  // it has moved
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_turned_frame_is_the_same_frame) {
  for (const Scene& scene : {tree(), parallel_cranks()}) {
    for_each_core_run(scene, [&](const Run& run) {
      States there = end_of(run, turned(scene, kTurn));
      const Quat back = kTurn.conjugate();
      for (BodyState& s : there)
        s = {back * s.position, back * s.orientation, back * s.velocity, back * s.angular_velocity};
      BOOST_TEST(difference(end_of(run, scene), there) <= tolerance(run, scene));
    });
  }
}

BOOST_AUTO_TEST_CASE(the_ends_of_a_joint_may_be_exchanged) {
  // Some rows are fixed in a. Seen from the other end they express the same joint, but differ beside it, where the
  // stages of a Runge-Kutta method lie. The difference is a part of its own error.
  const Scene scene = tree(), other = ends_exchanged(scene);
  for_each_core_run(scene, [&](const Run& run) {
    const bool has_stages_beside = run.settings.method.starts_with("rk");
    const double apart = difference(end_of(run, scene), end_of(run, other));
    // Explicit Euler leaves its joints by the square of the step, and its way back differs by the square of that gap:
    // the third power of the step in all.
    if (run.settings.method == "explicit-euler") {
      const auto after_half_steps = [&](const Scene& told) {
        return states_of(state_after(*run.load(told), kStep / 2, 2 * kSteps));
      };
      BOOST_TEST(apart < 1e-7);
      BOOST_TEST(difference(after_half_steps(scene), after_half_steps(other)) < apart / 6);
      return;
    }
    BOOST_TEST(apart <= (has_stages_beside ? 1e-8 : tolerance(run, scene)));
    if (has_stages_beside) BOOST_TEST(apart > tolerance(run, scene), "it keeps the law: its exception is to go");
  });
  check_law(parallel_cranks(), ends_exchanged);
}

BOOST_AUTO_TEST_CASE(joints_may_stand_in_any_order) {
  check_law(tree(), joints_reversed);
  check_law(parallel_cranks(), joints_reversed);
}

BOOST_AUTO_TEST_CASE(a_hinge_is_the_same_wherever_its_anchor_is_on_its_axis) {
  check_law(tree(), anchors_along_their_axes);
  check_law(parallel_cranks(), anchors_along_their_axes);
}

BOOST_AUTO_TEST_CASE(a_joint_that_is_there_twice_holds_as_one) {
  check_law(tree(), first_joint_twice);
  check_law(parallel_cranks(), first_joint_twice);
}

BOOST_AUTO_TEST_CASE(in_a_plane_a_ball_holds_as_a_hinge_does) { check_law(plane_pendulum(), balls_for_hinges); }

// Bodies of hinges and balls go on from where they are, backwards.
BOOST_AUTO_TEST_CASE(a_symmetric_method_finds_its_way_back) {
  const Scene scene = plane_pendulum();
  int checked = 0;
  for_each_core_run(scene, [&](const Run& run) {
    if (!run.method().symmetric) return;
    const auto world = run.load(scene);
    const BodyTable there = state_after(*world, kStep, kSteps);
    Scene back = scene;
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
      auto& hinge = std::get<HingeJoint>(back.joints[k].type);
      hinge.anchor = end_motion(JointGeometry(scene, scene.joints[k]).b(), there.columns()).point();
    }
    for (std::size_t i = 0; i < back.bodies.size(); ++i) {
      const BodyState state = there.columns().body(i);
      Body& body = back.bodies[i];
      body.position = state.position, body.orientation = state.orientation;
      body.velocity = -state.velocity, body.angular_velocity = -state.angular_velocity;
    }
    const States home = end_of(run, back), start = states_of(state_of(*run.load(scene)));
    BOOST_TEST(difference(home, start) <= 2 * tolerance(run, scene));
    ++checked;
  });
  BOOST_TEST(checked >= 3, "of the methods that take joints only " << checked << " say that they are symmetric");
}

// Thrown and spinning, held together and to nothing else.
BOOST_AUTO_TEST_CASE(a_mechanism_that_floats_keeps_its_momenta) {
  Scene scene = tree();
  scene.gravity.setZero();
  scene.joints.erase(scene.joints.begin());
  const Vec3 w(1, -0.5, 2), v(0.3, 0.2, -0.1);
  for (Body& body : scene.bodies) body.angular_velocity = w, body.velocity = v + w.cross(body.position);
  for_each_core_run(scene, [&](const Run& run) {
    const BodyTable start = state_of(*run.load(scene)), end = state_after(*run.load(scene), kStep, kSteps);
    const Vec3 P = linear_momentum(scene, end.columns()) - linear_momentum(scene, start.columns());
    const double lost =
        (angular_momentum(scene, end.columns(), Vec3::Zero()) - angular_momentum(scene, start.columns(), Vec3::Zero()))
            .norm();
    BOOST_TEST(P.norm() < 1e-12);  // roundings of ten kg m/s in 120 steps
    // A method's own error of some 10 kg m²/s that turn by about 1 rad, in steps of 0.01 rad; and roundings.
    BOOST_TEST(lost < 10 * std::pow(0.01, run.method().order) + 1e-12);
  });
}

BOOST_AUTO_TEST_SUITE_END()
