#include "core/dynamics/model/energy.h"

#include <boost/test/unit_test.hpp>

#include "core/dynamics/model/system.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_model_energy)

namespace {

// The box of Peters and Hsu's comparison (2014): 10 kg, 0.1 x 0.4 x 0.9 m.
Scene spinning_box(const Vec3& v, const Vec3& w, const Vec3& gravity) {
  Scene scene;
  scene.gravity = gravity;
  Body box = test::body("box", 10, {1, 1, 1});
  box.inertia = inertia_of(Box{{0.1, 0.4, 0.9}}, 10);
  box.velocity = v, box.angular_velocity = w;
  scene.bodies = {box};
  return scene;
}

BodyTable initial(const Scene& scene) {
  BodyTable table(scene.bodies.size());
  set_initial_state(scene, table.columns());
  return table;
}

}  // namespace

// They print 5.001041625 and 368.5464125 J from an inertia rounded to four digits; these are the exact ones.
BOOST_AUTO_TEST_CASE(the_published_boxes_have_their_energy_and_momentum) {
  const Scene stable = spinning_box({-0.9, 0.4, 0.1}, {0.5, 0, 0}, Vec3::Zero());
  BOOST_TEST(std::abs(energy(stable, initial(stable).columns()) - 5.0010416666666667) < 1e-14);
  BOOST_TEST(std::abs(energy(stable, initial(stable).columns()) - 5.001041625) < 1e-6);
  const Scene flipping = spinning_box({-2, 2, 8}, {0.1, 5, 0.1}, {0, 0, -9.8});
  const BodyTable start = initial(flipping);
  BOOST_TEST(std::abs(energy(flipping, start.columns()) - 368.5464166666667) < 1e-12);
  BOOST_TEST(std::abs(angular_momentum(flipping, start.columns(), Vec3::Zero()).norm() - 3.41765209) < 5e-9);
}

BOOST_AUTO_TEST_CASE(the_energy_does_not_depend_on_the_frame_the_inertia_is_given_in) {
  const Scene scene = test::tumbling_body();
  Scene turned = scene;
  const Mat3 R_BC = matrix_of(rotation_by({0.3, -1, 0.7}));  // a body frame C turned against B
  turned.bodies[0].inertia = R_BC.transpose() * scene.bodies[0].inertia * R_BC;
  turned.bodies[0].orientation = scene.bodies[0].orientation * Quat(R_BC);
  const BodyTable a = initial(scene), b = initial(turned);
  BOOST_TEST(std::abs(energy(scene, a.columns()) - energy(turned, b.columns())) < 1e-14);
  BOOST_TEST((angular_momentum(scene, a.columns(), Vec3::Zero()) - angular_momentum(turned, b.columns(), Vec3::Zero()))
                 .norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(the_orbital_part_of_the_angular_momentum_is_counted) {
  Scene scene;
  scene.bodies = {test::body("mass", 2, {1, 1, 1}, {3, 0, 0})};
  scene.bodies[0].velocity = {0, 5, 0};
  const BodyTable start = initial(scene);
  BOOST_TEST((angular_momentum(scene, start.columns(), Vec3::Zero()) - Vec3(0, 0, 30)).norm() < 1e-14);
  BOOST_TEST((angular_momentum(scene, start.columns(), {3, 0, 0})).norm() < 1e-14);
  BOOST_TEST((linear_momentum(scene, start.columns()) - Vec3(0, 10, 0)).norm() < 1e-14);
}

BOOST_AUTO_TEST_SUITE_END()
