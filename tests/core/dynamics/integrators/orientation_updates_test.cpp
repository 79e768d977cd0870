#include "core/dynamics/integrators/orientation_updates.h"

#include <boost/test/unit_test.hpp>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_integrators_orientation_updates)

namespace {

BodyTable turned(const OrientationUpdate& update, const Vec3& w, double dt, int steps) {
  BodyTable table(1, update.keeps_matrix);
  table.columns().set_body(0, BodyState{});
  if (update.keeps_matrix) table.columns().set_rotation(0, Mat3::Identity());
  for (int n = 0; n < steps; ++n) update.advance(table.columns(), 0, w, dt);
  return table;
}

double orthonormality_loss(const BodyTable& table) {
  const Mat3 R = table.columns().rotation(0);
  return (R.transpose() * R - Mat3::Identity()).norm();
}

}  // namespace

// About a fixed axis each update has an angle and a stretch that can be written down.
BOOST_AUTO_TEST_CASE(each_turns_by_its_known_angle) {
  const double dt = 1.0 / 30, theta = 10 * dt;
  const int steps = 30;
  const std::pair<const char*, double> angles[] = {{"matrix-additive", std::atan(theta)},
                                                   {"matrix-rodrigues", theta},
                                                   {"quaternion-additive", 2 * std::atan(theta / 2)},
                                                   {"quaternion-exponential", theta}};
  BOOST_TEST(std::size(angles) == orientation_updates().size());
  for (const auto& [name, angle] : angles) {
    const BodyTable table = turned(orientation_update(name), {0, 10, 0}, dt, steps);
    const double error = angle_between(table.columns().orientation(0), rotation_by({0, steps * angle, 0}));
    BOOST_TEST(error < 1e-13, name << " is off by " << error);  // 30 roundings
  }
}

BOOST_AUTO_TEST_CASE(only_the_additive_matrix_leaves_the_rotations) {
  const double theta = 1.0 / 3;
  for (const OrientationUpdate& update : orientation_updates()) {
    const BodyTable table = turned(update, {0, 10, 0}, theta / 10, 30);
    const double loss = orthonormality_loss(table);
    if (update.name == "matrix-additive") {
      // The plane across the axis is stretched by sqrt(1 + theta²) each step; two equal entries of RᵀR - I.
      const double expected = std::sqrt(2.0) * (std::pow(1 + theta * theta, 30) - 1);
      BOOST_TEST(std::abs(loss / expected - 1) < 1e-12);
    } else {
      BOOST_TEST(loss < 1e-13, update.name << " loses " << loss);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_matrix_that_is_not_finite_gives_a_quaternion_that_is_not) {
  BodyTable table(1, true);
  table.columns().set_rotation(0, Mat3::Constant(1e308));
  orientation_update("matrix-additive").advance(table.columns(), 0, {1e10, 0, 0}, 1);
  BOOST_TEST(!table.columns().orientation(0).coeffs().allFinite());
}

BOOST_AUTO_TEST_SUITE_END()
