// The judge's measurement of joints: constructed distances, and rates compared with the change of distances.
#include "cases/metrics/measures/joints/joint_geometry.h"

#include <boost/test/unit_test.hpp>
#include <numbers>

#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_joints_joint_geometry)

namespace {

// Two bodies askew to each other, the second held to the first.
Scene pair_with(const decltype(Joint::type)& type) {
  Scene scene;
  scene.bodies = {test::body("a", 2, {0.1, 0.2, 0.25}, {0.3, -0.2, 1}), test::body("b", 1, {0.05, 0.06, 0.08})};
  scene.bodies[0].orientation = Quat(0.5, 0.5, -0.1, 0.7).normalized();
  scene.bodies[1].position = {0.9, 0.4, 0.2};
  scene.bodies[1].orientation = Quat(0.8, 0.2, -0.4, 0.4).normalized();
  scene.joints = {{.a = 0, .b = 1, .type = type}};
  return scene;
}

const Vec3 kAxis = Vec3(1, 2, 2) / 3, kAxis2 = Vec3(2, 1, -2) / 3;

struct Row {
  const char* name;
  decltype(Joint::type) type;
};
const Row kJoints[] = {{"ball", BallJoint{{0.5, 0.1, 0.4}}},
                       {"hinge", HingeJoint{{0.5, 0.1, 0.4}, kAxis}},
                       {"slider", SliderJoint{kAxis}},
                       {"fixed", FixedJoint{}},
                       {"distance", DistanceJoint{{0.1, 0.2, 0.3}, {-0.2, 0.1, 0.1}}},
                       {"universal", UniversalJoint{{0.5, 0.1, 0.4}, kAxis, kAxis2}},
                       {"cylindrical", CylindricalJoint{{0.5, 0.1, 0.4}, kAxis}},
                       {"planar", PlanarJoint{{0.5, 0.1, 0.4}, kAxis}},
                       {"screw", ScrewJoint{{0.5, 0.1, 0.4}, kAxis, 0.5}},
                       {"compound", CompoundJoint{{{true, {0.5, 0.1, 0.4}, kAxis}, {false, {}, kAxis2}}}}};

BodyTable at_start(const Scene& scene) {
  BodyTable bodies(scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    bodies.columns().set_body(i, {body.position, body.orientation, body.velocity, body.angular_velocity});
  }
  return bodies;
}

void give_velocities(const BodyTable& bodies, MutableBodyColumns out) {
  copy_columns(bodies.columns(), out);
  out.set_velocity(0, {0.3, -0.2, 0.5}), out.set_angular_velocity(0, {1.1, 0.7, -0.9});
  out.set_velocity(1, {-0.4, 0.6, 0.1}), out.set_angular_velocity(1, {-0.5, 1.3, 0.8});
}

// Each body gone on for `time` [s] with the velocities it has.
BodyTable gone_on(const BodyTable& from, double time) {
  BodyTable bodies(from.columns());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyState body = from.columns().body(i);
    bodies.columns().set_position(i, body.position + time * body.velocity);
    bodies.columns().set_orientation(i, rotation_by(time * body.angular_velocity) * body.orientation);
  }
  return bodies;
}

}  // namespace

// Any violating velocity opens a gap at its rate, also from no gap at all.
BOOST_AUTO_TEST_CASE(a_rate_is_that_at_which_the_gap_opens) {
  for (const Row& row : kJoints) {
    BOOST_TEST_CONTEXT(row.name) {
      const Scene scene = pair_with(row.type);
      const JointGeometry joint(scene, scene.joints[0]);
      BodyTable moving(2);
      give_velocities(at_start(scene), moving.columns());
      BOOST_TEST(joint.gap(moving.columns()) < 1e-15);
      BOOST_TEST(joint.twist(moving.columns()) < 1e-15);
      constexpr double kTime =
          1e-6;  // s: second derivatives add a millionth; a gap of 1e-6 m is rounded by 1e-10 of it
      const BodyTable later = gone_on(moving, kTime);
      const auto like = boost::test_tools::tolerance(1e-5);
      BOOST_TEST(joint.gap(later.columns()) / kTime == joint.gap_rate(moving.columns()), like);
      BOOST_TEST(joint.gap_rate(moving.columns()) > 0.01);
      if (!joint.holds_angle()) {
        BOOST_TEST(joint.twist_rate(moving.columns()) == 0);
        continue;
      }
      BOOST_TEST(joint.twist(later.columns()) / kTime == joint.twist_rate(moving.columns()), like);
      BOOST_TEST(joint.twist_rate(moving.columns()) > 0.01);
    }
  }
}

// Moved as one rigid body the pair keeps every joint; the whole of it may lie and turn anywhere.
BOOST_AUTO_TEST_CASE(a_pair_that_moves_as_one_keeps_its_joint) {
  const Quat turn = Quat(0.3, -0.7, 0.2, 0.6).normalized();
  const Vec3 shift(3, -5, 2), w(2, -1, 3), v(1, 2, 3);
  for (const Row& row : kJoints) {
    const Scene scene = pair_with(row.type);
    const JointGeometry joint(scene, scene.joints[0]);
    BodyTable moved = at_start(scene);
    for (std::size_t i = 0; i < 2; ++i) {
      const Body& body = scene.bodies[i];
      const Vec3 place = turn * body.position;
      moved.columns().set_body(i, {place + shift, turn * body.orientation, v + w.cross(place), w});
    }
    BOOST_TEST_CONTEXT(row.name) {  // roundings of some metres, and of their speeds
      BOOST_TEST(joint.gap(moved.columns()) < 1e-14);
      BOOST_TEST(joint.twist(moved.columns()) < 1e-14);
      BOOST_TEST(joint.gap_rate(moved.columns()) < 1e-13);
      BOOST_TEST(joint.twist_rate(moved.columns()) < 1e-14);
    }
  }
}

