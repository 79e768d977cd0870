#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "core/dynamics/model/energy.h"
#include "tests/cases/judged.h"

using namespace rigor;
using test::truth_at;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_smooth_steady_precession)

namespace {

const Vec3 kPivot(0.3, -0.2, 1);
constexpr double kLength = 0.4, kTilt = 0.7, kAxial = 0.02, kAcross = 0.05, kMass = 1.5, kGravity = 9.81;

// A top that leans by kTilt and goes round at `precession` [rad/s]; its spin follows from
// precession (axial w_axis - across precession cos tilt) = m g l, with the moments about the joint.
Scene precessing_top(double precession) {
  const double across = kAcross + kMass * kLength * kLength;
  const double about_axis = (kMass * kGravity * kLength / precession + across * precession * std::cos(kTilt)) / kAxial;
  Scene scene;
  scene.gravity = {0, 0, -kGravity};
  Body top = test::body("top", kMass, {kAcross, kAcross, kAxial});
  top.orientation = rotation_by({kTilt, 0, 0}) * rotation_by({0, 0, 0.3});
  const Vec3 e = top.orientation * Vec3::UnitZ(), up = Vec3::UnitZ();
  top.position = kPivot + kLength * e;
  top.angular_velocity = precession * up + (about_axis - precession * std::cos(kTilt)) * e;
  top.velocity = top.angular_velocity.cross(top.position - kPivot);
  scene.bodies = {top};
  scene.joints.push_back({kWorld, 0, BallJoint{kPivot}});
  return scene;
}

Scene sleeping_top() {
  Scene scene = precessing_top(2);
  Body& top = scene.bodies[0];
  top.orientation = Quat::Identity(), top.position = kPivot + kLength * Vec3::UnitZ();
  top.angular_velocity = {0, 0, 30}, top.velocity.setZero();
  return scene;
}

// The derivative of f at t by central differences of order 8. For a turn at `rate` [rad/s] steps of a fiftieth of a
// radian leave an error of 1e-16 of the derivative, and a rounding of 1e-14. They are powers of two, so that the times
// are exact.
template <typename F>
Vec3 derivative(const F& f, double t, double rate) {
  const double h = std::exp2(std::floor(std::log2(0.02 / rate))),
               weights[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  Vec3 sum = Vec3::Zero();
  for (int k = 1; k <= 4; ++k) sum += weights[k - 1] / h * (f(t + k * h) - f(t - k * h));
  return sum;
}

}  // namespace

// No engine and no reference runs a joint yet: the equations of motion about the joint themselves are the check.
BOOST_AUTO_TEST_CASE(it_satisfies_the_equations_of_motion_about_the_joint) {
  for (const Scene& scene : {precessing_top(2), precessing_top(9), precessing_top(-3), sleeping_top()}) {
    const auto truth = make_truth("steady-precession", scene, 10);
    const auto at = [&](double t) { return truth_at(*truth, t, 1).columns().body(0); };
    const auto L = [&](double t) {
      const BodyTable now = truth_at(*truth, t, 1);
      return angular_momentum(scene, now.columns(), kPivot);
    };
    for (const double t : {0.5, 3.0, 9.5}) {
      const BodyState now = at(t);
      const Vec3 arm = now.position - kPivot, w = now.angular_velocity, torque = arm.cross(kMass * scene.gravity);
      const double rate = w.norm();
      // The body turns as w says, about the joint, and L changes as the torque says.
      BOOST_TEST((derivative(L, t, rate) - torque).norm() < 1e-12 * rate * L(t).norm());
      BOOST_TEST((derivative([&](double s) { return at(s).position; }, t, rate) - now.velocity).norm() < 1e-12 * rate);
      for (int axis = 0; axis < 3; ++axis) {
        const auto arrow = [&](double s) { return Vec3(matrix_of(at(s).orientation).col(axis)); };
        BOOST_TEST((derivative(arrow, t, rate) - w.cross(arrow(t))).norm() < 1e-12 * rate);
      }
      BOOST_TEST((arm - now.orientation * Vec3(0, 0, kLength)).norm() < 1e-15);
      BOOST_TEST((now.velocity - w.cross(arm)).norm() < 1e-14);
      BOOST_TEST(truth->error(t) < 1e-9);  // the scene's rounding, over two thousand radians
    }
  }
}

BOOST_AUTO_TEST_CASE(energy_and_the_momenta_about_the_vertical_and_the_axis_stay) {
  const Scene scene = precessing_top(2);
  const auto truth = make_truth("steady-precession", scene, 10);
  const auto kept = [&](double t) {
    const BodyTable now = truth_at(*truth, t, 1);
    const Vec3 L = angular_momentum(scene, now.columns(), kPivot);
    return Vec3(energy(scene, now.columns()), L.z(), L.dot(now.columns().orientation(0) * Vec3::UnitZ()));
  };
  for (const double t : {1.0, 5.5, 10.0}) BOOST_TEST((kept(t) - kept(0)).norm() < 1e-12 * kept(0).norm());
}

BOOST_AUTO_TEST_CASE(a_scene_it_does_not_hold_for_is_refused_with_the_reason) {
  struct Row {
    void (*spoil)(Scene&);
    const char* says;
  };
  const Row rows[] = {
      {[](Scene& s) { s.joints.clear(); }, "there are 0 joints"},
      {[](Scene& s) { s.joints[0].type = BallJoint{s.bodies[0].position}; }, "at the centre of mass"},
      {[](Scene& s) { s.joints[0].type = FixedJoint{}; }, "joint:fixed"},
      {[](Scene& s) { s.bodies.push_back(s.bodies[0]); }, "2 bodies move"},
      {[](Scene& s) { s.bodies[0].velocity.setZero(); }, "the velocity of body 'top'"},
      {[](Scene& s) { s.bodies[0].inertia(0, 0) = 0.051; }, "not symmetric"},
      {[](Scene& s) { s.gravity *= 1.001; }, "rad/s, at which the torque it takes is off by"},
      {[](Scene& s) {
         s.bodies[0].angular_velocity += Vec3(0.1, 0, 0);
         s.bodies[0].velocity = s.bodies[0].angular_velocity.cross(s.bodies[0].position - kPivot);
       },
       "its axis nods"},
  };
  for (const Row& row : rows) {
    Scene scene = precessing_top(2);
    row.spoil(scene);
    BOOST_CHECK_EXCEPTION(make_truth("steady-precession", scene, 1), InputError, test::says(row.says));
  }
}

BOOST_AUTO_TEST_SUITE_END()
