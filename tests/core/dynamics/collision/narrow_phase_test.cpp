// Compares the narrow phase with a second derivation: the smallest distance of points of both cores, found by
// alternating projections onto the two convex sets, minus the radii.
#include "core/dynamics/collision/narrow_phase.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <limits>
#include <random>
#include <vector>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_collision_narrow_phase)

namespace {

// A shape's core (a point, a segment, a box) and the radius around it.
struct Core {
  Vec3 half;
  double radius;
  Pose pose;
  Vec3 nearest(const Vec3& p) const {
    return pose.p + pose.R * Vec3((pose.R.transpose() * (p - pose.p)).cwiseMax(-half).cwiseMin(half));
  }
};

struct CoreOf {
  const Pose& pose;
  Core operator()(const Sphere& s) const { return {Vec3::Zero(), s.radius, pose}; }
  Core operator()(const Box& b) const { return {0.5 * b.size, 0, pose}; }
  Core operator()(const Capsule& c) const { return {{0, 0, 0.5 * c.length}, c.radius, pose}; }
  template <typename Other>
  Core operator()(const Other&) const {
    return {Vec3::Zero(), 0, pose};
  }
};

// Von Neumann's alternating projections: converges to the nearest points of two convex sets.
double distance_by_projections(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const Core core_a = std::visit(CoreOf{pose_a}, a), core_b = std::visit(CoreOf{pose_b}, b);
  Vec3 p = pose_a.p, q = pose_b.p;
  for (int k = 0; k < 20000; ++k) p = core_a.nearest(q), q = core_b.nearest(p);
  return (p - q).norm() - core_a.radius - core_b.radius;
}

std::vector<Shape> round_and_flat() { return {Sphere{0.3}, Box{{0.5, 0.7, 0.9}}, Capsule{0.2, 0.8}}; }

Pose random_pose(std::mt19937& random, double spread) {
  std::normal_distribution<double> normal;
  const Quat q = Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
  return {spread * Vec3(normal(random), normal(random), normal(random)), q.toRotationMatrix()};
}

double least_gap(const Manifold& points) {
  double least = 1e9;
  for (const ManifoldPoint& point : points) least = std::min(least, point.gap);
  return least;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_gap_is_the_distance_of_the_shapes) {
  std::mt19937 random(5);
  Manifold points;
  for (const Shape& a : round_and_flat()) {
    for (const Shape& b : round_and_flat()) {
      const bool boxes = std::holds_alternative<Box>(a) && std::holds_alternative<Box>(b);
      int apart = 0;
      for (int round = 0; round < 200; ++round) {
        const Pose pose_a = random_pose(random, 0.6), pose_b = random_pose(random, 0.6);
        const double truth = distance_by_projections(a, pose_a, b, pose_b);
        collide(a, pose_a, b, pose_b, points);
        BOOST_REQUIRE(points.size() > 0);
        const double gap = least_gap(points);
        if (truth < 1e-6) {
          // Alternating projections do not see how deep cores overlap, only that they do.
          BOOST_TEST(gap < 1e-4);
          continue;
        }
        ++apart;
        // Two boxes that look at each other corner to corner are further apart than along any axis.
        if (boxes)
          BOOST_TEST((gap <= truth + 1e-6 && gap > 0), gap << " " << truth);
        else
          BOOST_TEST(std::abs(gap - truth) < 1e-4, shape_name(a)
                                                       << "-" << shape_name(b) << ": " << gap << " " << truth);
      }
      BOOST_TEST(apart > 20);
    }
  }
}

BOOST_AUTO_TEST_CASE(swapping_the_bodies_turns_the_normal_and_nothing_else) {
  std::mt19937 random(7);
  Manifold points, swapped;
  std::vector<Shape> shapes = round_and_flat();
  shapes.push_back(Plane{Vec3(1, 2, 3).normalized(), 0.1});
  for (const Shape& a : shapes) {
    for (const Shape& b : shapes) {
      for (int round = 0; round < 20; ++round) {
        const Pose pose_a = random_pose(random, 0.5), pose_b = random_pose(random, 0.5);
        collide(a, pose_a, b, pose_b, points);
        collide(b, pose_b, a, pose_a, swapped);
        BOOST_TEST(points.size() == swapped.size());
        if (points.size() == 0) continue;
        BOOST_TEST(std::abs(least_gap(points) - least_gap(swapped)) < 1e-12);
        BOOST_TEST((points[0].normal + swapped[0].normal).norm() < 1e-9);
      }
    }
  }
}

// Moving a by its gap along the normal closes it: what the normal and the gap are for.
BOOST_AUTO_TEST_CASE(the_gap_along_the_normal_brings_the_shapes_to_touch) {
  std::mt19937 random(11);
  Manifold points;
  std::vector<Shape> shapes = round_and_flat();
  shapes.push_back(Plane{Vec3(1, 2, 3).normalized(), 0.1});
  for (const Shape& a : round_and_flat()) {
    for (const Shape& b : shapes) {
      for (int round = 0; round < 100; ++round) {
        Pose pose_a = random_pose(random, 0.5);
        const Pose pose_b = random_pose(random, 0.5);
        collide(a, pose_a, b, pose_b, points);
        const auto nearest =
            std::min_element(points.begin(), points.end(), [](const auto& p, const auto& q) { return p.gap < q.gap; });
        const double gap = nearest->gap;
        BOOST_TEST(std::abs(nearest->normal.norm() - 1) < 1e-12);
        pose_a.p -= gap * nearest->normal;
        collide(a, pose_a, b, pose_b, points);
        const bool boxes = std::holds_alternative<Box>(a) && std::holds_alternative<Box>(b);
        // Corner to corner two boxes may pass each other's faces, and another axis is then the best one.
        if (!boxes || gap < 0)
          BOOST_TEST(std::abs(least_gap(points)) < 1e-9,
                     shape_name(a) << "-" << shape_name(b) << " " << gap << " left " << least_gap(points));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(flat_contacts_have_their_corners) {
  Manifold points;
  const Pose low, high{{0.2, 0.1, 1}, Mat3::Identity()};
  collide(Box{{1, 1, 1}}, high, Box{{1, 1, 1}}, low, points);
  BOOST_TEST(points.size() == 4);
  for (const ManifoldPoint& point : points) {
    BOOST_TEST((point.normal - Vec3(0, 0, 1)).norm() < 1e-12);
    BOOST_TEST(std::abs(point.gap) < 1e-12);
    BOOST_TEST(std::abs(std::abs(point.point.x() - 0.1) - 0.4) < 1e-5);  // the sides are cut a touch further out
  }
  const Pose lying{{0, 0, 0.7}, Eigen::AngleAxisd(std::acos(-1.0) / 2, Vec3::UnitY()).toRotationMatrix()};
  collide(Capsule{0.2, 0.6}, lying, Box{{1, 1, 1}}, low, points);
  BOOST_TEST(points.size() == 2);
  collide(Capsule{0.2, 0.6}, lying, Plane{Vec3::UnitZ(), 0.5}, low, points);
  BOOST_TEST(points.size() == 2);
  for (const ManifoldPoint& point : points) BOOST_TEST(std::abs(point.gap) < 1e-12);
}

BOOST_AUTO_TEST_SUITE_END()
