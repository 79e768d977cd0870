// Contacts with triangles: against a plane where they are flat, and against a box where they are one.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <limits>

#include "cases/metrics/measures/convex_distance.h"
#include "core/dynamics/collision/narrow_phase.h"
#include "tests/core/dynamics/collision/random_poses.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_collision_surface_contacts)

namespace {

constexpr double kRounding = 1e-12;  // m, of bodies of a metre

;

double least_gap(const Shape& a, const Pose& at_a, const Shape& b, const Pose& at_b) {
  Manifold points;
  collide(a, at_a, b, at_b, points);
  double least = std::numeric_limits<double>::infinity();
  for (const ManifoldPoint& point : points) least = std::min(least, point.gap);
  return least;
}

Heightfield flat_ground(std::size_t count) {
  Heightfield field;
  field.size = {4, 4}, field.heights.assign(count, std::vector<double>(count, 0.0));
  field.surface = height_surface(field.size, field.heights);
  return field;
}

Mesh mesh_of_box(const Vec3& size) { return {{closed_surface(scaled(unit_cube(), size))}}; }

std::vector<Shape> shapes() {
  return {Box{{0.3, 0.5, 0.2}},
          Capsule{0.1, 0.4},
          Convex{hull_of({{0.2, 0, -0.1}, {-0.2, 0.1, -0.1}, {0, -0.2, 0.15}, {0, 0.2, 0.2}, {0.1, 0.1, 0.3}})},
          Cylinder{0.15, 0.3},
          Ellipsoid{{0.1, 0.15, 0.2}},
          Sphere{0.2}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(flat_triangles_touch_as_a_plane_does) {
  test::RandomPoses random(7);
  const Shape field = flat_ground(17), plane = Plane{Vec3::UnitZ(), 0};
  for (const Shape& shape : shapes()) {
    for (int k = 0; k < 200; ++k) {
      const Pose at{{random.between(-1.2, 1.2), random.between(-1.2, 1.2), random.between(0, 0.5)}, random.turn()};
      const double on_plane = least_gap(shape, at, plane, {});
      if ((at.p + at.R * (std::holds_alternative<Convex>(shape) ? std::get<Convex>(shape).centre() : Vec3::Zero()))
              .z() < 0)
        continue;                     // sunk
      if (on_plane > 0.15) continue;  // of points that are farther than the shape is large, there are none
      BOOST_TEST(std::abs(least_gap(shape, at, field, {}) - on_plane) < kRounding);
      BOOST_TEST(std::abs(least_gap(field, {}, shape, at) - on_plane) < kRounding);
    }
  }
}

BOOST_AUTO_TEST_CASE(seams_have_no_contacts_of_their_own) {
  // A box that lies flat over many seams touches with its corners, and a ball with one point, each straight up.
  const Shape field = flat_ground(33);
  Manifold points;
  collide(Box{{0.4, 0.4, 0.2}}, {{0.03, 0.01, 0.1}, Mat3::Identity()}, field, {}, points);
  const auto near = std::count_if(points.begin(), points.end(), [](const auto& point) { return point.gap < 0.1; });
  BOOST_TEST(near == 4);
  for (const ManifoldPoint& point : points) BOOST_TEST((point.normal - Vec3::UnitZ()).norm() < kRounding);
  for (const double x : {0.0, 0.0625, 0.125, 0.1, 0.2}) {
    collide(Sphere{0.2}, {{x, 0.5 * x, 0.2 - 1e-4}, Mat3::Identity()}, field, {}, points);
    BOOST_TEST(points.size() == 1);
    BOOST_TEST((points[0].normal - Vec3::UnitZ()).norm() < kRounding);
    BOOST_TEST(std::abs(points[0].gap + 1e-4) < kRounding);
  }
}

// The distance from a box is in closed form for balls and capsules.
BOOST_AUTO_TEST_CASE(round_shapes_are_as_far_from_a_mesh_of_a_box_as_from_the_box) {
  test::RandomPoses random(7);
  const Vec3 size(0.8, 0.5, 0.6);
  const Shape mesh = mesh_of_box(size), box = Box{size};
  int apart = 0;
  for (const Shape& shape : {Shape(Sphere{0.2}), Shape(Capsule{0.1, 0.4})}) {
    for (int k = 0; k < 1000; ++k) {
      const Pose at{random.vector(0.9), random.turn()}, of_box{random.vector(0.1), random.turn()};
      const double expected = least_gap(shape, at, box, of_box);
      if (expected < -0.09 || expected > 0.2) continue;  // the axis, or the centre, is inside; or it is far away
      ++apart;
      BOOST_TEST(std::abs(least_gap(shape, at, mesh, of_box) - expected) < 1e-11);
    }
  }
  BOOST_TEST(apart > 500);
}

// Two polyhedra touch with a corner on a face or with two edges. What is found is never nearer than they are, and often
// their distance. It is none where a corner is nearest to a corner or to an edge; such a pair is found once it
// overlaps.
BOOST_AUTO_TEST_CASE(polyhedra_meet_a_mesh_of_a_box_as_they_meet_the_box) {
  test::RandomPoses random(7);
  const Vec3 size(0.8, 0.5, 0.6);
  const Shape mesh = mesh_of_box(size), box = Box{size};
  // m; and what a normal does that takes the place of one up to a hundredth of a radian aside
  constexpr double kNear = 1e-3, kTurned = kNear * 0.5 * kNearlyFlat * kNearlyFlat + 1e-9;
  int same = 0, all = 0;
  for (const Shape& shape : {shapes()[0], shapes()[2]}) {
    for (int k = 0; k < 1000; ++k) {
      Pose at{random.vector(1), random.turn()};
      const double far = convex_distance(shape, at, box, {}).gap;
      if (far < 0.05) continue;
      const Vec3 shortest = convex_distance(shape, at, box, {}).normal;
      at.p -= (far - kNear) * shortest;
      const double expected = convex_distance(shape, at, box, {}).gap, found = least_gap(shape, at, mesh, {});
      ++all, same += std::abs(found - expected) < kTurned;
      BOOST_TEST(found > expected - kTurned);
      at.p -= 2 * kNear * shortest;
      const double overlap = least_gap(shape, at, mesh, {});
      BOOST_TEST((overlap < 0 && overlap > -4 * kNear), overlap << " " << convex_distance(shape, at, box, {}).gap);
    }
  }
  BOOST_TEST(all > 500);
  BOOST_TEST(same > 0.4 * all);
}

// Their distance from the box is known to the last digits (curved_pairs_test.cpp).
BOOST_AUTO_TEST_CASE(curved_shapes_are_as_far_from_a_mesh_of_a_box_as_from_the_box) {
  constexpr double kNear = 1e-3;
  test::RandomPoses random(7);
  const Vec3 size(0.8, 0.5, 0.6);
  const Shape mesh = mesh_of_box(size), box = Box{size};
  for (const Shape& shape :
       {Shape(Cylinder{0.15, 0.5}), Shape(Cylinder{0.3, 0.1}), Shape(Ellipsoid{{0.1, 0.2, 0.3}})}) {
    int same = 0, all = 0;
    for (int k = 0; k < 1000; ++k) {
      Pose at{random.vector(1), random.turn()};
      Manifold points;
      collide(shape, at, box, {}, points);
      const auto nearest =
          std::min_element(points.begin(), points.end(), [](const auto& p, const auto& q) { return p.gap < q.gap; });
      if (nearest->gap < 0.05) continue;
      const Pose close{at.p - (nearest->gap - kNear) * nearest->normal, at.R},
          inside{at.p - (nearest->gap + kNear) * nearest->normal, at.R};
      const double expected = least_gap(shape, close, box, {}), found = least_gap(shape, close, mesh, {});
      BOOST_TEST(found > expected - 1e-6);
      ++all, same += std::abs(found - expected) < 1e-6;
      // A rim inside an edge is deeper along a face's normal than along the edge's.
      const double overlap = least_gap(shape, inside, mesh, {});
      BOOST_TEST((overlap < 0 && overlap > -4 * kNear), overlap);
    }
    BOOST_TEST(all > 500);
    BOOST_TEST(same > 0.99 * all, shape_name(shape) << ": " << same << " of " << all);
  }
}

// Of a corner a little way into a step, the side of the step is real, and the depth below its top is not.
BOOST_AUTO_TEST_CASE(a_corner_in_the_side_of_a_step_is_not_lifted_onto_it) {
  Heightfield step;
  step.size = {4, 2}, step.heights = {{0, 0, 0.5, 0.5}, {0, 0, 0.5, 0.5}};
  step.surface = height_surface(step.size, step.heights);  // it rises from x = -2/3 to 2/3, steeply enough
  Manifold points;
  const double rise = 0.5 / (4.0 / 3);
  const Vec3 n = Vec3(-rise, 0, 1).normalized();
  collide(Sphere{0.1}, {Vec3(-2.0 / 3 + 0.3, 0, rise * 0.3) + 0.0999 * n, Mat3::Identity()}, step, {}, points);
  for (const ManifoldPoint& point : points)
    if (point.gap < 0) BOOST_TEST((point.normal - n).norm() < kRounding);
  const Shape slab = mesh_of_box({1, 1, 1});
  // A lower edge of the box is 1 mm inside the slab's side, half a metre below its top.
  collide(Box{{0.4, 0.4, 0.4}}, {{0.699, 0, 0.1}, Mat3::Identity()}, slab, {}, points);
  BOOST_TEST_REQUIRE(points.size() > 0);
  for (const ManifoldPoint& point : points) {
    if (point.gap >= 0) continue;
    BOOST_TEST((point.normal - Vec3::UnitX()).norm() < kRounding);
    BOOST_TEST(std::abs(point.gap + 0.001) < kRounding);
  }
}

BOOST_AUTO_TEST_CASE(the_back_of_a_thin_wall_is_no_overlap) {
  const Shape wall = mesh_of_box({2, 2, 0.01});
  for (const Shape& shape : shapes()) {
    Pose at{{0, 0, 0}, Mat3::Identity()};
    at.p.z() = 0.005 - least_gap(shape, {{0, 0, 0}, Mat3::Identity()}, Plane{Vec3::UnitZ(), 0}, {});
    BOOST_TEST(std::abs(least_gap(shape, at, wall, {})) < kRounding);
  }
}

// A body of one shape that is moved aside keeps its contacts on both slopes.
BOOST_AUTO_TEST_CASE(a_part_of_a_body_touches_each_slope_of_a_valley) {
  Heightfield valley;
  valley.size = {2, 2}, valley.heights = {{1, 0, 1}, {1, 0, 1}};
  valley.surface = height_surface(valley.size, valley.heights);
  const Shape moved = Compound{{{Sphere{0.2}, {{0, 0, 0.3}, Quat::Identity()}}}};
  Manifold points;
  collide(moved, {{0, 0, 0.2 * std::sqrt(2.0) - 0.3}, Mat3::Identity()}, valley, {}, points);
  BOOST_TEST_REQUIRE(points.size() == 2);
  for (const ManifoldPoint& point : points) BOOST_TEST(std::abs(point.gap) < kRounding);
  BOOST_TEST(points[0].part_b != points[1].part_b);
  collide(valley, {}, moved, {{0, 0, 0.2 * std::sqrt(2.0) - 0.3}, Mat3::Identity()}, points);
  BOOST_TEST_REQUIRE(points.size() == 2);
  BOOST_TEST(points[0].part_a != points[1].part_a);
}

BOOST_AUTO_TEST_SUITE_END()
