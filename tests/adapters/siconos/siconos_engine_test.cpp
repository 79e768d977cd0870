// Siconos in its own process: that it is one, what its law of contact is known for, and its traps, each found again.
#include "adapters/siconos/siconos_engine.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <numbers>

#include "core/engine/engine_failure.h"
#include "tests/adapters/free_body_measures.h"
#include "tests/adapters/hung_rods.h"

using namespace rigor;

namespace {

constexpr double kPi = std::numbers::pi;

bool is_mapped(const std::string& library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.find(library) != std::string::npos) return true;
  return false;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(adapters_siconos_siconos_engine)

// Bullet in single precision crashes beside ours: nothing that brings it may come here.
BOOST_AUTO_TEST_CASE(neither_its_libraries_nor_their_bullet_come_into_this_process) {
  const auto world = load_run("siconos", sliding_box(1, 0, 0.5));
  body_after(*world, 1.0 / 240, 10);
  BOOST_TEST(is_mapped("libBulletCollision-float64"));  // ours is, so that the next lines can fail
  BOOST_TEST(!is_mapped("libsiconos"));
  BOOST_TEST(!is_mapped("libBulletCollision.so"));
}

BOOST_AUTO_TEST_SUITE_END()
