// Contact by impulses of bodies that joints hold together, with limits and motors.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/dynamics/joints/joints.h"
#include "core/dynamics/model/energy.h"
#include "core/dynamics/model/joint_coordinate.h"
#include "core/engine/engine_failure.h"
#include "tests/core/dynamics/contact/contact_runs.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_impulse_jointed)

namespace {

Body ground() {
  Body plane;
  plane.name = "ground";
  plane.shape = Plane{Vec3::UnitY(), 0};
  plane.fixed = plane.collides = true;
  return plane;
}

// A bob of radius 0.05 m on a hinge 1 m above it, let go at 60° from a wall at its lowest point.
Scene pendulum_at_wall(double restitution) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  const double angle = std::numbers::pi / 3;
  Body bob = test::solid("bob", Sphere{0.05}, {std::sin(angle), -std::cos(angle), 0});
  Body wall = ground();
  wall.shape = Plane{Vec3::UnitX(), -0.05};
  scene.bodies = {bob, wall};
  scene.joints = {{kWorld, 0, HingeJoint{{0, 0, 0}, Vec3::UnitZ()}}};
  scene.contact_default = {restitution, 0};
  return scene;
}

// Links of 0.2 m along x on ball joints, y above the ground.
Scene chain(int links, double y) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  for (int i = 0; i < links; ++i) {
    Body link = test::solid("link", Capsule{0.02, 0.12}, {0.2 * i, y, 0}, 0.1);
    link.name += std::to_string(i);
    link.orientation = Quat(std::sqrt(0.5), 0, std::sqrt(0.5), 0);  // its z along x
    scene.bodies.push_back(link);
    if (i > 0) scene.joints.push_back({i - 1, i, BallJoint{{0.2 * i - 0.1, y, 0}}});
  }
  scene.bodies.push_back(ground());
  scene.contact_default = {0, 0.5};
  return scene;
}

struct Watched {
  std::unique_ptr<World> world;
  System system;
  Joints joints;
  const Scene& scene;
  Snapshot now;

  Watched(const Scene& s, const std::string& method)
      : world(CoreEngine().load(s, {.method = method, .options = {{"contact", "impulse"}}})),
        system(s),
        joints(s, system),
        scene(s) {}
  void step(double dt) {
    world->step(dt);
    world->read(now);
  }
  double gap() { return joints.gap(now.bodies()); }
  double energy() { return rigor::energy(scene, now.bodies()); }
};

double energy_at_start(const Scene& scene) {
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  return energy(scene, start.columns());
}

const char* const kMethods[] = {"semi-implicit-euler", "velocity-verlet", "rk4"};

}  // namespace

// sin(theta_n/2) = e^n sin(theta_0/2) for each swing's top, up to the effect of an impact inside a sub-step of 1/480 s.
// The bob's speed there is 3.1 m/s, 6 mm per sub-step. A wall that is met too early or late changes the energy by that,
// 2e-5 m of height, and first-order methods have the same error.
BOOST_AUTO_TEST_CASE(a_pendulum_leaves_a_wall_with_its_share_of_the_speed) {
  for (const char* method : kMethods) {
    const Scene scene = pendulum_at_wall(0.5);
    Watched run(scene, method);
    double highest[4] = {};
    int swing = 0;
    double last = 1;
    for (int n = 0; n < 960; ++n) {
      run.step(1.0 / 240);
      const double rate = run.now.bodies().velocity(0).x();
      if (last < -1e-3 && rate > 1e-3 && swing < 3) ++swing;
      if (std::abs(rate) > 1e-3) last = rate;
      const Vec3 p = run.now.bodies().position(0);
      highest[swing] = std::max(highest[swing], std::atan2(p.x(), -p.y()));
      BOOST_TEST(run.gap() < 1e-12);
    }
    BOOST_TEST_CONTEXT(method) {
      BOOST_TEST(swing == 3);
      for (int n = 1; n < 4; ++n) {
        const double exact = 2 * std::asin(std::pow(0.5, n) * 0.5);
        BOOST_TEST(std::abs(highest[n] - exact) < 0.02 * exact);
      }
    }
  }
}

// An impact at one end sets the whole chain moving, and its joints stay; it comes to rest on the ground.
BOOST_AUTO_TEST_CASE(a_chain_falls_on_the_ground_and_comes_to_rest) {
  for (const char* method : kMethods) {
    Scene scene = chain(10, 0.5);
    for (std::size_t i = 0; i < 10; ++i) {
      // Turned about its first end, so that it comes down one end first.
      const double angle = 0.3;
      Body& link = scene.bodies[i];
      link.position = {link.position.x() * std::cos(angle), 0.5 + link.position.x() * std::sin(angle), 0};
      link.orientation = Quat(std::cos(angle / 2), 0, 0, std::sin(angle / 2)) * link.orientation;
      if (i > 0) {
        const double x = 0.2 * static_cast<double>(i) - 0.1;
        std::get<BallJoint>(scene.joints[i - 1].type).anchor = {x * std::cos(angle), 0.5 + x * std::sin(angle), 0};
      }
    }
    Watched run(scene, method);
    const double at_start = energy_at_start(scene);
    double lowest = 1, largest_gain = 0, widest = 0;
    for (int n = 0; n < 720; ++n) {
      run.step(1.0 / 240);
      for (std::size_t i = 0; i < 10; ++i) lowest = std::min(lowest, run.now.bodies().position(i).y() - 0.02);
      largest_gain = std::max(largest_gain, run.energy() - at_start);
      widest = std::max(widest, run.gap());
    }
    BOOST_TEST_CONTEXT(method) {
      BOOST_TEST(widest < 1e-12);
      // Semi-implicit velocities are half a step behind: m g v h / 2 of ten links at 5 m/s.
      BOOST_TEST(largest_gain < (method == std::string("semi-implicit-euler") ? 0.11 : 1e-3));
      BOOST_TEST(lowest > -0.002);  // of a radius of 20 mm
      BOOST_TEST(kinetic_energy(scene, run.now.bodies()) < 1e-4);
    }
  }
}

