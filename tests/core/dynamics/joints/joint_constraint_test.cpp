// The rows of each joint against differences of its gap: J V is the gap's rate, and bias what J' V is.
#include "core/dynamics/joints/joint_constraint.h"

#include <boost/test/unit_test.hpp>

#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_joints_joint_constraint)

namespace {

const std::vector<decltype(Joint::type)> kTypes = {
    BallJoint{{0.3, -0.2, 0.5}},
    CylindricalJoint{{0.3, -0.2, 0.5}, Vec3(1, 2, -2).normalized()},
    HingeJoint{{0.3, -0.2, 0.5}, Vec3(1, 2, -2).normalized()},
    PlanarJoint{{0.3, -0.2, 0.5}, Vec3(1, 2, -2).normalized()},
    SliderJoint{Vec3(2, -1, 2).normalized()},
    FixedJoint{},
    DistanceJoint{{0.1, 0.2, -0.3}, {0.4, 0, 0.1}},
    UniversalJoint{{0.3, -0.2, 0.5}, Vec3(1, 2, -2).normalized(), Vec3(2, 1, 2).normalized()}};

Scene two_bodies() {
  Scene scene;
  scene.bodies = {test::body("a", 1, {1, 1, 1}, {0.1, 0.2, 0.3}), test::body("b", 1, {1, 1, 1}, {0.7, -0.4, 0.6})};
  scene.bodies[0].orientation = Quat(0.8, 0.2, -0.4, 0.4).normalized();
  scene.bodies[1].orientation = Quat(-0.3, 0.5, 0.1, 0.7).normalized();
  return scene;
}

// Not where the joint holds: its rows must be right beside it, too. Velocities in W are constant.
EndMotion moving(const Body& body, const Vec3& moved, const Vec3& v, const Vec3& w, double t) {
  EndMotion end;
  end.position = body.position + moved + t * v;
  end.R = matrix_of(rotation_by(t * w) * rotation_by(0.3 * moved) * body.orientation);
  end.velocity = v, end.angular_velocity = w;
  return end;
}

struct Evaluated {
  Vec6 gap = Vec6::Zero(), rate = Vec6::Zero(), bias = Vec6::Zero();
};

Evaluated evaluate(const JointConstraint& joint, const Scene& scene, double t) {
  const EndMotion a = moving(scene.bodies[0], {0.05, -0.1, 0.08}, {0.4, -0.3, 0.2}, {0.7, 0.5, -0.6}, t);
  const EndMotion b = moving(scene.bodies[1], {-0.1, 0.06, 0.03}, {-0.2, 0.6, 0.1}, {-0.3, 0.8, 0.9}, t);
  ConstraintRow rows[kMostRows];
  joint.evaluate(a, b, rows);
  Evaluated out;
  for (int k = 0; k < joint.rows(); ++k) {
    Vec6 V_a, V_b;
    V_a << a.velocity, a.angular_velocity;
    V_b << b.velocity, b.angular_velocity;
    out.gap[k] = rows[k].gap, out.bias[k] = rows[k].bias;
    out.rate[k] = rows[k].on_a.dot(V_a) + rows[k].on_b.dot(V_b);
  }
  return out;
}

}  // namespace

// With constant V the gap's second derivative is the bias. Central differences over h = 1e-4 err by h² = 1e-8.
BOOST_AUTO_TEST_CASE(each_row_and_its_bias_are_derivatives_of_the_gap) {
  const Scene scene = two_bodies();
  for (const auto& type : kTypes) {
    const auto joint = make_constraint(scene, {0, 1, type});
    constexpr double h = 1e-4;
    const Evaluated before = evaluate(*joint, scene, -h), now = evaluate(*joint, scene, 0),
                    after = evaluate(*joint, scene, h);
    BOOST_TEST_CONTEXT(joint_type_name({0, 1, type})) {
      BOOST_TEST(((after.gap - before.gap) / (2 * h) - now.rate).norm() < 1e-7);
      BOOST_TEST(((after.rate - before.rate) / (2 * h) - now.bias).norm() < 1e-7);
      BOOST_TEST(now.gap.norm() > 1e-3);  // beside the joint
      BOOST_TEST(now.bias.norm() > 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(every_joint_holds_at_the_start_whatever_the_poses) {
  const Scene scene = two_bodies();
  for (const auto& type : kTypes) {
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(kWorld, 1), std::pair(0, kWorld)}) {
      const auto joint = make_constraint(scene, {a, b, type});
      const auto end = [&](int body) {
        EndMotion motion;
        motion.position = scene.pose(body).position, motion.R = matrix_of(scene.pose(body).orientation);
        return motion;
      };
      ConstraintRow rows[kMostRows];
      joint->evaluate(end(a), end(b), rows);
      for (int k = 0; k < joint->rows(); ++k) BOOST_TEST(std::abs(rows[k].gap) < 1e-15);
    }
  }
}

// Of a joint that a mask describes: a motion that the mask leaves free keeps every row at zero.
BOOST_AUTO_TEST_CASE(a_cylindrical_joint_lets_b_slide_along_its_axis_and_turn_about_it) {
  const Scene scene = two_bodies();
  const CylindricalJoint type{{0.3, -0.2, 0.5}, Vec3(1, 2, -2).normalized()};
  const auto joint = make_constraint(scene, {0, 1, type});
  BOOST_TEST(joint->rows() == 4);
  EndMotion a, b;
  a.position = scene.bodies[0].position, a.R = matrix_of(scene.bodies[0].orientation);
  const Quat turn = rotation_by(0.8 * type.axis);
  b.position = type.anchor + turn * (scene.bodies[1].position - type.anchor) + 0.6 * type.axis;
  b.R = matrix_of(turn * scene.bodies[1].orientation);
  double gaps[kMostRows];
  const auto largest = [&] {
    joint->find_gaps(a, b, gaps);
    return *std::max_element(gaps, gaps + 4, [](double x, double y) { return std::abs(x) < std::abs(y); });
  };
  BOOST_TEST(std::abs(largest()) < 1e-15);  // roundings of numbers below 1
  b.position += 0.1 * type.axis.unitOrthogonal();
  BOOST_TEST(std::abs(largest()) > 0.05);
}

BOOST_AUTO_TEST_SUITE_END()
