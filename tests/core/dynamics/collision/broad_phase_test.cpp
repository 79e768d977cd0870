#include "core/dynamics/collision/broad_phase.h"

#include <boost/test/unit_test.hpp>
#include <limits>
#include <random>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_collision_broad_phase)

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

// So many that the tree has five levels; they wander through each other, some at a time, until what was near is not.
BOOST_AUTO_TEST_CASE(boxes_that_wander_are_found_whatever_the_number_of_threads) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-6, 6), step(-1, 1);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 700; ++i) {
    const Vec3 low(coordinate(random), coordinate(random), coordinate(random));
    boxes.push_back({low, low + Vec3::Constant(i % 100 == 0 ? 4 : 0.7)});
  }
  ThreadPool threads(3);
  BroadPhase alone, shared;
  BOOST_TEST((alone.overlaps(boxes) == overlaps_of_all(boxes)));
  shared.overlaps(boxes);
  for (int round = 0; round < 30; ++round) {
    std::vector<int> changed;
    for (int i = round % 11; i < 700; i += 11) changed.push_back(i);
    for (const int i : changed) {
      const Vec3 by(step(random), step(random), step(random));
      boxes[static_cast<std::size_t>(i)].low += by, boxes[static_cast<std::size_t>(i)].high += by;
    }
    const auto expected = overlaps_of_all(boxes);
    BOOST_TEST(expected.size() > 300U);
    BOOST_TEST((alone.overlaps(boxes, changed) == expected), round);
    BOOST_TEST((shared.overlaps(boxes, changed, &threads) == expected), round);
  }
}

BOOST_AUTO_TEST_CASE(what_is_not_a_number_overlaps_all) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const int count : {1, 8, 9, 70}) {
    std::vector<Aabb> boxes;
    for (int i = 0; i < count; ++i) boxes.push_back({Vec3::Constant(2 * i), Vec3::Constant(2 * i + 1)});
    boxes.push_back({Vec3(none, none, none), Vec3(none, none, none)});
    BroadPhase broad_phase;
    const auto& pairs = broad_phase.overlaps(boxes);
    BOOST_TEST(pairs.size() == static_cast<std::size_t>(count));
    for (const auto& pair : pairs) BOOST_TEST(pair.second == count);
    // It moves among the others, and one of these becomes none.
    boxes[static_cast<std::size_t>(count)] = {Vec3::Constant(-9), Vec3::Constant(-8)};
    boxes[0].high.y() = none;  // of its low corner it is known where it lies
    BOOST_TEST(broad_phase.overlaps(boxes, {0, count}).size() <= 1U);
    boxes[0].low.setConstant(none), boxes[0].high.setConstant(none);
    BOOST_TEST(broad_phase.overlaps(boxes, {0}).size() == static_cast<std::size_t>(count));
  }
}

BOOST_AUTO_TEST_CASE(no_boxes_have_no_pairs) {
  BroadPhase broad_phase;
  BOOST_TEST(broad_phase.overlaps({}).empty());
  BOOST_TEST(broad_phase.overlaps({}, {}).empty());
}

BOOST_AUTO_TEST_SUITE_END()
