// Hulls, cylinders, ellipsoids and compounds in the narrow phase. Two derivations are independent of it: boxes with
// their own algorithm, and convex_distance() by support functions alone.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <limits>
#include <random>
#include <vector>

#include "cases/metrics/measures/convex_distance.h"
#include "core/dynamics/collision/narrow_phase.h"
#include "tests/core/dynamics/collision/any_shape.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_collision_convex_pairs)

namespace {

class PairRandom {
 public:
  explicit PairRandom(unsigned seed) : random_(seed) {}
  Vec3 vector() { return {normal_(random_), normal_(random_), normal_(random_)}; }
  Pose pose(double spread) {
    const Quat q = Quat(normal_(random_), normal_(random_), normal_(random_), normal_(random_)).normalized();
    return {spread * vector(), q.toRotationMatrix()};
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

Convex hull_of_box(const Vec3& size) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.push_back(size.cwiseProduct(Vec3(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5)));
  return {hull_of(corners)};
}

Convex rock(unsigned seed) {
  PairRandom random(seed);
  std::vector<Vec3> points;
  for (int k = 0; k < 32; ++k) points.push_back(0.5 * random.vector().normalized());
  return {hull_of(points)};
}

Convex stretched(const Convex& convex, const Vec3& by) {
  std::vector<Vec3> points = convex.hull->points;
  for (Vec3& point : points) point = point.cwiseProduct(by);
  return {hull_of(points)};
}

// Its faces meet at 70 degrees, so their normals are 110 degrees apart.
Convex tetrahedron() { return {hull_of({{0.5, 0.5, 0.5}, {0.5, -0.5, -0.5}, {-0.5, 0.5, -0.5}, {-0.5, -0.5, 0.5}})}; }

bool is_polyhedron(const Shape& shape) {
  return std::holds_alternative<Box>(shape) || std::holds_alternative<Convex>(shape);
}
bool is_curved(const Shape& shape) {
  return std::holds_alternative<Cylinder>(shape) || std::holds_alternative<Ellipsoid>(shape);
}

const ManifoldPoint& nearest_of(const Manifold& points) {
  return *std::min_element(points.begin(), points.end(), [](const auto& p, const auto& q) { return p.gap < q.gap; });
}

// m. The deepest corner may lie beside the other's face, so that the points of two polyhedra that overlap may be less
// deep.
double separation_along(const Vec3& n, const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  return n.dot(pose_a.p + pose_a.R * support(a, -(pose_a.R.transpose() * n)) - pose_b.p -
               pose_b.R * support(b, pose_b.R.transpose() * n));
}

}  // namespace

// Two plates lie across each other and overlap by 2 µm. The upper one is tilted by some µrad, so that a crossing of
// edges separates them further than any face does. Corners of the square where they meet must stay contact points, with
// the gap of the plane through the upper face; the crossing has the exact normal of its edges.
BOOST_AUTO_TEST_CASE(plates_across_each_other_touch_at_four_corners_however_little_they_are_tilted) {
  const Box lower{{0.4, 0.1, 0.04}}, upper{{0.1, 0.4, 0.04}};
  int crossings = 0;
  for (const double tilt : {1e-7, 1e-5, 1e-3, 5e-3}) {
    for (const double share : {-1.0, 0.3, 1.0}) {
      const Vec3 turn(tilt, share * tilt, 0);
      const Mat3 R = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
      const Pose a{Vec3(0, 0, 0.04 - 2e-6), R}, b{};
      for (const bool is_hull : {false, true}) {
        Manifold points;
        collide(is_hull ? Shape(hull_of_box(upper.size)) : Shape(upper), a, lower, b, points);
        BOOST_TEST_CONTEXT(tilt << " rad, hull " << is_hull) {
          BOOST_TEST_REQUIRE(points.size() == 4);
          for (const ManifoldPoint& point : points) {
            // The tilt moves the face by itself times half the plate's height, and kOutside is a share of 1e-6.
            const double aside = 1.1 * tilt * 0.02 + 1e-6;
            BOOST_TEST(std::abs(std::abs(point.point.x()) - 0.05) < aside);
            BOOST_TEST(std::abs(std::abs(point.point.y()) - 0.05) < aside);
            // Where the upper plate's face lies over the lower one's, along z; the normals differ by the tilt.
            const Vec3 n = R.col(2), on_face = a.p - 0.02 * n;
            const double z =
                on_face.z() -
                (n.x() * (point.point.x() - on_face.x()) + n.y() * (point.point.y() - on_face.y())) / n.z();
            BOOST_TEST(std::abs(point.gap - (z - 0.02)) < 2 * tilt * (tilt * 0.2 + 2e-6) + 1e-15);
            crossings += point.normal.cross(Vec3::UnitZ()).norm() > 0 && point.normal.cross(n).norm() > 1e-3 * tilt;
          }
        }
      }
    }
  }
  BOOST_TEST(crossings > 0);  // the case is there
}

// The same points of contact, whichever of the two algorithms finds them.
BOOST_AUTO_TEST_CASE(a_box_and_its_hull_touch_alike) {
  PairRandom random(3);
  const Box box{{0.5, 0.7, 0.9}}, other{{0.6, 0.4, 0.8}};
  const Shape shapes[] = {other, Sphere{0.3}, Capsule{0.2, 0.8}, Plane{Vec3(1, 2, 3).normalized(), 0.1}};
  Manifold of_box, of_hull;
  for (const Shape& shape : shapes) {
    for (int round = 0; round < 300; ++round) {
      const Pose a = random.pose(0.4), b = random.pose(0.4);
      collide(box, a, shape, b, of_box);
      collide(hull_of_box(box.size), a, shape, b, of_hull);
      BOOST_TEST(of_box.size() == of_hull.size(), shape_name(shape));
      BOOST_TEST(std::abs(nearest_of(of_box).gap - nearest_of(of_hull).gap) < 1e-12, shape_name(shape));
      BOOST_TEST((nearest_of(of_box).normal - nearest_of(of_hull).normal).norm() < 1e-9, shape_name(shape));
      // A capsule's axis that passes through a box touches all along itself.
      if (std::holds_alternative<Capsule>(shape) && nearest_of(of_box).gap < -0.2) continue;
      BOOST_TEST((nearest_of(of_box).point - nearest_of(of_hull).point).norm() < 1e-5, shape_name(shape));
    }
  }
}

// `impulse` numbers the corners of a box by axes that a mirror mirrors. The faces are the same.
BOOST_AUTO_TEST_CASE(a_box_of_mirrored_axes_touches_with_its_whole_face) {
  const Shape box = Box{{0.4, 0.4, 0.2}};
  for (const Shape& below : {Shape(hull_of_box({1, 1, 0.2})), Shape(Cylinder{0.5, 0.2}),
                             Shape(Mesh{{closed_surface(scaled(unit_cube(), Vec3(0.3, 0.3, 0.2)))}})}) {
    for (int mirrored = 0; mirrored < 8; ++mirrored) {
      const Vec3 signs(mirrored & 1 ? -1 : 1, mirrored & 2 ? -1 : 1, mirrored & 4 ? -1 : 1);
      Manifold points;
      collide(box, Pose{{0, 0, 0.2}, signs.asDiagonal()}, below, Pose(), points);
      const auto touching = std::count_if(points.begin(), points.end(), [](const auto& p) { return p.gap < 1e-12; });
      BOOST_TEST(touching >= 4, shape_name(below) << " " << mirrored << ": " << touching);
    }
  }
}

// Overlaps are exact; a gap of two polyhedra apart is that along the best axis, never more than the distance.
BOOST_AUTO_TEST_CASE(gaps_are_those_by_support_functions) {
  PairRandom random(5);
  const std::vector<Shape> shapes = {rock(1),
                                     rock(2),
                                     stretched(rock(3), {0.1, 0.15, 1.2}),  // a needle
                                     stretched(rock(4), {1, 0.8, 0.05}),    // a plate
                                     tetrahedron(),
                                     Box{{0.5, 0.7, 0.9}},
                                     Sphere{0.3},
                                     Capsule{0.2, 0.8},
                                     Cylinder{0.3, 0.7},
                                     Ellipsoid{{0.2, 0.35, 0.5}}};
  Manifold points;
  for (const Shape& a : shapes) {
    for (const Shape& b : shapes) {
      const bool both_flat = is_polyhedron(a) && is_polyhedron(b);
      // Both algorithms of convex_distance() end at about 1e-9 for round shapes, and at a few roundings for flat ones.
      for (int round = 0; round < 60; ++round) {
        const Pose pose_a = random.pose(0.35), pose_b = random.pose(0.35);
        const double truth = convex_distance(a, pose_a, b, pose_b).gap;
        collide(a, pose_a, b, pose_b, points);
        BOOST_REQUIRE(points.size() > 0);
        const double gap = nearest_of(points).gap;
        BOOST_TEST_CONTEXT(shape_name(a) << "-" << shape_name(b) << " " << gap << " " << truth) {
          // A deep overlap with a curved shape may be found along a longer way. contact=impulse gives up before that.
          const double smaller = std::min(inradius(a), inradius(b));
          if (truth < -0.2 * smaller && (is_curved(a) || is_curved(b)))
            BOOST_TEST(separation_along(nearest_of(points).normal, a, pose_a, b, pose_b) < truth + 1e-6);
          else if (truth > 0 && both_flat)
            BOOST_TEST((gap > 0 && gap <= truth + 1e-9));
          else if (truth > 0 || !both_flat)
            // Points of a flat end leave out what is 1e-5 of its width deeper.
            BOOST_TEST(std::abs(gap - truth) < 1e-5);
          else  // a face axis is taken in place of an edge axis that is up to 1e-5 inradii better
            BOOST_TEST(std::abs(separation_along(nearest_of(points).normal, a, pose_a, b, pose_b) - truth) < 5e-6);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(moving_by_the_gap_along_the_normal_makes_them_touch) {
  PairRandom random(7);
  const std::vector<Shape> shapes = {rock(1), Cylinder{0.3, 0.7}, Ellipsoid{{0.2, 0.35, 0.5}}};
  const std::vector<Shape> others = {rock(2), Sphere{0.3}, Plane{Vec3(1, 2, 3).normalized(), 0.1}};
  Manifold points;
  for (const Shape& a : shapes) {
    for (const Shape& b : others) {
      if (!std::holds_alternative<Convex>(a) && std::holds_alternative<Convex>(b)) continue;  // no closed form
      for (int round = 0; round < 100; ++round) {
        Pose pose_a = random.pose(0.4);
        const Pose pose_b = random.pose(0.4);
        collide(a, pose_a, b, pose_b, points);
        const ManifoldPoint nearest = nearest_of(points);
        BOOST_TEST(std::abs(nearest.normal.norm() - 1) < 1e-12);
        if (nearest.gap > 0 && std::holds_alternative<Convex>(a) && std::holds_alternative<Convex>(b)) continue;
        pose_a.p -= nearest.gap * nearest.normal;
        collide(a, pose_a, b, pose_b, points);
        BOOST_TEST(std::abs(nearest_of(points).gap) < 1e-9, shape_name(a) << "-" << shape_name(b));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_standing_cylinder_has_four_points_and_a_lying_one_two) {
  Manifold points;
  const Plane ground{Vec3::UnitZ(), 0};
  const auto count = [&](double most) {
    return std::count_if(points.begin(), points.end(), [=](const auto& point) { return point.gap < most; });
  };
  collide(Cylinder{0.3, 0.8}, Pose{{0, 0, 0.4}, Mat3::Identity()}, ground, Pose(), points);
  BOOST_TEST(count(1e-12) == 4);
  const Mat3 lying = rotation_by(Vec3(0.5 * std::acos(-1.0), 0, 0)).toRotationMatrix();
  collide(Cylinder{0.3, 0.8}, Pose{{0, 0, 0.3}, lying}, ground, Pose(), points);
  BOOST_TEST(count(1e-12) == 2);
}

BOOST_AUTO_TEST_CASE(a_compound_touches_with_each_of_its_parts) {
  const Compound table{{{Box{{2, 2, 0.1}}, {{0, 0, 0.55}, Quat::Identity()}},
                        {Box{{0.1, 0.1, 1}}, {{0.9, 0.9, 0}, Quat::Identity()}},
                        {Box{{0.1, 0.1, 1}}, {{-0.9, 0.9, 0}, Quat::Identity()}},
                        {Box{{0.1, 0.1, 1}}, {{0.9, -0.9, 0}, Quat::Identity()}},
                        {Box{{0.1, 0.1, 1}}, {{-0.9, -0.9, 0}, Quat::Identity()}}}};
  Manifold points, swapped;
  collide(table, Pose{{0, 0, 0.5}, Mat3::Identity()}, Plane{Vec3::UnitZ(), 0}, Pose(), points);
  int touching[5] = {};
  for (const ManifoldPoint& point : points) touching[point.part_a] += std::abs(point.gap) < 1e-12;
  for (int leg = 1; leg < 5; ++leg) BOOST_TEST(touching[leg] == 4);
  collide(Plane{Vec3::UnitZ(), 0}, Pose(), table, Pose{{0, 0, 0.5}, Mat3::Identity()}, swapped);
  BOOST_TEST(swapped.size() == points.size());
  BOOST_TEST(swapped[0].part_b == points[0].part_a);
  // Of a compound of one part, centred, the points are those of the part.
  PairRandom random(2);
  const Box box{{0.5, 0.7, 0.9}};
  for (int round = 0; round < 20; ++round) {
    const Pose a = random.pose(0.4), b = random.pose(0.4);
    collide(Compound{{{box, {}}}}, a, rock(3), b, points);
    collide(box, a, rock(3), b, swapped);
    BOOST_TEST(points.size() == swapped.size());
    BOOST_TEST(points[0].gap == swapped[0].gap);
  }
}

// The least gap of shapes that overlap is the shortest way that parts them, by their supports alone. A flat end that is
// tilted against that way by less than kNearlyFlat counts along its own normal. That is seldom longer by 1e-4 m.
BOOST_AUTO_TEST_CASE(random_shapes_overlap_as_deep_as_their_supports_say) {
  constexpr int kPairs = 20000;
  test::RandomPoses random(2);
  test::AnyShape any_shape(random);
  Manifold points;
  int overlapping = 0;
  for (int k = 0; k < kPairs; ++k) {
    const Shape a = any_shape(), b = any_shape();
    const double small = std::min(inradius(a), inradius(b));
    Pose pose_a{random.vector(0.8), random.turn()};
    const Pose pose_b{random.vector(0.2), random.turn()};
    const ConvexGap first = convex_distance(a, pose_a, b, pose_b);
    pose_a.p -= (first.gap + 0.01 * small * random.between(0, 1)) * first.normal;
    const double expected = convex_distance(a, pose_a, b, pose_b).gap;
    if (!(expected <= 0 && expected > -0.02 * small)) continue;
    ++overlapping;
    collide(a, pose_a, b, pose_b, points);
    double least = std::numeric_limits<double>::infinity();
    for (const ManifoldPoint& point : points) least = std::min(least, point.gap);
    BOOST_TEST(std::abs(least - expected) < 1e-4,
               k << ": " << shape_name(a) << "-" << shape_name(b) << " " << expected << " " << least);
  }
  BOOST_TEST(overlapping > kPairs / 2);
}

BOOST_AUTO_TEST_SUITE_END()
