#include "core/dynamics/collision/broad_phase.h"

#include <boost/test/unit_test.hpp>
#include <limits>
#include <random>

using namespace rigor;

namespace {

std::vector<std::pair<int, int>> overlaps_of_all(const std::vector<Aabb>& boxes) {
  std::vector<std::pair<int, int>> found;
  for (int a = 0; a < static_cast<int>(boxes.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(boxes.size()); ++b) {
      if ((boxes[a].low.array() <= boxes[b].high.array()).all() &&
          (boxes[b].low.array() <= boxes[a].high.array()).all())
        found.emplace_back(a, b);
    }
  }
  return found;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(core_dynamics_collision_broad_phase)

BOOST_AUTO_TEST_CASE(it_finds_what_a_search_of_all_pairs_finds) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-3, 3), size(0.05, 0.5);
  const auto random_box = [&](double scale) {
    const Vec3 low(coordinate(random), coordinate(random), coordinate(random));
    return Aabb{low, low + scale * Vec3(size(random), size(random), size(random))};
  };
  BroadPhase broad_phase;
  for (int round = 0; round < 20; ++round) {
    std::vector<Aabb> boxes;
    for (int i = 0; i < 150; ++i) boxes.push_back(random_box(i % 50 == 0 ? 20 : 1));  // a few large ones
    const double infinity = std::numeric_limits<double>::infinity();
    boxes.push_back({Vec3::Constant(-infinity), Vec3::Constant(infinity)});
    BOOST_TEST((broad_phase.overlaps(boxes) == overlaps_of_all(boxes)));
    BOOST_TEST(overlaps_of_all(boxes).size() > 160);
    for (const int changes : {0, 1, 3, 40, 100}) {  // in which large ones become small, too, and the other way round
      std::vector<int> changed;
      for (int k = 0; k < changes; ++k) changed.push_back((round + 7 * k) % 150);
      for (const int i : changed) boxes[i] = random_box(i % 40 == 0 ? 20 : 1);
      BOOST_TEST((broad_phase.overlaps(boxes, changed) == overlaps_of_all(boxes)), changes << " changes");
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
