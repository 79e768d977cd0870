// Impacts of several bodies at once, against what the law says of them in closed form.
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_impacts)

// A ball strikes the first of two that touch and do not separate. It rebounds from both together. Rebounding from the
// first alone, it would come to rest, and leave them at half its speed. With v the impact speed and e its restitution,
//   m v = m v' + 2 m u,   u - v' = e v.
BOOST_AUTO_TEST_CASE(what_touches_without_rebound_is_struck_as_one) {
  const double v = 2;
  for (const double e : {0.0, 0.5, 1.0}) {
    Scene scene;
    for (int i = 0; i < 3; ++i)
      scene.bodies.push_back(solid("ball " + std::to_string(i), Sphere{0.1}, {0.2 * i, 0, 0}));
    scene.bodies[0].position.x() = -0.3;
    scene.bodies[0].velocity = {v, 0, 0};
    scene.contact_default = {0, 0};
    scene.contact_pairs = {{0, 1, {e, 0}}};
    ContactRun run(scene, "event");
    run.run(1.0 / 30, 10);
    const double u = v * (1 + e) / 3;
    BOOST_TEST(std::abs(run.state().velocity(0).x() - (u - e * v)) < 1e-12, e);
    for (const int struck : {1, 2}) BOOST_TEST((run.state().velocity(struck) - Vec3(u, 0, 0)).norm() < 1e-12, e);
    BOOST_TEST(run.solver_warning() == "");
  }
}

BOOST_AUTO_TEST_SUITE_END()
