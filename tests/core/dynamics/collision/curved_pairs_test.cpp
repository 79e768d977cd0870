// Cylinders and ellipsoids with all shapes. The second derivations are points sampled over both surfaces, moved and
// turned pairs, and areas of contact in closed form.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "cases/metrics/measures/convex_distance.h"
#include "core/dynamics/collision/narrow_phase.h"
#include "tests/core/dynamics/collision/random_poses.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_collision_curved_pairs)

namespace {

std::vector<Shape> curved_shapes() {
  return {Cylinder{0.3, 0.7}, Cylinder{0.5, 0.06}, Cylinder{0.06, 1.2}, Ellipsoid{{0.2, 0.35, 0.5}},
          Ellipsoid{{0.03, 0.4, 0.5}}};
}

std::vector<Shape> all_shapes() {
  std::vector<Shape> shapes = curved_shapes();
  std::vector<Vec3> corners;
  for (int k = 0; k < 12; ++k) corners.emplace_back(0.4 * std::cos(2.4 * k), 0.4 * std::sin(2.4 * k), 0.07 * k - 0.4);
  for (const Shape& other : {Shape(Box{{0.5, 0.7, 0.9}}), Shape(Capsule{0.2, 0.8}), Shape(Convex{hull_of(corners)})})
    shapes.push_back(other);
  return shapes;
}

const ManifoldPoint& least_of(const Manifold& points) {
  return *std::min_element(points.begin(), points.end(), [](const auto& p, const auto& q) { return p.gap < q.gap; });
}

// m, of a from b along n.
double apart_along(const Vec3& n, const Shape& a, const Pose& at_a, const Shape& b, const Pose& at_b) {
  return n.dot(at_a.p + at_a.R * support(a, -(at_a.R.transpose() * n)) - at_b.p -
               at_b.R * support(b, at_b.R.transpose() * n));
}

// m: the most of many directions and of small turns around the best one. A search may end below the true separation.
double separation_by_search(const Shape& a, const Pose& at_a, const Shape& b, const Pose& at_b) {
  constexpr int kDirections = 4000;
  Vec3 best = Vec3::UnitZ();
  double most = -std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vec3& n) {
    const double apart = apart_along(n, a, at_a, b, at_b);
    if (apart > most) most = apart, best = n;
  };
  for (int k = 0; k < kDirections; ++k) {  // evenly over the sphere, along a spiral
    const double z = 1 - (2 * k + 1.0) / kDirections, r = std::sqrt(1 - z * z), angle = 2.399963229728653 * k;
    consider({r * std::cos(angle), r * std::sin(angle), z});
  }
  for (double turn = 0.05; turn > 1e-9;) {
    const double before = most;
    const Vec3 from = best, u = from.unitOrthogonal(), v = from.cross(u);
    for (int k = 0; k < 16; ++k)
      consider((from + turn * (std::cos(k * std::numbers::pi / 8) * u + std::sin(k * std::numbers::pi / 8) * v))
                   .normalized());
    if (most <= before) turn *= 0.6;
  }
  return most;
}

}  // namespace

// Apart, and overlapping by up to a hundredth of the smaller inradius: contacts of moving bodies lie between.
BOOST_AUTO_TEST_CASE(gaps_and_normals_are_those_of_a_search_over_directions) {
  test::RandomPoses random(11);
  Manifold points;
  for (const Shape& a : curved_shapes()) {
    for (const Shape& b : all_shapes()) {
      for (int k = 0; k < 12; ++k) {
        Pose at_a{random.vector(0.8), random.turn()};
        const Pose at_b{random.vector(0.2), random.turn()};
        collide(a, at_a, b, at_b, points);
        const ManifoldPoint first = least_of(points);
        const double size = std::min(inradius(a), inradius(b));
        if (k % 2 == 1) at_a.p -= (first.gap + 0.01 * size * random.between(-1, 1)) * first.normal;
        collide(a, at_a, b, at_b, points);
        const ManifoldPoint found = least_of(points);
        if (found.gap < -0.02 * size) continue;  // it lay deep
        const double expected = separation_by_search(a, at_a, b, at_b);
        BOOST_TEST_CONTEXT(shape_name(a) << "-" << shape_name(b) << " " << found.gap << " " << expected) {
          BOOST_TEST(std::abs(found.normal.norm() - 1) < 1e-12);
          // No direction is better, and along this one the shapes are apart by the gap. Points of a flat end leave out
          // what is 1e-5 of its width deeper. Between two rims the ascent ends where its steps gain nothing but
          // rounding.
          BOOST_TEST(found.gap > expected - 1e-8);
          BOOST_TEST(std::abs(apart_along(found.normal, a, at_a, b, at_b) - found.gap) < 2e-5);
        }
      }
    }
  }
}