// A resting body stays in place: five seconds, to a tenth of a millimetre.
BOOST_AUTO_TEST_CASE(a_chain_that_lies_on_the_ground_stays_there) {
  const Scene scene = chain(20, 0.02);
  for (const char* method : kMethods) {
    Watched run(scene, method);
    for (int n = 0; n < 300; ++n) run.step(1.0 / 60);
    for (std::size_t i = 0; i < 20; ++i)
      BOOST_TEST((run.now.bodies().position(i) - scene.bodies[i].position).norm() < 1e-4);
  }
}

// With the ground far below, limits and motors are rows of impulses. A block falls along its rail onto its stop, from 1
// m, bounces, and rests on it. A wheel reaches its speed without load.
BOOST_AUTO_TEST_CASE(limits_and_motors_hold_beside_contacts) {
  for (const char* method : kMethods) {
    Scene scene;
    scene.gravity = {0, -9.81, 0};
    scene.bodies = {test::solid("block", Sphere{0.1}, {0, 3, 0}), test::body("wheel", 2, {0.5, 0.5, 0.5}), ground()};
    scene.joints = {{kWorld, 0, SliderJoint{Vec3::UnitY()}}, {kWorld, 1, HingeJoint{{0, 0, 0}, Vec3::UnitX()}}};
    scene.joints[0].lower = -1, scene.joints[0].restitution = 0.5;
    scene.joints[1].upper = 10;
    Motor motor{};
    motor.joint = 1;
    motor.speed = 3, motor.most = 2;
    scene.motors = {motor};
    Watched run(scene, method);
    double top = 0, lowest = 3;
    for (int n = 0; n < 720; ++n) {
      run.step(1.0 / 240);
      const double y = run.now.bodies().position(0).y();
      if (n > 130 && n < 200) top = std::max(top, y);
      lowest = std::min(lowest, y);
      if (n == 479) BOOST_TEST(std::abs(run.now.bodies().angular_velocity(1).x() - 3) < 1e-9);
    }
    BOOST_TEST_CONTEXT(method) {
      BOOST_TEST(std::abs(top - 2.25) < 0.01);  // e² of a metre; first-order methods err by h v
      BOOST_TEST(lowest > 2 - 1e-3);
      BOOST_TEST(std::abs(run.now.bodies().position(0).y() - 2) < 1e-3);
      BOOST_TEST(run.now.bodies().velocity(0).norm() < 1e-3);
    }
  }
}

// Two jaws on rails press a box with 10 N each; friction could bear twice its weight. It gives way by the softness of
// the contacts in the first steps, some µm, and by nothing after that. At 1/240 s the faces tilt by 1e-5 rad in the
// fourth step. A crossing of edges must not replace their corners then, or the box slips by 7 mm.
BOOST_AUTO_TEST_CASE(a_grip_holds_at_any_step) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const double beside = 0.0499999999999;  // m: touching
  scene.bodies = {test::solid("left", Box{{0.02, 0.04, 0.06}}, {-beside, 0, 0}),
                  test::solid("right", Box{{0.02, 0.04, 0.06}}, {beside, 0, 0}),
                  test::solid("box", Box{{0.08, 0.06, 0.05}}, {0, 0, 0})};
  for (Body& body : scene.bodies) {
    const double mass = body.name == "box" ? 0.5 : 0.3;
    body.inertia *= mass / body.mass, body.mass = mass;
  }
  scene.contact_default = {0, 0.5};
  scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}},
                  {.a = kWorld, .b = 1, .type = SliderJoint{-Vec3::UnitX()}}};
  for (const int joint : {0, 1}) {
    Motor press{.joint = joint, .speed = {}};
    press.effort = 10;
    scene.motors.push_back(press);
  }
  for (const double dt : {1.0 / 30, 1.0 / 100, 1.0 / 240, 1.0 / 300, 1.0 / 700}) {
    const auto world = CoreEngine().load(scene, {.method = "velocity-verlet", .options = {{"contact", "impulse"}}});
    const auto height_after = [&](double duration) {
      for (int n = 0; n < std::lround(duration / dt); ++n) world->step(dt);
      Snapshot now;
      world->read(now);
      return now.bodies().position(2).z();
    };
    const double early = height_after(0.5), late = height_after(2);
    BOOST_TEST_CONTEXT(dt << " s: " << early << " m, " << late << " m") {
      BOOST_TEST(std::abs(early) < 1e-5);
      BOOST_TEST(std::abs(late - early) < 1e-9);
    }
  }
}

// The bound on an impact's energy counts the bodies alone, and a rotor has energy too.
BOOST_AUTO_TEST_CASE(restitution_beside_armatures_is_refused) {
  Scene scene = pendulum_at_wall(0.5);
  scene.joints[0].armature = 0.1;
  BOOST_CHECK_THROW(test::ContactRun(scene, "impulse"), EngineFailure);
  scene.contact_default.restitution = 0;
  BOOST_CHECK_NO_THROW(test::ContactRun(scene, "impulse"));
}

BOOST_AUTO_TEST_SUITE_END()
