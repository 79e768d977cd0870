// Numbers that others have printed, from the truths of their scenes, to every digit they give.
#include <boost/test/unit_test.hpp>

#include "core/dynamics/model/energy.h"
#include "tests/cases/truth/closed_form/smooth/smooth_scenes.h"

using namespace rigor;
using test::truth_at;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_smooth_published)

namespace {

constexpr double kDegree = 0.017453292519943295;  // rad

Vec3 spin_in_body(BodyColumns bodies) { return bodies.orientation(0).conjugate() * bodies.angular_velocity(0); }

// The instants at which w_B about an axis changes its sign, bisected to rounding.
std::vector<double> sign_changes(const Truth& truth, int axis, double until) {
  const auto w = [&](double t) { return spin_in_body(truth_at(truth, t, 1).columns())[axis]; };
  std::vector<double> found;
  constexpr double kStep = 0.01;  // s, far less than from one change to the next
  for (double t = 0; t + kStep <= until; t += kStep) {
    double a = t, b = t + kStep;
    if ((w(a) > 0) == (w(b) > 0)) continue;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (a + b);
      ((w(middle) > 0) == (w(a) > 0) ? a : b) = middle;
    }
    found.push_back(a);
  }
  return found;
}

// The closed form and the reference of a scene.
std::vector<std::unique_ptr<Truth>> both_truths(const std::string& closed, const Scene& scene, double duration) {
  std::vector<std::unique_ptr<Truth>> truths;
  truths.push_back(make_truth(closed, scene, duration));
  truths.push_back(make_truth("reference", scene, duration));
  return truths;
}

}  // namespace

BOOST_AUTO_TEST_CASE(free_fall_for_ten_seconds) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {test::body("stone", 1, {1, 1, 1})};
  for (const auto& truth : both_truths("projectile", scene, 10)) {
    // -490.5 m, to its rounding.
    BOOST_TEST(truth_at(*truth, 10, 1).columns().position(0).z() == -490.5, boost::test_tools::tolerance(1e-15));
  }
}

// Peters and Hsu (2014) print the energies 5.001041625 and 368.5464125 J. Their boxes have 5.00104166.. and
// 368.54641666.. J. Their moments, .808333.., .683333.. and .141666.. kg m², were rounded to six decimals: with the
// rounded moments all of their printed digits and both times are reproduced.
BOOST_AUTO_TEST_CASE(the_energies_of_the_boxes) {
  Scene stable = test::free_body(test::box_moments(), {0.5, 0, 0});
  stable.bodies[0].mass = 10, stable.bodies[0].velocity = {-0.9, 0.4, 0.1};
  struct Row {
    Scene scene;
    double exact, printed;  // J
  };
  for (const Row& row :
       {Row{stable, 5.0010416667, 5.001041625}, Row{test::dzhanibekov_box(), 368.5464166667, 368.5464125}}) {
    const BodyTable start = truth_at(*make_truth("reference", row.scene, 1), 0, 1);
    BOOST_TEST(std::abs(energy(row.scene, start.columns()) - row.exact) < 0.5e-10);  // half of its last digit
    Scene rounded = row.scene;
    rounded.bodies[0].inertia = Vec3(0.808333, 0.683333, 0.141667).asDiagonal();
    BOOST_TEST(energy(rounded, start.columns()) == row.printed, boost::test_tools::tolerance(1e-15));
  }
  const auto truth = make_truth("projectile", stable, 10);
  BOOST_TEST(angle_between(truth_at(*truth, 10, 1).columns().orientation(0), rotation_by({5, 0, 0})) < 1e-15);
}

BOOST_AUTO_TEST_CASE(the_dzhanibekov_box_after_ten_seconds) {
  const Scene scene = test::dzhanibekov_box();
  for (const auto& truth : both_truths("asymmetric-top", scene, 10)) {
    const BodyTable now = truth_at(*truth, 10, 1);
    const Quat q = now.columns().orientation(0), printed(0.2251646, -0.6199276, -0.2770292, 0.6987457);
    const double sign = q.dot(printed) > 0 ? 1 : -1;
    // Half of the last digit.
    BOOST_TEST((spin_in_body(now.columns()) - Vec3(2.7558404, -3.7359635, -3.1618090)).cwiseAbs().maxCoeff() < 0.5e-7);
    BOOST_TEST((sign * q.coeffs() - printed.coeffs()).cwiseAbs().maxCoeff() < 0.5e-7);
    const Vec3 L = angular_momentum(scene, now.columns(), now.columns().position(0));
    BOOST_TEST(std::abs(L.norm() - 3.41765209) < 0.5e-8);
  }
}

// NASA's check-case 2: I = (.001894220, .006211019, .007194665) slug ft², w_B = (10, 20, 30) deg/s. The unit does not
// matter to a free body.
BOOST_AUTO_TEST_CASE(the_tumbling_brick_after_thirty_seconds) {
  const Scene scene = test::free_body(Vec3(0.001894220, 0.006211019, 0.007194665), kDegree * Vec3(10, 20, 30));
  for (const auto& truth : both_truths("asymmetric-top", scene, 30)) {
    const Vec3 w = spin_in_body(truth_at(*truth, 30, 1).columns()) / kDegree;
    BOOST_TEST((w - Vec3(12.618391, -17.397475, 31.119589)).cwiseAbs().maxCoeff() < 0.5e-6);
  }
}

BOOST_AUTO_TEST_CASE(the_flips_of_the_free_asymmetric_top) {
  const Scene scene = test::free_body(Vec3(1, 2, 3), 5 * Vec3(1e-3, 1, 1e-3));
  for (const auto& truth : both_truths("asymmetric-top", scene, 60)) {
    const std::vector<double> flips = sign_changes(*truth, 1, 60);
    BOOST_TEST_REQUIRE(flips.size() == 11);
    BOOST_TEST(std::abs(flips[0] - 2.981) < 0.5e-3);
    for (std::size_t i = 1; i < flips.size(); ++i) BOOST_TEST(std::abs(flips[i] - flips[i - 1] - 5.506) < 0.5e-3);
  }
}

// Kane (1983): across .04, along the axis .02, w_B = (2, 4, 6).
BOOST_AUTO_TEST_CASE(the_axisymmetric_body) {
  const Scene scene = test::free_body(Vec3(0.04, 0.04, 0.02), {2, 4, 6});
  for (const auto& truth : both_truths("axisymmetric-top", scene, 20)) {
    for (const double t : {0.0, 0.7, 7.3, 20.0}) {
      const BodyTable now = truth_at(*truth, t, 1);
      const Vec3 expected(2 * std::cos(3 * t) + 4 * std::sin(3 * t), 4 * std::cos(3 * t) - 2 * std::sin(3 * t), 6);
      BOOST_TEST((spin_in_body(now.columns()) - expected).norm() < 1e-14);  // some roundings of 7.5 rad/s
      // The axis goes round L at sqrt(29) rad/s.
      const Vec3 L(0.08, 0.16, 0.12);
      const Vec3 axis = rotation_by(std::sqrt(29.0) * t * L.normalized()) * Vec3::UnitZ();
      BOOST_TEST((now.columns().orientation(0) * Vec3::UnitZ() - axis).norm() < 1e-13);  // a phase of 108 rad, rounded
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
