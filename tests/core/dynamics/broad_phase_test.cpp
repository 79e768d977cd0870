#include "core/dynamics/broad_phase.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace rigor;

namespace {

std::vector<std::pair<int, int>> by_trying_all(const std::vector<Ball>& balls) {
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < static_cast<int>(balls.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(balls.size()); ++b) {
      const double reach = balls[a].radius + balls[b].radius;
      if ((balls[a].centre - balls[b].centre).squaredNorm() < reach * reach) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

Vec3 wandering(int ball, double t, double speed) {
  return {1.5 * std::sin(0.7 * ball + speed * t), 1.5 * std::cos(1.3 * ball - speed * t),
          1.5 * std::sin(2.1 * ball + 0.5 * speed * t)};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(core_dynamics_broad_phase)

// A search holds for many steps; what it was made for changes in between: speeds, radii, the number of balls, and a
// ball that jumps or is lost.
BOOST_AUTO_TEST_CASE(balls_on_the_move_are_found_in_every_step) {
  BroadPhase broad_phase;
  std::size_t found = 0;
  for (int n = 0; n < 600; ++n) {
    const int count = n < 400 ? 120 : 90;
    const double speed = n < 100 ? 0 : n < 200 ? 0.3 : 20;
    std::vector<Ball> balls;
    for (int i = 0; i < count; ++i) balls.push_back({i, wandering(i, n / 240.0, speed), n < 300 ? 0.15 : 0.1});
    if (n % 50 == 25) balls[7].centre = balls[8].centre;
    if (n > 500) balls[9].centre.x() = n % 2 ? NAN : INFINITY;
    const auto expected = by_trying_all(balls);
    found += expected.size();
    BOOST_TEST((broad_phase.overlaps(balls) == expected), "step " << n);
  }
  BOOST_TEST(found > 10000u);
}

BOOST_AUTO_TEST_SUITE_END()