BOOST_AUTO_TEST_CASE(each_joint_lets_free_what_it_lets_free_and_holds_the_rest) {
  struct Move {
    int joint;  // in kJoints
    Vec3 shift, turn;
    double gap, twist;
  };
  const Vec3 anchor(0.5, 0.1, 0.4), at_b = Vec3(0.9, 0.4, 0.2) - anchor;
  const auto about = [&](const Vec3& turn) { return Vec3(rotation_by(turn) * at_b - at_b); };  // about the anchor
  const Vec3 askew(0.2, -0.1, 0.3), across = kAxis.unitOrthogonal();
  const double kLead = 0.5 / (2 * std::numbers::pi);  // m/rad
  const Move moves[] = {{0, about(askew), askew, 0, 0},
                        {0, about(askew) + 0.003 * kAxis, askew, 0.003, 0},
                        {1, about(0.7 * kAxis), 0.7 * kAxis, 0, 0},
                        {1, about(0.01 * across), 0.01 * across, 0, 0.01},
                        {2, 0.4 * kAxis, Vec3::Zero(), 0, 0},
                        {2, 0.4 * kAxis + 0.002 * across, 0.01 * kAxis, 0.002, 0.01},
                        {3, 0.004 * askew.normalized(), 0.02 * askew.normalized(), 0.004, 0.02},
                        {5, about(0.6 * kAxis2), 0.6 * kAxis2, 0, 0},
                        {5, about(0.6 * kAxis), 0.6 * kAxis, 0, 0},
                        {5, about(0.01 * kAxis.cross(kAxis2)), 0.01 * kAxis.cross(kAxis2), 0, 0.01},
                        {6, about(0.7 * kAxis) + 0.4 * kAxis, 0.7 * kAxis, 0, 0},
                        {6, 0.4 * kAxis + 0.003 * across, Vec3::Zero(), 0.003, 0},
                        {6, about(0.01 * across), 0.01 * across, 0, 0.01},
                        {7, about(0.7 * kAxis) + 0.4 * across, 0.7 * kAxis, 0, 0},
                        {7, 0.4 * across + 0.003 * kAxis, Vec3::Zero(), 0.003, 0},
                        {7, about(0.01 * across), 0.01 * across, 0, 0.01},
                        {8, about(0.7 * kAxis) + 0.7 * kLead * kAxis, 0.7 * kAxis, 0, 0},
                        {8, about(0.7 * kAxis), 0.7 * kAxis, 0.7 * kLead, 0},
                        {8, about(-0.7 * kAxis) + 0.7 * kLead * kAxis, -0.7 * kAxis, 1.4 * kLead, 0},
                        {8, 0.5 * kAxis, Vec3::Zero(), 0, 0},  // a whole turn
                        {8, 0.003 * across, Vec3::Zero(), 0.003, 0},
                        {8, about(0.01 * across), 0.01 * across, 0, 0.01},
                        {9, about(0.7 * kAxis) + rotation_by(0.7 * kAxis) * (0.3 * kAxis2), 0.7 * kAxis, 0, 0},
                        {9, 0.3 * kAxis2 + 0.003 * kAxis, Vec3::Zero(), 0.003, 0},
                        {9, 0.3 * kAxis2 + 0.003 * kAxis.cross(kAxis2), Vec3::Zero(), 0.003, 0}};
  for (const Move& move : moves) {
    const Scene scene = pair_with(kJoints[move.joint].type);
    const JointGeometry joint(scene, scene.joints[0]);
    BodyTable bodies = at_start(scene);
    bodies.columns().set_position(1, scene.bodies[1].position + move.shift);
    bodies.columns().set_orientation(1, rotation_by(move.turn) * scene.bodies[1].orientation);
    BOOST_TEST_CONTEXT(kJoints[move.joint].name << " " << move.gap << " " << move.twist) {
      BOOST_TEST(std::abs(joint.gap(bodies.columns()) - move.gap) < 1e-14);
      BOOST_TEST(std::abs(joint.twist(bodies.columns()) - move.twist) < 1e-14);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_distance_is_missed_both_ways) {
  Scene scene;
  scene.bodies = {test::body("bob", 1, {1, 1, 1}, {0, -2, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = DistanceJoint{Vec3::Zero(), Vec3::Zero()}}};
  const JointGeometry joint(scene, scene.joints[0]);
  for (const double length : {1.9, 2.1}) {
    BodyTable bodies = at_start(scene);
    bodies.columns().set_body(0, {{0.6 * length, 0, -0.8 * length}, Quat::Identity(), {3, 0, 0}, {9, 9, 9}});
    BOOST_TEST(joint.gap(bodies.columns()) == 0.1, boost::test_tools::tolerance(1e-13));
    BOOST_TEST(joint.gap_rate(bodies.columns()) == 0.6 * 3, boost::test_tools::tolerance(1e-14));
  }
}

BOOST_AUTO_TEST_SUITE_END()
