#include "core/base/rotation_between.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_base_rotation_between)

// Rounding of a few operations.
constexpr double kRounding = 1e-14;

BOOST_AUTO_TEST_CASE(one_direction_is_taken_to_the_other_the_short_way) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const Vec3 from = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Vec3 to = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Quat turn = rotation_between(from, to);
    BOOST_TEST((turn * from - to).norm() < kRounding);
    BOOST_TEST(std::abs(2 * std::acos(std::min(1.0, turn.w())) - std::acos(from.dot(to))) < 1e-7);  // acos near 1
  }
}

BOOST_AUTO_TEST_CASE(opposite_and_nearly_opposite_directions_are_taken_to_each_other) {
  const Vec3 up = Vec3::UnitZ();
  for (const double tilt : {0.0, 1e-12, 1e-9, 1e-7, 1e-4}) {
    const Vec3 down(std::sin(tilt), 0, -std::cos(tilt));
    const Quat turn = rotation_between(up, down);
    BOOST_TEST(std::abs(turn.norm() - 1) < kRounding);
    // What is left is at most the tilt below which the axis is any.
    BOOST_TEST((turn * up - down).norm() < 1.1e-8);
  }
}

BOOST_AUTO_TEST_CASE(equal_directions_need_no_turn) {
  const Vec3 along = Vec3(1, 2, 3).normalized();
  BOOST_TEST((rotation_between(along, along).vec().norm() < kRounding));
}

BOOST_AUTO_TEST_SUITE_END()