// Random sizes find what the few shapes above do not: a climb that ends at a kink. The second derivation knows support
// functions alone, and is good to some 1e-9 of the size.
BOOST_AUTO_TEST_CASE(gaps_of_random_curved_shapes_are_those_of_their_support_functions) {
  constexpr int kPairs = 12000, kMostLonger = 1;  // one of 7,000 that overlap does so along a longer way
  test::RandomPoses random(3);
  const auto size = [&] { return std::exp(random.between(std::log(0.02), 0)); };  // m
  const auto any_shape = [&]() -> Shape {
    if (random.between(0, 1) < 0.6) return Cylinder{size(), 2 * size()};
    const double x = size(), y = size(), z = size();
    return Ellipsoid{{x, y, z}};
  };
  Manifold points;
  int apart = 0, overlapping = 0, longer = 0;
  for (int k = 0; k < kPairs; ++k) {
    const Shape a = any_shape(), b = any_shape();
    const double small = std::min(inradius(a), inradius(b));
    Pose at_a{random.vector(0.8), random.turn()};
    const Pose at_b{random.vector(0.2), random.turn()};
    if (k % 2 == 1) {
      const ConvexGap first = convex_distance(a, at_a, b, at_b);
      at_a.p -= (first.gap + 0.01 * small * random.between(-1, 1)) * first.normal;
    }
    const double expected = convex_distance(a, at_a, b, at_b).gap;
    if (expected < -0.02 * small) continue;  // it lay deep
    collide(a, at_a, b, at_b, points);
    const double longer_by = expected - least_of(points).gap;
    ++(expected > 0 ? apart : overlapping);
    // Points of a flat end leave out what is 1e-5 of its width deeper.
    if (expected > 0) BOOST_TEST(std::abs(longer_by) < 2e-5, k << " " << expected << " " << longer_by);
    longer += expected <= 0 && longer_by > 1e-7;
  }
  BOOST_TEST(apart > 6000);
  BOOST_TEST(overlapping > 2000);
  BOOST_TEST(longer <= kMostLonger);
}

BOOST_AUTO_TEST_CASE(only_shapes_further_apart_than_asked_for_lose_points) {
  test::RandomPoses random(12);
  Manifold all, near, far;
  for (const Shape& a : curved_shapes()) {
    for (const Shape& b : all_shapes()) {
      for (int k = 0; k < 12; ++k) {
        const Pose at_a{random.vector(0.8), random.turn()}, at_b{random.vector(0.2), random.turn()};
        collide(a, at_a, b, at_b, all);
        const double gap = least_of(all).gap;
        // Points of a flat end leave out what is 1e-5 of its width deeper.
        collide(a, at_a, b, at_b, near, gap + 1e-12), collide(a, at_a, b, at_b, far, gap - 2e-5);
        BOOST_TEST_CONTEXT(shape_name(a) << "-" << shape_name(b) << " " << gap) {
          BOOST_TEST_REQUIRE(near.size() == all.size());
          for (int i = 0; i < all.size(); ++i) BOOST_TEST((near[i].point == all[i].point && near[i].gap == all[i].gap));
          if (gap > 2e-5) BOOST_TEST((far.size() == 0 || std::holds_alternative<Capsule>(b)));
        }
      }
    }
  }
}

