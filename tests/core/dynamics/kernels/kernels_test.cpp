// Every method that uses kernels gives the trajectories of the plain formulas, and the same bits on every instruction
// set and for any number of bodies.
#include "core/dynamics/kernels/kernels.h"

#include <boost/test/unit_test.hpp>
#include <cstring>
#include <numbers>

#include "core/dynamics/integrators/integrator.h"
#include "tests/core/dynamics/plain_steps.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_kernels_kernels)

namespace {

std::vector<const Kernels*> every_table() {
  const Kernels* all[kMostKernelTables];
  const std::size_t count = available_kernels(all);
  return {all, all + count};
}

BodyTable initial(const Scene& scene) {
  BodyTable table(scene.bodies.size());
  set_initial_state(scene, table.columns());
  return table;
}

// Bodies of different masses and moments under gravity and a steady force on one of them.
Scene crowd(int count, bool full_inertia, bool with_fixed) {
  Scene scene;
  scene.gravity = {0.5, -1, -9.81};
  for (int i = 0; i < count; ++i) {
    Body b = test::body("body " + std::to_string(i), 1 + 0.3 * i, {0.1 + 0.02 * i, 0.25, 0.3}, {1.1 * i, 0.2 * i, 0});
    if (full_inertia) b.inertia(0, 2) = b.inertia(2, 0) = 0.03, b.inertia(0, 1) = b.inertia(1, 0) = -0.02;
    b.orientation = Quat(1, 0.1 * i, -0.3, 0.2).normalized();
    b.velocity = {0.1 * (i % 9), -0.2, 0.3};
    b.angular_velocity = {1.5 - 0.1 * (i % 11), 0.7, -0.4 * (i % 7)};
    b.fixed = with_fixed && i % 5 == 3;
    scene.bodies.push_back(b);
  }
  return scene;
}

// The crowd in a row, each held to the next and every third to the world.
Scene tied_crowd(int count, bool full_inertia, double damping) {
  Scene scene = crowd(count, full_inertia, true);
  for (int i = 0; i < count; ++i) {
    if (i + 1 < count) scene.springs.push_back(test::spring(i, {0.3, 0, 0.1}, i + 1, {-0.3, 0.1, 0}, 40, 0.5, damping));
    if (i % 3 == 0) scene.springs.push_back(test::spring(kWorld, {1.1 * i, 0, 3}, i, {0, 0.1, 0.2}, 60, 2.5, damping));
  }
  TimedForce push;
  push.body = 0, push.force = {1, 2, 0}, push.torque = {0, 0.05, 0.02}, push.point = {0, 0.1, 0};
  scene.forces = {push};
  return scene;
}

Scene on_quadratic_springs(Scene scene) {
  for (Spring& spring : scene.springs) spring.quadratic_stiffness = 0.8 * spring.stiffness;
  return scene;
}

std::vector<std::pair<std::string, Scene>> scenes(bool with_dampers) {
  std::vector<std::pair<std::string, Scene>> all = {
      {"one body", test::tumbling_body()},
      {"one body on a spring", test::fixed_spring()},
      {"two coupled bodies", test::coupled_bodies(0)},
      {"21 free bodies", crowd(21, false, false)},
      {"21 free bodies of full inertia, some fixed", crowd(21, true, true)},
      {"21 tied bodies", tied_crowd(21, false, 0)},
      {"70 tied bodies of full inertia", tied_crowd(70, true, 0)},
      {"21 bodies on quadratic springs", on_quadratic_springs(tied_crowd(21, true, 0))},
  };
  if (with_dampers) all.emplace_back("70 tied bodies with dampers", tied_crowd(70, true, 0.5));
  return all;
}

BodyTable stepped(const Scene& scene, const std::string& method, const std::string& orientation, int steps) {
  const System system(scene);
  BodyTable state = initial(scene);
  const OrientationUpdate* update = orientation.empty() ? nullptr : &orientation_update(orientation);
  const auto stepper = integrator(method).make({system, nullptr, update});
  for (int n = 0; n < steps; ++n) stepper->step(state.columns(), n / 240.0, 1 / 240.0);
  return state;
}

bool same_bits(BodyColumns a, BodyColumns b, std::size_t rows) {
  for (int c = 0; c < kRotation; ++c) {
    if (std::memcmp(a.column(c), b.column(c), rows * sizeof(double)) != 0) return false;
  }
  return true;
}

// Relative to one plus the value.
double largest_difference(BodyColumns a, BodyColumns b) {
  double largest = 0;
  for (int c = 0; c < kRotation; ++c) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double x = a.column(c)[i], y = b.column(c)[i];
      largest = std::max(largest, std::abs(x - y) / (1 + std::abs(y)));
      if (!std::isfinite(x)) return INFINITY;
    }
  }
  return largest;
}

}  // namespace

