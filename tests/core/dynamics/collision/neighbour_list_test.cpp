#include "core/dynamics/collision/neighbour_list.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_collision_neighbour_list)

namespace {

using Pairs = std::vector<std::pair<int, int>>;

// A search and the spheres it is for, each its own body.
class Search {
 public:
  explicit Search(const std::vector<double>& radii)
      : radii_(radii), state_(radii.size()), spheres_(kSphereColumns, radii.size()), search_(balls(radii)) {
    std::fill_n(spheres_.column(kRadius), spheres_.stride(), -INFINITY);
    std::copy(radii.begin(), radii.end(), spheres_.column(kRadius));
  }

  void place(int ball, const Vec3& centre) { state_.columns().set_position(ball, centre); }
  Vec3 centre(int ball) const { return state_.columns().position(ball); }
  Pairs found() {
    Bodies bodies;
    bodies.end = state_.size(), bodies.stride = spheres_.stride();
    return search_.overlaps(bodies, state_.columns(), spheres_);
  }
  Pairs by_trying_all() const {
    Pairs pairs;
    for (int a = 0; a < static_cast<int>(radii_.size()); ++a) {
      for (int b = a + 1; b < static_cast<int>(radii_.size()); ++b) {
        const double distance = radii_[a] + radii_[b];
        if ((centre(a) - centre(b)).squaredNorm() < distance * distance) pairs.emplace_back(a, b);
      }
    }
    return pairs;
  }

 private:
  static std::vector<Ball> balls(const std::vector<double>& radii) {
    std::vector<Ball> all;
    for (const double radius : radii) all.push_back({static_cast<int>(all.size()), radius});
    return all;
  }

  std::vector<double> radii_;
  BodyTable state_;
  Columns spheres_;
  NeighbourList search_;
};

Vec3 wandering(int ball, double t, double speed) {
  return {1.5 * std::sin(0.7 * ball + speed * t), 1.5 * std::cos(1.3 * ball - speed * t),
          1.5 * std::sin(2.1 * ball + 0.5 * speed * t)};
}

}  // namespace

// A search holds for many steps; what it was made for changes in between: speeds, and a ball that jumps, goes far or is
// lost.
BOOST_AUTO_TEST_CASE(balls_on_the_move_are_found_in_every_step) {
  const int count = 120;
  for (const double radius : {0.1, 0.15}) {
    Search search(std::vector<double>(count, radius));
    std::size_t found = 0;
    for (int n = 0; n < 600; ++n) {
      const double speed = n < 100 ? 0 : n < 200 ? 0.3 : 20;
      for (int i = 0; i < count; ++i) search.place(i, wandering(i, n / 240.0, speed));
      if (n % 50 == 25) search.place(7, search.centre(8));
      if (n > 400) search.place(8, {n % 3 * 1e9, 0, -1e300}), search.place(7, {n % 3 * 1e9, 0.01, -1e300});
      if (n > 500) search.place(9, {n % 2 ? NAN : INFINITY, 0, 0});
      const Pairs expected = search.by_trying_all();
      found += expected.size();
      BOOST_TEST((search.found() == expected), "step " << n);
    }
    BOOST_TEST(found > 5000u);
  }
}

BOOST_AUTO_TEST_CASE(balls_of_all_sizes_are_found_wherever_they_appear) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-2, 2), radius(0.05, 0.4);
  std::vector<double> radii(150);
  for (double& r : radii) r = radius(random);
  Search search(radii);
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 150; ++i) search.place(i, {coordinate(random), coordinate(random), coordinate(random)});
    const Pairs expected = search.by_trying_all();
    BOOST_TEST((search.found() == expected), "round " << round);
    BOOST_TEST(!expected.empty());
  }
}

// One that flies across all: the slack that it asks for makes every pair near, and must be cut down.
BOOST_AUTO_TEST_CASE(a_ball_far_faster_than_the_others_is_found_and_no_other) {
  const int side = 22, count = side * side * side;
  Search search(std::vector<double>(count, 0.1));
  const auto place = [&](int step) {
    for (int i = 0; i < count; ++i)
      search.place(i, {0.25 * (i % side), 0.25 * (i / side % side), 0.25 * (i / side / side)});
    search.place(count - 1, {7.0 * (step % 9), 0.05, 0.05});
  };
  for (int n = 0; n < 30; ++n) {
    place(n);
    // It overlaps the first ball where it starts, and no other.
    BOOST_TEST(search.found().size() == (n % 9 == 0 ? 1u : 0u), "step " << n);
  }
}

BOOST_AUTO_TEST_SUITE_END()
