// Rotation vectors, and how their rates and angular velocities go together, from no turn at all to nearly a whole one.
#include "core/base/rotation_vector.h"

#include <boost/test/unit_test.hpp>
#include <random>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_base_rotation_vector)

namespace {

constexpr double kHalfTurn = 3.14159265358979323846;
constexpr double kTurns[] = {0, 1e-12, 1e-9, 1e-5, 9.9e-5, 1.01e-4, 9e-4, 1.1e-3, 9.9e-3, 1.01e-2, 0.1, 1, 2, 3, 3.14};

struct Directions {
  std::mt19937 random{11};
  std::normal_distribution<double> normal;
  Vec3 next() { return Vec3(normal(random), normal(random), normal(random)).normalized(); }
};

// J of phi by its own series, sum of [phi]^n / (n + 1)!.
Mat3 summed_jacobian(const Vec3& phi) {
  Mat3 sum = Mat3::Identity(), term = Mat3::Identity();
  for (int n = 1; n < 60; ++n) term = term * cross_matrix(phi) / (n + 1), sum += term;
  return sum;
}

}  // namespace

// Rounding of a few operations on numbers of up to 2 pi.
constexpr double kRounding = 1e-14;

BOOST_AUTO_TEST_CASE(a_rotation_of_a_vector_has_that_vector) {
  Directions directions;
  for (const double turn : kTurns) {
    const Vec3 phi = turn * directions.next();
    BOOST_TEST((rotation_vector_of(rotation_by(phi)) - phi).norm() < kRounding, turn);
    Quat other = rotation_by(phi);
    other.coeffs() *= -1;
    BOOST_TEST((rotation_vector_of(other) - phi).norm() < kRounding, turn);
  }
  // More than half a turn is less than half the other way.
  const Vec3 along = directions.next();
  BOOST_TEST((rotation_vector_of(rotation_by(4 * along)) + (2 * kHalfTurn - 4) * along).norm() < kRounding);
}

BOOST_AUTO_TEST_CASE(the_left_jacobian_is_its_series) {
  Directions directions;
  for (const double turn : kTurns) {
    const Vec3 phi = turn * directions.next();
    BOOST_TEST((left_jacobian(phi) - summed_jacobian(phi)).norm() < kRounding, turn);
  }
}

// A central difference over 1e-4: of its square, 1e-8, and of rounding, 1e-16 / 1e-4.
BOOST_AUTO_TEST_CASE(the_left_jacobian_makes_a_rate_an_angular_velocity) {
  Directions directions;
  constexpr double kStep = 1e-4;
  for (const double turn : {1e-5, 1e-3, 0.1, 1.0, 2.0, 3.0}) {
    const Vec3 phi = turn * directions.next(), rate = directions.next();
    const Quat before = rotation_by(phi - 0.5 * kStep * rate), after = rotation_by(phi + 0.5 * kStep * rate);
    const Vec3 w = rotation_vector_of((after * before.conjugate()).normalized()) / kStep;
    BOOST_TEST((left_jacobian(phi) * rate - w).norm() < 1e-8, turn);
  }
}

BOOST_AUTO_TEST_CASE(the_rate_of_an_angular_velocity_is_its_inverse) {
  Directions directions;
  for (const double turn : kTurns) {
    const Vec3 phi = turn * directions.next(), w = directions.next();
    // Beyond half a turn it is magnified by (theta/2) / sin(theta/2), pi/2 at half a turn.
    BOOST_TEST((left_jacobian(phi) * rate_of_rotation_vector(phi, w) - w).norm() < 2 * kRounding, turn);
  }
}

BOOST_AUTO_TEST_SUITE_END()
