#include <boost/test/unit_test.hpp>

#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/system.h"
#include "core/scene/turned.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_turned)

// Forces and torques of every kind of load turn with the world; a point or vector left behind would change them.
BOOST_AUTO_TEST_CASE(the_loads_of_a_turned_scene_are_the_turned_loads) {
  const Quat turn = Quat(0.2, -0.5, 0.7, 0.4).normalized();
  const Scene scene = test::coupled_bodies(3), other = turned(scene, turn);
  Wrenches loads[2];
  double energies[2];
  for (int k = 0; k < 2; ++k) {
    const Scene& one = k == 0 ? scene : other;
    BodyTable state(one.bodies.size());
    set_initial_state(one, state.columns());
    System(one).wrenches(state.columns(), 0, 0, loads[k]);
    energies[k] = energy(one, state.columns());
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    // Some ten roundings of numbers below 100.
    BOOST_TEST((turn * loads[0][i].force - loads[1][i].force).norm() < 1e-12);
    BOOST_TEST((turn * loads[0][i].torque - loads[1][i].torque).norm() < 1e-12);
  }
  BOOST_TEST(std::abs(energies[0] - energies[1]) < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_plane_turns_by_its_normal) {
  const Quat turn = rotation_by({0, 0, 1.5707963267948966});
  const Scene scene = turned(test::dropped_sphere(0), turn);
  BOOST_TEST((std::get<Plane>(*scene.bodies[1].shape).normal - Vec3(-1, 0, 0)).norm() < 1e-15);
}

BOOST_AUTO_TEST_SUITE_END()
