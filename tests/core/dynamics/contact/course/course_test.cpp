#include <utility>

#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/contact_runs.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_course_course)

namespace {

// One resolution of the contacts, between no kick and no drift: explicit Euler with no time to pass.
struct Loaded {
  explicit Loaded(const Scene& scene) : run(scene, "course", "explicit-euler") {}
  void resolve() { run.step(0); }
  test::ContactRun run;
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_lowest_point_leaves_straight_up_with_the_restitution) {
  Scene scene = test::dropped_sphere(0.5);
  scene.bodies[0].position.y() = 0.09;
  scene.bodies[0].velocity = {2, -3, 1};
  scene.bodies[0].angular_velocity = {5, 7, -4};
  Loaded loaded(scene);
  loaded.resolve();
  const Vec3 v = loaded.run.state().velocity(0), w = loaded.run.state().angular_velocity(0);
  const Vec3 arm(0, -0.1, 0);
  BOOST_TEST((v + w.cross(arm) - Vec3(0, 1.5, 0)).norm() < 1e-13);
  // An impulse at the lowest point keeps the angular momentum about it.
  const auto about_point = [&](const Vec3& v_W, const Vec3& w_W) { return Vec3(0.4 * w_W + 100 * (-arm).cross(v_W)); };
  BOOST_TEST((about_point(v, w) - about_point(scene.bodies[0].velocity, scene.bodies[0].angular_velocity)).norm() <
             1e-12);
}

BOOST_AUTO_TEST_CASE(a_sphere_that_leaves_or_does_not_touch_is_left_alone) {
  for (const auto& [height, speed] : {std::pair(0.09, 1.0), std::pair(0.11, -1.0)}) {
    Scene scene = test::dropped_sphere(1);
    scene.bodies[0].position.y() = height;
    scene.bodies[0].velocity = {0, speed, 0};
    Loaded loaded(scene);
    loaded.resolve();
    BOOST_TEST(loaded.run.state().velocity(0).y() == speed);
  }
}

// The rule uses the positions before the step, so the sphere meets the ground too fast. At dt = 1/30 s the apexes of an
// elastic ball grow to these shares of the first height.
BOOST_AUTO_TEST_CASE(an_elastic_ball_gains_height_at_coarse_steps) {
  const Scene scene = test::dropped_sphere(1);
  test::ContactRun run(scene, "course", "semi-implicit-euler");
  std::vector<double> apexes;
  double speed = 0, height = 1.37;
  for (int n = 0; n < 400 && apexes.size() < 5; ++n) {
    run.step(1 / 30.0);
    const double new_speed = run.state().velocity(0).y();
    if (speed > 0 && new_speed <= 0) apexes.push_back(height / 1.37);
    speed = new_speed, height = run.state().position(0).y() - 0.1;
  }
  BOOST_REQUIRE(apexes.size() == 5);
  const double expected[] = {1.135, 1.278, 1.429, 1.588, 1.755};  // from a recursion of two numbers, by hand
  for (int k = 0; k < 5; ++k)
    BOOST_TEST(std::abs(apexes[k] - expected[k]) < 6e-4, "bounce " << k + 1 << ": " << apexes[k]);
}

BOOST_AUTO_TEST_CASE(two_spheres_keep_their_momentum_and_part_with_the_restitution) {
  Scene scene = test::dropped_sphere(0.25);
  scene.bodies[1] = test::body("other", 50, {0.2, 0.2, 0.2}, {0.19, 1.47, 0});
  scene.bodies[1].shape = Sphere{0.1};
  scene.bodies[1].collides = true;
  scene.bodies[0].velocity = {1, 0.5, 0};
  scene.bodies[1].angular_velocity = {3, 0, 8};
  Loaded loaded(scene);
  const Vec3 momentum = linear_momentum(scene, loaded.run.state());
  const Vec3 spin = angular_momentum(scene, loaded.run.state(), Vec3::Zero());
  loaded.resolve();
  const BodyColumns after = std::as_const(loaded.run).state();
  BOOST_TEST((linear_momentum(scene, after) - momentum).norm() < 1e-12);
  BOOST_TEST((angular_momentum(scene, after, Vec3::Zero()) - spin).norm() < 1e-12);
  // They overlap by 1 cm; the point lies in the middle of that.
  const Vec3 u = after.velocity(0) + after.angular_velocity(0).cross(Vec3(0.095, 0, 0)) - after.velocity(1) -
                 after.angular_velocity(1).cross(Vec3(-0.095, 0, 0));
  BOOST_TEST((u - Vec3(-0.25, 0, 0)).norm() < 1e-13);
}

// Newton's law for each ball and step: what is reported is all that acts beside gravity.
BOOST_AUTO_TEST_CASE(reported_forces_explain_the_motion) {
  Scene scene =
      test::on_floor({test::solid("low", Sphere{0.2}, {0, 0, 0.3}), test::solid("high", Sphere{0.2}, {0.1, 0, 0.9})},
                     {0.5, kInfiniteFriction});
  scene.bodies[1].angular_velocity = {1, 2, 3};
  for (const char* integrator : {"semi-implicit-euler", "velocity-verlet", "rk4"}) {
    test::ContactRun run(scene, "course", integrator);
    run.contact_reports().ask_for_contacts();
    constexpr double kDt = 1.0 / 240;
    int contacts = 0;
    std::vector<Vec3> before;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) before.push_back(scene.bodies[i].velocity);
    for (int step = 0; step < 240; ++step) {
      run.run(kDt, 1);
      std::vector<Vec3> force(scene.bodies.size(), Vec3::Zero());
      for (const ReportedContact& contact : run.contact_reports().contacts()) {
        force[static_cast<std::size_t>(contact.a)] -= contact.force,
            force[static_cast<std::size_t>(contact.b)] += contact.force;
        BOOST_TEST(contact.gap <= 0);
        ++contacts;
      }
      for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        if (body.fixed) continue;
        const Vec3 v = run.state().velocity(static_cast<int>(i));
        // Roundings of impacts of some m/s, over a step.
        BOOST_TEST((body.mass * ((v - before[i]) / kDt - scene.gravity) - force[i]).norm() < 1e-9);
        before[i] = v;
      }
    }
    BOOST_TEST(contacts > 3, integrator);
  }
}

BOOST_AUTO_TEST_SUITE_END()
