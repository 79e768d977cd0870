#include "core/dynamics/model/system.h"

#include <boost/test/unit_test.hpp>

#include "core/dynamics/model/block_system.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_model_system)

BOOST_AUTO_TEST_CASE(principal_axes_give_the_inertia_back) {
  Mat3 full;
  full << 2, 0.3, -0.1, 0.3, 3, 0.2, -0.1, 0.2, 4;
  for (const Mat3& inertia : {full, Mat3(Vec3(3, 1, 2).asDiagonal()), Mat3(Vec3(2, 2, 2).asDiagonal())}) {
    const PrincipalInertia p = principal_inertia(inertia);
    const Mat3 R = matrix_of(p.q_BP);
    BOOST_TEST((R * p.moments.asDiagonal() * R.transpose() - inertia).norm() < 1e-14);
    BOOST_TEST(std::abs(R.determinant() - 1) < 1e-14);
    BOOST_TEST((p.moments.x() <= p.moments.y() && p.moments.y() <= p.moments.z()));
  }
}

BOOST_AUTO_TEST_CASE(the_angular_acceleration_keeps_momentum_and_energy_of_a_free_body) {
  const Scene scene = test::tumbling_body();
  const System system(scene);
  const Body& body = scene.bodies[0];
  const Mat3 R = matrix_of(body.orientation), I = R * body.inertia * R.transpose();
  const Vec3 w = body.angular_velocity, w_rate = angular_acceleration(system.bodies[0], R, w, Vec3::Zero());
  BOOST_TEST((I * w_rate + w.cross(I * w)).norm() < 1e-14);  // L' = 0
  BOOST_TEST(std::abs(w.dot(I * w_rate)) < 1e-14);           // E' = 0
  const Vec3 L = angular_momentum_of(system.bodies[0], R, w);
  BOOST_TEST((angular_velocity_of(system.bodies[0], R, L) - w).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(small_and_large_block_systems_are_solved_alike) {
  for (const std::size_t bodies : {2, 10, 11, 40}) {
    BlockSystem system(bodies);
    Eigen::VectorXd wanted = Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(6 * bodies), -1, 2),
                    right = 0 * wanted;
    Mat6 coupling = Mat6::Constant(0.1), diagonal = 3 * Mat6::Identity() + Mat6::Constant(0.2);
    coupling(0, 5) = -0.4;
    system.clear();
    for (std::size_t i = 0; i < bodies; ++i) {
      system.add(i, i, diagonal);
      right.segment<6>(6 * i) += diagonal * wanted.segment<6>(6 * i);
      if (i == 0) continue;
      system.add(i, i - 1, coupling);
      right.segment<6>(6 * i) += coupling * wanted.segment<6>(6 * (i - 1));
    }
    Eigen::VectorXd found;
    BOOST_TEST(system.solve(right, found));
    BOOST_TEST((found - wanted).norm() < 1e-12, bodies << " bodies");
  }
}

BOOST_AUTO_TEST_SUITE_END()
