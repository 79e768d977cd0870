// The reference of compound joints: axes in series that make up another joint move as that one, and the core, which
// shares no code with the reference, agrees on generated trees of them.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/truth/truth.h"
#include "tests/cases/judged.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/relations/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_compound_reference)

namespace {

const Vec3 kAnchor(0.2, 0.1, 0.3), kAxis = Vec3(1, 2, -1).normalized(), kAcross = Vec3(1, 0, 1).normalized(),
                                   kThird = kAxis.cross(kAcross);

// Two tumbling bodies. Joints come between them.
Scene two_bodies() {
  Scene scene;
  scene.gravity = {0, 1, -9};
  Body base = test::body("base", 2, {0.05, 0.09, 0.07}, {0, 0, 0}),
       link = test::body("link", 0.7, {0.01, 0.02, 0.018}, {0.5, 0.2, 0.4});
  base.orientation = rotation_by(Vec3(0.4, -0.3, 0.9)), base.angular_velocity = {0.6, -1, 0.4},
  base.velocity = {1, 0, 2};
  link.orientation = rotation_by(Vec3(-1, 0.2, 0.5));
  scene.bodies = {base, link};
  return scene;
}

// The link follows the base as if welded, and moves on along the joint as the caller says.
void set_rates(Scene& scene, const Vec3& w, const Vec3& v, const Vec3& anchor) {
  const Body& base = scene.bodies[0];
  Body& link = scene.bodies[1];
  link.angular_velocity = base.angular_velocity + w;
  link.velocity =
      base.velocity + base.angular_velocity.cross(link.position - base.position) + v + w.cross(link.position - anchor);
}

Scene with_joint(Scene scene, const Joint& joint) {
  scene.joints.push_back(joint);
  return scene;
}

SeriesAxis hinge(const Vec3& axis, const Vec3& anchor = kAnchor) { return {true, anchor, axis}; }
SeriesAxis slider(const Vec3& axis) { return {false, Vec3::Zero(), axis}; }

// `like`: what each axis has beside its type.
Scene with_series(Scene scene, const std::vector<SeriesAxis>& axes, const Joint& like = {}) {
  scene.joints.push_back({0, 1, CompoundJoint{axes}});
  for (std::size_t k = 0; k < axes.size(); ++k) {
    Joint axis = like;
    axis.a = 0, axis.b = 1, axis.type = CompoundAxis{axes, k};
    scene.joints.push_back(axis);
  }
  return scene;
}

Vec3 link_in_base(const BodyTable& bodies) {
  const BodyColumns at = bodies.columns();
  return matrix_of(at.orientation(0)).transpose() * (at.position(1) - at.position(0));
}

void check_alike(const Scene& one, const Scene& other) {
  constexpr double kEnd = 1, kKnown = 1e-10;
  const auto a = make_truth("reference", one, kEnd), b = make_truth("reference", other, kEnd);
  const Vec3 start = link_in_base(test::truth_at(*a, 0, 2));
  double moved = 0;
  for (const double t : {0.3, kEnd}) {
    const BodyTable here = test::truth_at(*a, t, 2), there = test::truth_at(*b, t, 2);
    BOOST_TEST(a->error(t) < kKnown);
    BOOST_TEST(b->error(t) < kKnown);
    for (const std::size_t i : {0u, 1u}) {
      const auto apart = test::difference(here.columns().body(i), there.columns().body(i));
      BOOST_TEST(apart.pose <= a->error(t) + b->error(t), "body " << i << " at " << t << " s: " << apart.pose);
    }
    moved = std::max(moved, (link_in_base(here) - start).norm());
  }
  BOOST_TEST(moved > 0.05);
}

}  // namespace

BOOST_AUTO_TEST_CASE(three_hinges_at_one_point_are_a_ball) {
  Scene scene = two_bodies();
  set_rates(scene, {2, 1, -3}, Vec3::Zero(), kAnchor);
  check_alike(with_joint(scene, {0, 1, BallJoint{kAnchor}}),
              with_series(scene, {hinge(kAxis), hinge(kAcross), hinge(kThird)}));
}

BOOST_AUTO_TEST_CASE(two_hinges_at_one_point_are_a_universal_joint) {
  Scene scene = two_bodies();
  set_rates(scene, 2 * kAxis - 3 * kAcross, Vec3::Zero(), kAnchor);
  check_alike(with_joint(scene, {0, 1, UniversalJoint{kAnchor, kAxis, kAcross}}),
              with_series(scene, {hinge(kAxis), hinge(kAcross)}));
}