// 60 steps, each with some tens of roundings of 1e-16 in values of order one, which these motions magnify little.
BOOST_AUTO_TEST_CASE(steps_are_those_of_the_plain_formulas) {
  for (const test::PlainMethod& method : test::plain_methods()) {
    for (const auto& [what, scene] : scenes(method.takes_dampers)) {
      const System system(scene);
      BodyTable plain = initial(scene);
      for (int n = 0; n < 60; ++n) method.step(system, plain, n / 240.0, 1 / 240.0);
      const BodyTable fast = stepped(scene, method.name, method.orientation, 60);
      const double difference = largest_difference(fast.columns(), plain.columns());
      BOOST_TEST(difference < 1e-12, method.name << " " << method.orientation << ", " << what << ": " << difference);
    }
  }
}

BOOST_AUTO_TEST_CASE(every_instruction_set_gives_the_same_bits) {
  const auto tables = every_table();
  BOOST_TEST_MESSAGE("instruction sets here: " << tables.size());
  for (const Integrator& method : integrators()) {
    for (const auto& [what, scene] : scenes(true)) {
      if (scene.bodies.size() > 30 && method.name.starts_with("implicit")) continue;  // slow, and no other code
      const auto run = [&](const Kernels& table) {
        const KernelsInPlace in_use(table);
        return stepped(scene, method.name, method.default_orientation, 20);
      };
      const BodyTable plain = run(*tables.front());
      for (const Kernels* table : tables) {
        BOOST_TEST(same_bits(run(*table).columns(), plain.columns(), plain.size()),
                   method.name << ", " << what << ": " << table->name);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_body_moves_the_same_whatever_the_number_of_others) {
  const Scene all = crowd(70, true, true);
  for (const test::PlainMethod& method : test::plain_methods()) {
    const BodyTable together = stepped(all, method.name, method.orientation, 20);
    for (const std::size_t count : {1, 2, 3, 7, 8, 9, 64, 65}) {
      Scene some = all;
      some.bodies.resize(count);
      BOOST_TEST(same_bits(stepped(some, method.name, method.orientation, 20).columns(), together.columns(), count),
                 method.name << ", " << count << " bodies");
    }
  }
}

BOOST_AUTO_TEST_CASE(threads_change_no_bit) {
  const int count = 9000;  // enough that threads are used
  for (const Scene& scene : {crowd(count, false, true), tied_crowd(count, false, 0)}) {
    for (const char* name : {"dormand-prince", "rk4", "semi-implicit-euler", "symplectic4", "velocity-verlet"}) {
      const Integrator& method = integrator(name);
      const auto run = [&](int threads) {
        System system(scene);
        system.constants.use_threads(threads);
        BodyTable state = initial(scene);
        const OrientationUpdate* update =
            method.default_orientation.empty() ? nullptr : &orientation_update(method.default_orientation);
        const auto stepper = method.make({system, nullptr, update});
        for (int n = 0; n < 3; ++n) stepper->step(state.columns(), n / 240.0, 1 / 240.0);
        return state;
      };
      const BodyTable alone = run(1);
      for (const int threads : {2, 3})
        BOOST_TEST(same_bits(run(threads).columns(), alone.columns(), alone.size()), name << ", " << threads);
    }
  }
}

// Turns by theta about an axis, against sines and cosines of more digits. Bound: the functions' 3e-16 and the three
// roundings of the product and its normalisation. Turns beyond half a revolution take another way.
BOOST_AUTO_TEST_CASE(turns_are_right_to_rounding_at_every_angle) {
  for (const Kernels* table : every_table()) {
    double worst = 0, worst_at = 0;
    for (int k = 0; k < 20000; ++k) {
      const double theta = k * 5e-4;
      BodyTable one(9);
      for (std::size_t i = 0; i < one.size(); ++i) {
        one.columns().set_orientation(i, Quat::Identity());
        one.columns().set_angular_velocity(i, {0, theta, 0});
      }
      Bodies bodies;
      bodies.end = one.size(), bodies.stride = one.columns().stride();
      table->drift(bodies, one.columns().column(0), Turn::exponential, 1);
      const Quat q = one.columns().orientation(8);
      const long double half = 0.5L * theta;
      const double error = static_cast<double>(std::hypot(q.w() - std::cos(half), q.y() - std::sin(half)));
      if (error > worst) worst = error, worst_at = theta;
    }
    BOOST_TEST(worst < 5e-16, table->name << ": " << worst << " at " << worst_at << " rad");
  }
}

BOOST_AUTO_TEST_CASE(a_motion_that_is_not_finite_stays_so_and_leaves_the_others_alone) {
  Scene scene = crowd(20, false, false);
  const BodyTable sound = stepped(scene, "semi-implicit-euler", "quaternion-exponential", 10);
  scene.bodies[5].angular_velocity = {1e200, 1e200, 0};
  scene.bodies[6].velocity = {INFINITY, 0, 0};
  const BodyTable broken = stepped(scene, "semi-implicit-euler", "quaternion-exponential", 10);
  BOOST_TEST(!broken.columns().angular_velocity(5).allFinite());
  BOOST_TEST(!broken.columns().position(6).allFinite());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (i == 5 || i == 6) continue;
    BOOST_TEST((broken.columns().position(i) - sound.columns().position(i)).norm() == 0, "body " << i);
    BOOST_TEST((broken.columns().angular_velocity(i) - sound.columns().angular_velocity(i)).norm() == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
