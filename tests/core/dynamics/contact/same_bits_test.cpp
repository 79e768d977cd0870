// Contact that steps by kernels: the same bits whatever the instruction set, and whatever the number of threads.
#include <cstring>

#include "core/dynamics/kernels/kernels.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

namespace {

// Balls of different masses and sizes at different heights, some of which meet each other.
Scene bouncing_balls(int count, const ContactLaw& law) {
  std::vector<Body> balls;
  for (int i = 0; i < count; ++i) {
    const double radius = 0.1 + 0.01 * (i % 4);
    balls.push_back(solid("ball " + std::to_string(i), Sphere{radius},
                          {0.23 * (i % 5), 0.23 * (i / 5 % 5), 0.2 + 0.25 * (i / 25) + 0.03 * (i % 7)}, 1 + 0.1 * i));
    balls.back().velocity = {0.3 * (i % 3 - 1), 0.2 * (i % 2), -0.1 * i};
    balls.back().angular_velocity = {0.5 * i, -1, 2};
  }
  return on_floor(balls, law);
}

BodyTable stepped(const Scene& scene, const std::string& method, const Kernels& table, int steps) {
  const KernelsForTest in_use(table);
  ContactRun run(scene, method, "semi-implicit-euler");
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

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_same_bits)

BOOST_AUTO_TEST_CASE(every_instruction_set_gives_the_same_bits) {
  const Kernels* tables[kMostKernelTables];
  const std::size_t count = available_kernels(tables);
  const std::pair<const char*, Scene> runs[] = {
      {"course", bouncing_balls(60, {0.9, kInfiniteFriction})},
  };
  for (const auto& [method, scene] : runs) {
    const BodyTable plain = stepped(scene, method, *tables[0], 120);
    BOOST_TEST(plain.columns().velocity(0).allFinite());
    for (std::size_t k = 1; k < count; ++k) {
      const BodyTable other = stepped(scene, method, *tables[k], 120);
      BOOST_TEST(same_bits(other.columns(), plain.columns()), method << ": " << tables[k]->name);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