BOOST_AUTO_TEST_CASE(a_slider_and_a_hinge_on_one_axis_are_a_cylindrical_joint) {
  Scene scene = two_bodies();
  set_rates(scene, 4 * kAxis, 0.5 * kAxis, kAnchor);
  const Scene whole = with_joint(scene, {0, 1, CylindricalJoint{kAnchor, kAxis}});
  check_alike(whole, with_series(scene, {slider(kAxis), hinge(kAxis)}));
  check_alike(whole, with_series(scene, {hinge(kAxis), slider(kAxis)}));
}

BOOST_AUTO_TEST_CASE(two_sliders_and_a_hinge_across_them_are_a_planar_joint) {
  Scene scene = two_bodies();
  set_rates(scene, kThird, 0.5 * kAxis - 0.3 * kAcross, kAnchor);
  const Scene whole = with_joint(scene, {0, 1, PlanarJoint{kAnchor, kThird}});
  check_alike(whole, with_series(scene, {slider(kAxis), slider(kAcross), hinge(kThird)}));
  check_alike(whole, with_series(scene, {slider(kAxis), hinge(kThird, Vec3(-1, 0.4, 0)),
                                         slider((kAxis + kAcross).normalized())}));
}

// More than a turn, with all that a single axis may have.
BOOST_AUTO_TEST_CASE(one_axis_is_a_hinge_or_a_slider) {
  Scene scene = two_bodies();
  Joint like;
  like.stiffness = 0.3, like.rest = 0.2, like.damping = 0.004, like.armature = 0.02;
  Motor motor;
  motor.from = 0.2, motor.effort = 0.3;
  const auto driven = [&](Scene made, int joint) {
    made.motors.push_back(motor), made.motors.back().joint = joint;
    return made;
  };
  set_rates(scene, 9 * kAxis, Vec3::Zero(), kAnchor);
  Joint whole = like;
  whole.a = 0, whole.b = 1, whole.type = HingeJoint{kAnchor, kAxis};
  check_alike(driven(with_joint(scene, whole), 0), driven(with_series(scene, {hinge(kAxis)}, like), 1));
  set_rates(scene, Vec3::Zero(), -0.6 * kAxis, kAnchor);
  whole.type = SliderJoint{kAxis};
  check_alike(driven(with_joint(scene, whole), 0), driven(with_series(scene, {slider(kAxis)}, like), 1));
}

BOOST_AUTO_TEST_CASE(one_axis_meets_its_limits_as_a_hinge_or_a_slider_does) {
  Scene scene = two_bodies();
  Joint like;
  like.lower = -0.3, like.upper = 0.4, like.restitution = 0.5;
  set_rates(scene, 6 * kAxis, Vec3::Zero(), kAnchor);
  Joint whole = like;
  whole.a = 0, whole.b = 1, whole.type = HingeJoint{kAnchor, kAxis};
  check_alike(with_joint(scene, whole), with_series(scene, {hinge(kAxis)}, like));
  set_rates(scene, Vec3::Zero(), 0.8 * kAxis, kAnchor);
  whole.type = SliderJoint{kAxis};
  check_alike(with_joint(scene, whole), with_series(scene, {slider(kAxis)}, like));
}

// dormand-prince keeps some 1e-12 in each step; at limits it suppresses flights (random_mechanisms_test.cpp). It stops
// where two hinges have become parallel.
BOOST_AUTO_TEST_CASE(the_core_and_the_reference_tell_of_the_same_motion) {
  constexpr double kStep = 1.0 / 240, kEnd = 0.3, kNoFlight = 2e-6, kSmooth = 1e-10;  // s, m
  int known = 0, with_limits = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Scene scene = test::compound_mechanism(seed);
    const auto truth = make_truth("reference", scene, kEnd);
    const auto world = CoreEngine().load(scene, {.method = "dormand-prince", .options = {}});
    const double until = horizon(*truth, kSmooth, kEnd);
    double time = 0;
    Snapshot core;
    world->read(core);
    while (time + kStep < until) {
      world->step(kStep);
      if (!world->solver_warning().empty()) break;
      time += kStep;
      world->read(core);
    }
    if (time < 0.1) continue;  // the truth says itself that it does not know
    const bool has_limits =
        std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) { return joint.has_limits(); });
    ++known, with_limits += has_limits;
    const BodyTable expected = test::truth_at(*truth, time, scene.bodies.size());
    double apart = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      apart = std::max(apart, test::difference(core.bodies().body(i), expected.columns().body(i)).pose);
    BOOST_TEST(apart < (has_limits ? kNoFlight : kSmooth) + 10 * truth->error(time), "seed " << seed << ": " << apart);
  }
  BOOST_TEST(known >= 18);
  BOOST_TEST(with_limits >= 5);
}

BOOST_AUTO_TEST_SUITE_END()
