// Capsules side by side and along edges, at any small angle, beside the judge's own geometry.
#include "core/dynamics/collision/side_by_side.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "cases/metrics/measures/shape_gap.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_collision_side_by_side)

namespace {

const Capsule kLong{0.1, 0.8}, kShort{0.15, 0.5};
const Box kBox{{0.4, 0.6, 0.9}};

Convex hull_of_box() {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.push_back(Vec3(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5).cwiseProduct(kBox.size));
  return {hull_of(corners)};
}

const ManifoldPoint& nearest_of(const Manifold& points) {
  return *std::min_element(points.begin(), points.end(), [](const auto& p, const auto& q) { return p.gap < q.gap; });
}

Pose pose_of(const BodyPose& pose) { return {pose.position, pose.orientation.toRotationMatrix()}; }

// A capsule at a point beside another body's line along z, turned from it by an angle.
BodyPose beside(const Vec3& at, double angle, double heading) {
  const Quat turn = rotation_by(angle * Vec3(std::cos(heading), std::sin(heading), 0));
  return {at, turn};
}

}  // namespace

// Gaps come from differences of metres, and a crossing at 3e-6 rad is known to 1e-5 m: 1e-20 m of its gap. At smaller
// angles the ends stand for the crossing, which errs by (0.4 · 3e-6)²/(2 · 0.06) = 1.2e-11 m at the edge.
BOOST_AUTO_TEST_CASE(the_gap_of_nearly_parallel_lines_is_that_of_the_judges_geometry) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(-1, 1);
  const Convex hull = hull_of_box();
  Manifold points;
  for (const double angle : {0.0, 1e-9, 1e-7, 2e-6, 4e-6, 1e-5, 1e-4, 1e-3, 5e-3, 9e-3, 2e-2, 0.1}) {
    for (int round = 0; round < 60; ++round) {
      // Lines that lean towards each other by more than the angle squared have no crossing between their ends.
      const double heading = 3 * share(random), along = 0.5 * share(random), lean = angle * share(random);
      const BodyPose capsule =
          beside({0.24 * std::cos(heading), 0.24 * std::sin(heading), along}, angle, heading + lean);
      collide(kLong, pose_of(capsule), kShort, Pose(), points);
      const double of_capsules = shape_gap(kLong, capsule, kShort, {});
      BOOST_TEST(std::abs(nearest_of(points).gap - of_capsules) < 1.5e-11,
                 angle << " rad: " << nearest_of(points).gap << " for " << of_capsules);
      const BodyPose at_edge =
          beside({0.2 + 0.06 * std::cos(0.7), 0.3 + 0.06 * std::sin(0.7), along}, angle, 0.7 + lean);
      const double of_edge = shape_gap(kBox, {}, kLong, at_edge);
      collide(kBox, Pose(), kLong, pose_of(at_edge), points);
      BOOST_TEST(std::abs(nearest_of(points).gap - of_edge) < 1.5e-11,
                 angle << " rad, box: " << nearest_of(points).gap);
      collide(kLong, pose_of(at_edge), hull, Pose(), points);
      BOOST_TEST(std::abs(nearest_of(points).gap - of_edge) < 1.5e-11,
                 angle << " rad, hull: " << nearest_of(points).gap);
    }
  }
}

// The two ends of the line that they share, at the same gap.
BOOST_AUTO_TEST_CASE(parallel_lines_have_two_points) {
  const Convex hull = hull_of_box();
  const Vec3 out(std::cos(0.7), std::sin(0.7), 0);
  const BodyPose beside_capsule{0.25 * out + Vec3(0, 0, 0.2), Quat::Identity()},
      at_edge{Vec3(0.2, 0.3, 0.2) + 0.1 * out, Quat::Identity()};
  Manifold points;
  const auto check = [&](double low, double high, const Vec3& normal, const Vec3& line) {
    BOOST_TEST_REQUIRE(points.size() == 2);
    BOOST_TEST(points[0].feature != points[1].feature);
    std::vector<double> ends = {points[0].point.z(), points[1].point.z()};
    std::sort(ends.begin(), ends.end());
    BOOST_TEST(std::abs(ends[0] - low) < 1e-15);
    BOOST_TEST(std::abs(ends[1] - high) < 1e-15);
    for (const ManifoldPoint& point : points) {
      BOOST_TEST(std::abs(point.gap) < 1e-15);
      BOOST_TEST((point.normal - normal).norm() < 1e-14);
      BOOST_TEST((point.point - line - point.point.z() * Vec3::UnitZ()).norm() < 1e-15);
    }
  };
  collide(kLong, pose_of(beside_capsule), kShort, Pose(), points);
  check(-0.2, 0.25, out, 0.15 * out);
  collide(kBox, Pose(), kLong, pose_of(at_edge), points);
  check(-0.2, 0.45, -out, {0.2, 0.3, 0});
  collide(kLong, pose_of(at_edge), hull, Pose(), points);
  check(-0.2, 0.45, out, {0.2, 0.3, 0});
}

BOOST_AUTO_TEST_CASE(end_to_end_they_have_one_point) {
  Manifold points;
  collide(kLong, {{0.1, 0, 0.9}, Mat3::Identity()}, kShort, Pose(), points);
  BOOST_TEST(points.size() == 1);
  BOOST_TEST(std::abs(points[0].gap - (std::hypot(0.1, 0.25) - 0.25)) < 1e-15);
  collide(kBox, Pose(), kLong, {{0.25, 0.35, 1}, Mat3::Identity()}, points);
  BOOST_TEST(points.size() == 1);
}

BOOST_AUTO_TEST_SUITE_END()