// A smooth pair is exact: moved by its gap along its normal it touches, and the normal is that of both surfaces.
BOOST_AUTO_TEST_CASE(ellipsoids_are_exact_to_rounding) {
  test::RandomPoses random(11);
  Manifold points;
  for (const Shape& a : {Shape(Ellipsoid{{0.2, 0.35, 0.5}}), Shape(Ellipsoid{{0.05, 0.4, 0.5}})}) {
    for (const Shape& b : all_shapes()) {
      for (int k = 0; k < 100; ++k) {
        Pose at_a{random.vector(1.2), random.turn()};
        const Pose at_b{random.vector(0.2), random.turn()};
        collide(a, at_a, b, at_b, points);
        BOOST_TEST_REQUIRE(points.size() == 1);
        if (points[0].gap < 0) continue;
        BOOST_TEST(std::abs(apart_along(points[0].normal, a, at_a, b, at_b) - points[0].gap) < 1e-12);
        const Vec3 normal = points[0].normal;
        at_a.p -= points[0].gap * normal;
        collide(a, at_a, b, at_b, points);
        BOOST_TEST(std::abs(points[0].gap) < 1e-12, shape_name(b) << " " << points[0].gap);
        // The point lies on the ellipsoid.
        const Vec3 local = at_a.R.transpose() * (points[0].point - at_a.p);
        const double on = local.cwiseQuotient(std::get<Ellipsoid>(a).radii).norm();
        BOOST_TEST(std::abs(on - 1) < 1e-9, shape_name(b) << " " << on);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(swapped_and_turned_pairs_touch_alike) {
  test::RandomPoses random(11);
  Manifold points, others;
  for (const Shape& a : curved_shapes()) {
    for (const Shape& b : all_shapes()) {
      for (int k = 0; k < 30; ++k) {
        const Pose at_a{random.vector(0.6), random.turn()}, at_b{random.vector(0.2), random.turn()},
            world{random.vector(3), random.turn()};
        collide(a, at_a, b, at_b, points);
        collide(b, at_b, a, at_a, others);
        const double gap = least_of(points).gap;
        if (gap < -0.01 * std::min(inradius(a), inradius(b))) continue;
        BOOST_TEST(std::abs(gap - least_of(others).gap) < 1e-9);
        collide(a, {world.p + world.R * at_a.p, world.R * at_a.R}, b, {world.p + world.R * at_b.p, world.R * at_b.R},
                others);
        BOOST_TEST(points.size() == others.size());
        BOOST_TEST(std::abs(gap - least_of(others).gap) < 1e-9);
        BOOST_TEST((world.R * least_of(points).normal - least_of(others).normal).norm() < 1e-6);
      }
    }
  }
}

// A drum that stands over the edge of a box: the border of the box cuts a chord from its end. Where the chord's ends
// and the other points lie is plain.
BOOST_AUTO_TEST_CASE(an_area_ends_at_the_border_of_both) {
  Manifold points;
  for (const double over : {0.1, 0.25, 0.39}) {
    collide(Cylinder{0.4, 0.6}, Pose{{1 + over, 0.3, 0.8}, Mat3::Identity()}, Box{{2, 2, 1}}, Pose(), points);
    BOOST_TEST_REQUIRE(points.size() >= 3);
    double chord = 0, inwards = 0;
    for (const ManifoldPoint& point : points) {
      BOOST_TEST(std::abs(point.gap) < 1e-12);
      BOOST_TEST(point.point.x() < 1 + 1e-6);
      BOOST_TEST(std::hypot(point.point.x() - 1 - over, point.point.y() - 0.3) < 0.4 + 1e-9);
      if (point.point.x() > 1 - 1e-6) chord = std::max(chord, std::abs(point.point.y() - 0.3));
      inwards = std::max(inwards, 1 - point.point.x());
    }
    BOOST_TEST(std::abs(chord - std::sqrt(0.16 - over * over)) < 1e-6);
    BOOST_TEST(std::abs(inwards - (0.4 - over)) < 1e-6);
  }
  // The lens of two ends.
  collide(Cylinder{0.5, 1}, Pose{{0.6, 0, 1}, Mat3::Identity()}, Cylinder{0.4, 1}, Pose(), points);
  const double x = (0.36 + 0.16 - 0.25) / 1.2, y = std::sqrt(0.16 - x * x);
  for (const Vec3& corner : {Vec3(x, y, 0.5), Vec3(x, -y, 0.5), Vec3(0.4, 0, 0.5), Vec3(0.1, 0, 0.5)}) {
    const auto is_there = [&](const ManifoldPoint& point) { return (point.point - corner).norm() < 1e-12; };
    BOOST_TEST(std::count_if(points.begin(), points.end(), is_there) == 1);
  }
}

// Lines of contact: a side on a face, along an edge, along another side, and across an end.
BOOST_AUTO_TEST_CASE(straight_sides_touch_at_both_ends_of_what_they_share) {
  const Mat3 lying = rotation_by(Vec3(0.5 * std::numbers::pi, 0, 0)).toRotationMatrix();  // along y
  const Mat3 on_edge = rotation_by(Vec3(0, 0.25 * std::numbers::pi, 0)).toRotationMatrix();
  const double up = std::sqrt(0.5);  // of the edge of a box of 1 m that lies on its edge
  const Cylinder log{0.2, 0.8};
  const auto expect_ends = [](const Manifold& points, double low, double high) {
    double least = 1e9, most = -1e9;
    int count = 0;
    for (const ManifoldPoint& point : points) {
      if (point.gap > 1e-9) continue;
      BOOST_TEST(std::abs(point.gap) < 1e-12);
      least = std::min(least, point.point.y()), most = std::max(most, point.point.y()), ++count;
    }
    BOOST_TEST(count == 2);
    BOOST_TEST(std::abs(least - low) < 1e-6);
    BOOST_TEST(std::abs(most - high) < 1e-6);
  };
  Manifold points;
  collide(log, Pose{{0, 0.3, 0.7}, lying}, Box{{1, 1, 1}}, Pose(), points);
  expect_ends(points, -0.1, 0.5);
  collide(log, Pose{{0, 0.3, up + 0.2}, lying}, Box{{1, 1, 1}}, Pose{Vec3::Zero(), on_edge}, points);
  expect_ends(points, -0.1, 0.5);
  collide(log, Pose{{0, 0.3, 0.4}, lying}, Cylinder{0.2, 1}, Pose{Vec3::Zero(), lying}, points);
  expect_ends(points, -0.1, 0.5);
  collide(log, Pose{{0, 0.3, 0.7}, lying}, Cylinder{0.5, 1}, Pose(), points);
  expect_ends(points, -0.1, 0.5);
  collide(Capsule{0.2, 0.8}, Pose{{0, 0.3, 0.7}, lying}, Cylinder{0.5, 1}, Pose(), points);
  expect_ends(points, -0.1, 0.5);
}

BOOST_AUTO_TEST_SUITE_END()
