#include "cases/truth/solved/pose_interpolation.h"

#include <boost/test/unit_test.hpp>

#include "core/base/rotation_vector.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_pose_interpolation)

namespace {

// A motion whose position and rotation vector, both from the start, are cubics of the share s of kTime.
constexpr double kTime = 0.25;  // s
struct CubicMotion {
  Vec3 path[4], turn[4];

  static Vec3 value(const Vec3 (&p)[4], double s) { return p[0] + s * (p[1] + s * (p[2] + s * p[3])); }
  static Vec3 rate(const Vec3 (&p)[4], double s) { return (p[1] + s * (2 * p[2] + 3 * s * p[3])) / kTime; }

  BodyState at(double s) const {
    const Quat start = Quat(0.5, -0.1, 0.7, 0.3).normalized();
    const Vec3 phi = value(turn, s);
    return {value(path, s), rotation_by(phi) * start, rate(path, s), left_jacobian(phi) * rate(turn, s)};
  }
};

}  // namespace

// Rounding of rates of up to 20 a second.
constexpr double kRounding = 1e-13;

BOOST_AUTO_TEST_CASE(cubics_of_position_and_of_rotation_vector_are_met_exactly) {
  // By a little, and by two radians about an axis that itself turns.
  for (const double much : {1e-7, 0.01, 1.0}) {
    const CubicMotion motion{{{1, 2, 3}, {0.3, -0.2, 0.5}, {-0.7, 0.1, 0.4}, {0.2, 0.6, -0.9}},
                             {Vec3::Zero(), much * Vec3(2, -1, 0.5), much * Vec3(-3, 2, 1), much * Vec3(1, 1, -1)}};
    for (const double s : {0.0, 0.1, 0.5, 0.8, 1.0}) {
      const BodyState due = motion.at(s), found = between(motion.at(0), motion.at(1), kTime, s);
      BOOST_TEST((found.position - due.position).norm() < kRounding);
      BOOST_TEST(angle_between(found.orientation, due.orientation) < kRounding);
      BOOST_TEST((found.velocity - due.velocity).norm() < kRounding);
      BOOST_TEST((found.angular_velocity - due.angular_velocity).norm() < kRounding);
    }
  }
}

// A quaternion and its negative are one orientation.
BOOST_AUTO_TEST_CASE(the_sign_of_a_quaternion_does_not_matter) {
  const BodyState from{.angular_velocity = {0, 0, 1}};
  BodyState to{.position = {1, 0, 0}, .orientation = rotation_by(Vec3(0, 0, 0.5)), .angular_velocity = {0, 0, 1}};
  to.orientation.coeffs() *= -1;
  BOOST_TEST(angle_between(between(from, to, 0.5, 0.5).orientation, rotation_by(Vec3(0, 0, 0.25))) < kRounding);
}

BOOST_AUTO_TEST_SUITE_END()
