// Contact that steps by kernels: the same bits whatever the instruction set, and whatever the number of threads.
#include <cstring>

#include "core/dynamics/kernels/kernels.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_same_bits)

namespace {

// Balls of different masses and sizes at different heights, some of which meet each other.
Scene bouncing_balls(int count, const ContactLaw& law) {
  std::vector<Body> balls;
  for (int i = 0; i < count; ++i) {
    const double radius = 0.1 + 0.01 * (i % 4);
    balls.push_back(solid("ball " + std::to_string(i), Sphere{radius},
                          {0.23 * (i % 5), 0.23 * (i / 5 % 5), 0.2 + 0.25 * (i / 25) + 0.03 * (i % 7)},
                          1 + 0.1 * (i % 60)));
    balls.back().velocity = {0.3 * (i % 3 - 1), 0.2 * (i % 2), -0.1 * (i % 60)};
    balls.back().angular_velocity = {0.5 * (i % 60), -1, 2};
  }
  return on_floor(balls, law);
}

// Boxes, capsules and balls that come down on each other, turning.
Scene heap(int count, const ContactLaw& law) {
  std::vector<Body> bodies;
  for (int i = 0; i < count; ++i) {
    const Shape shapes[] = {Sphere{0.1}, Box{{0.2, 0.25, 0.3}}, Capsule{0.08, 0.2}};
    bodies.push_back(solid("body " + std::to_string(i), shapes[i % 3],
                           {0.3 * (i % 3), 0.3 * (i / 3 % 3), 0.25 + 0.35 * (i / 9)}, 1 + i % 4));
    bodies.back().angular_velocity = {0.5 * (i % 5), -1, 0.3 * i};
  }
  return on_floor(bodies, law);
}

// A tray on the floor, and a hundred balls on it.
Scene laden_tray(const ContactLaw& law) {
  std::vector<Body> bodies = {solid("tray", Box{{2.2, 2.2, 0.1}}, {0.95, 0.95, 0.05}, 20)};
  for (int i = 0; i < 100; ++i)
    bodies.push_back(
        solid("ball " + std::to_string(i), Sphere{0.1}, {0.21 * (i % 10), 0.21 * (i / 10), 0.2}, 1 + i % 3));
  bodies[0].velocity = {0.5, 0, 0};
  return on_floor(bodies, law);
}

struct ContactCase {
  const char* what;
  Scene scene;
  const char* method;
  const char* integrator;
};

BodyTable stepped(const ContactCase& c, const Kernels& table, int steps, const std::string& threads = "1") {
  const KernelsInPlace in_use(table);
  ContactRun run(c.scene, c.method, c.integrator, {{"threads", threads}});
  run.run(1.0 / 120, steps);
  return BodyTable(std::as_const(run).state());
}

bool same_bits(BodyColumns a, BodyColumns b) {
  for (int c = 0; c < kRotation; ++c) {
    if (std::memcmp(a.column(c), b.column(c), a.size() * sizeof(double)) != 0) return false;
  }
  return true;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_instruction_set_gives_the_same_bits) {
  const Kernels* tables[kMostKernelTables];
  const std::size_t count = available_kernels(tables);
  const ContactCase cases[] = {
      {"bouncing balls", bouncing_balls(60, {0.9, kInfiniteFriction}), "course", "semi-implicit-euler"},
      {"a heap", heap(45, {0, 0.5}), "impulse", "semi-implicit-euler"},
      {"a heap that bounces and does not slide", heap(45, {0.5, kInfiniteFriction}), "impulse", "velocity-verlet"},
      {"a heap without friction", heap(45, {0.2, 0}), "impulse", "rk4"},
      {"a heap of balls", bouncing_balls(60, {0.3, 0.4}), "impulse", "semi-implicit-euler"},
      {"balls on a floor and no impacts", bouncing_balls(60, {0, 0.4}), "impulse", "semi-implicit-euler"},
  };
  for (const ContactCase& c : cases) {
    const BodyTable plain = stepped(c, *tables[0], 120);
    BOOST_TEST(plain.columns().velocity(0).allFinite(), c.what);
    for (std::size_t k = 1; k < count; ++k)
      BOOST_TEST(same_bits(stepped(c, *tables[k], 120).columns(), plain.columns()), c.what << ": " << tables[k]->name);
  }
}

// With impacts that are settled together, sliding, and a body that touches many others.
BOOST_AUTO_TEST_CASE(threads_that_share_heaps_change_no_bit) {
  Scene sunk = heap(150, {0, 0.5});
  for (int i = 0; i < 30; ++i) sunk.bodies[static_cast<std::size_t>(i)].position.z() -= 0.1;  // overlaps at the start
  const ContactCase cases[] = {
      {"a laden tray", laden_tray({0, 0.3}), "impulse", "semi-implicit-euler"},
      {"a heap", heap(150, {0, 0.5}), "impulse", "semi-implicit-euler"},
      {"a heap of balls that bounce", bouncing_balls(200, {0.3, 0.4}), "impulse", "velocity-verlet"},
      {"a heap that overlaps", sunk, "impulse", "semi-implicit-euler"},
  };
  for (const ContactCase& c : cases) {
    const BodyTable alone = stepped(c, kernels(), 20);
    BOOST_TEST(alone.columns().velocity(0).allFinite(), c.what);
    for (const char* threads : {"2", "3"})
      BOOST_TEST(same_bits(stepped(c, kernels(), 20, threads).columns(), alone.columns()), c.what << ", " << threads);
  }
}

BOOST_AUTO_TEST_CASE(threads_change_no_bit) {
  const int count = 8400;  // enough that threads are used
  for (const auto& [method, steps] : {std::pair("course", 10), std::pair("impulse", 2)}) {
    const ContactCase c{method, bouncing_balls(count, {0.9, kInfiniteFriction}), method, "semi-implicit-euler"};
    const BodyTable alone = stepped(c, kernels(), steps);
    for (const char* threads : {"2", "3"})
      BOOST_TEST(same_bits(stepped(c, kernels(), steps, threads).columns(), alone.columns()),
                 method << ", " << threads);
  }
}

BOOST_AUTO_TEST_SUITE_END()
