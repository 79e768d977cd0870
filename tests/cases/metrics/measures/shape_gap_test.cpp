// The judge's geometry against a second derivation: surfaces sampled as points, and poses whose gap is plain.
#include "cases/metrics/measures/shape_gap.h"

#include <boost/test/unit_test.hpp>
#include <numbers>
#include <random>
#include <set>

#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_shape_gap)

namespace {

std::mt19937 random_numbers(7);
double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_numbers); }
Vec3 random_vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
BodyPose random_pose(double size) { return {random_vector(size), rotation_by(random_vector(3))}; }

// Minkowski: two convex bodies are as far apart as the least of |x - y|; found by alternating projections onto each.
Vec3 projected(const Shape& shape, const BodyPose& pose, const Vec3& point) {
  const Vec3 p = pose.orientation.conjugate() * (point - pose.position);
  Vec3 near;
  if (const auto* box = std::get_if<Box>(&shape)) {
    near = p.cwiseMax(-box->size / 2).cwiseMin(box->size / 2);
  } else {
    const auto* c = std::get_if<Capsule>(&shape);
    const Vec3 core(0, 0, c ? std::clamp(p.z(), -c->length / 2, c->length / 2) : 0);
    const double radius = c ? c->radius : std::get<Sphere>(shape).radius;
    near = (p - core).norm() > radius ? Vec3(core + radius * (p - core).normalized()) : p;
  }
  return pose.position + pose.orientation * near;
}
double distance_by_projections(const Shape& a, const BodyPose& pose_a, const Shape& b, const BodyPose& pose_b) {
  Vec3 x = pose_a.position, y = pose_b.position;
  for (int n = 0; n < 20000; ++n) x = projected(a, pose_a, y), y = projected(b, pose_b, x);
  return (x - y).norm();
}

const Shape kShapes[] = {Sphere{0.4}, Box{{0.6, 0.9, 1.3}}, Capsule{0.3, 1.1}};

}  // namespace

BOOST_AUTO_TEST_CASE(bodies_apart_are_as_far_as_alternating_projections_say) {
  int checked = 0;
  for (const Shape& a : kShapes) {
    for (const Shape& b : kShapes) {
      const bool are_boxes = std::holds_alternative<Box>(a) && std::holds_alternative<Box>(b);
      for (int n = 0; n < 20; ++n) {
        const BodyPose pose_a = random_pose(2), pose_b = random_pose(2);
        const double expected = distance_by_projections(a, pose_a, b, pose_b);
        if (expected < 0.05) continue;
        const double found = shape_gap(a, pose_a, b, pose_b);
        BOOST_TEST_CONTEXT(shape_name(a) << " and " << shape_name(b)) {
          // The projections end where a step no longer moves them: they close the last of a wedge slowly.
          BOOST_TEST(found < expected + 1e-6);
          if (are_boxes)
            BOOST_TEST(found > 0);
          else
            BOOST_TEST(found > expected - 1e-4);
        }
        ++checked;
      }
    }
  }
  BOOST_TEST(checked > 100);
}

BOOST_AUTO_TEST_CASE(moved_by_its_depth_an_overlap_is_gone_and_by_less_it_is_not) {
  int checked = 0;
  for (const Shape& a : kShapes) {
    for (const Shape& b : kShapes) {
      for (int n = 0; n < 20; ++n) {
        const BodyPose pose_a = random_pose(0.3), pose_b = random_pose(0.3);
        const double depth = -shape_gap(a, pose_a, b, pose_b);
        if (depth < 0.05) continue;
        double by_less = 1e9, by_more = 1e9;
        for (int k = 0; k < 2000; ++k) {  // ways to part them: one of them is within 0.1 rad of the best
          const Vec3 way = random_vector(1).normalized();
          const auto left = [&](double share) {
            return -shape_gap(a, pose_a, b, {pose_b.position + share * depth * way, pose_b.orientation});
          };
          by_less = std::min(by_less, left(0.999)), by_more = std::min(by_more, left(1.05));
        }
        const bool is_rod_in_box = a.index() + b.index() == Shape(Box{}).index() + Shape(Capsule{}).index();
        BOOST_TEST_CONTEXT(shape_name(a) << " and " << shape_name(b)) {
          BOOST_TEST(by_less > 0);
          if (a.index() == b.index() || !is_rod_in_box) BOOST_TEST(by_more < 0.01 * depth);
        }
        ++checked;
      }
    }
  }
  BOOST_TEST(checked > 100);
}

BOOST_AUTO_TEST_CASE(plain_poses_have_plain_gaps) {
  const auto at = [](double x, double y, double z) { return BodyPose{{x, y, z}, Quat::Identity()}; };
  const Quat on_side = rotation_by({0, std::numbers::pi / 2, 0});
  const Box box{{1, 1, 1}};
  BOOST_TEST(shape_gap(box, at(0, 0, 0), box, at(0, 0, 0.9)) == -0.1, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(shape_gap(box, at(0, 0, 0), box, at(0.3, 0.2, 1.25)) == 0.25, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(shape_gap(box, at(0, 0, 0), Sphere{0.5}, at(0, 0, 0.8)) == -0.2, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(shape_gap(Sphere{0.5}, at(0, 0, 0.1), box, at(0, 0, 0)) == -0.9, boost::test_tools::tolerance(1e-13));
  const Capsule rod{0.1, 2};
  BOOST_TEST(shape_gap(rod, at(0, 0, 0), rod, {{0, 0.5, 0}, on_side}) == 0.3, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(shape_gap(rod, at(0, 0, 0), rod, at(0, 0, 2.5)) == 0.3, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(shape_gap(rod, {{0, 0, 0.7}, on_side}, box, at(0, 0, 0)) == 0.1, boost::test_tools::tolerance(1e-12));
  const Plane plane{Vec3(0, 0, 1), 2};
  BOOST_TEST(shape_gap(plane, {}, rod, at(0, 0, 4)) == 0.9, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(shape_gap(rod, {{0, 0, 4}, on_side}, plane, {}) == 1.9, boost::test_tools::tolerance(1e-13));
  const Quat on_corner = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, 1));
  BOOST_TEST(shape_gap(box, {{0, 0, 3}, on_corner}, plane, {}) == 1 - std::sqrt(3) / 2,
             boost::test_tools::tolerance(1e-13));
}

// Thin shapes side by side: the first of the two algorithms for curved shapes ends near a touch, on either side of it.
BOOST_AUTO_TEST_CASE(a_shallow_overlap_of_curved_shapes_is_no_touch) {
  for (const double gap : {-1e-3, -2e-5, -1e-7, 1e-7, 2e-5}) {
    for (int k = 0; k < 50; ++k) {
      const Quat turn = rotation_by(random_vector(3));
      const double along = uniform(-0.5, 0.5), distance = 0.05 + 0.2 + gap;
      const BodyPose a{random_vector(1), turn}, b{a.position + turn * Vec3(0, distance, along), turn};
      BOOST_TEST(std::abs(shape_gap(Cylinder{0.05, 1.5}, a, Capsule{0.2, 0.8}, b) - gap) < 1e-8);
      BOOST_TEST(std::abs(shape_gap(Cylinder{0.05, 1.5}, a, Cylinder{0.2, 0.8}, b) - gap) < 1e-8);
    }
  }
}

// Two cubes, each on an edge, one across the other: their faces' normals all lean by 45 degrees, the edges' product is
// upright.
BOOST_AUTO_TEST_CASE(crossed_edges_have_a_gap_of_their_own) {
  const Shape box = Box{{1, 1, 1}};
  const BodyPose below{Vec3::Zero(), rotation_by({0.25 * std::numbers::pi, 0, 0})};
  for (const double gap : {0.2, -0.1}) {
    const BodyPose above{{0, 0, std::sqrt(2) + gap}, rotation_by({0, 0.25 * std::numbers::pi, 0})};
    BOOST_TEST(shape_gap(box, below, box, above) == gap, boost::test_tools::tolerance(1e-13));
  }
}

BOOST_AUTO_TEST_CASE(a_pair_that_the_scene_keeps_apart_is_not_looked_at) {
  Scene scene;
  scene.bodies = {test::on_its_own("a", Sphere{1}, 1, Vec3::Zero()), test::on_its_own("b", Sphere{1}, 1, Vec3::Zero())};
  BodyTable table(2);
  const auto pairs = [&] {
    int count = 0;
    for_each_near_pair(scene, table.columns(), 0, [&](int, int, double) { ++count; });
    return count;
  };
  for (int i = 0; i < 2; ++i) table.columns().set_body(i, {});
  BOOST_TEST(pairs() == 1);
  scene.contact_pairs = {{0, 1, kApart}};
  BOOST_TEST(pairs() == 0);
}

BOOST_AUTO_TEST_CASE(every_pair_in_reach_is_found_once) {
  Scene scene;
  BodyTable table(61);
  for (int i = 0; i < 60; ++i) {
    scene.bodies.push_back(test::on_its_own("b" + std::to_string(i), kShapes[i % 3], 1, random_vector(2.5)));
    scene.bodies.back().orientation = rotation_by(random_vector(3));
    scene.bodies.back().fixed = i % 7 == 0;
  }
  scene.bodies.push_back(test::plane());
  for (int i = 0; i < 61; ++i)
    table.columns().set_body(i, {scene.bodies[i].position, scene.bodies[i].orientation, Vec3::Zero(), Vec3::Zero()});
  std::multiset<std::pair<int, int>> found, expected;
  for_each_near_pair(scene, table.columns(), 0.1, [&](int a, int b, double) { found.insert(std::minmax(a, b)); });
  for (int a = 0; a < 61; ++a) {
    for (int b = a + 1; b < 61; ++b) {
      const Body &one = scene.bodies[a], &other = scene.bodies[b];
      if (one.fixed && other.fixed) continue;
      if (shape_gap(*one.shape, {one.position, one.orientation}, *other.shape, {other.position, other.orientation}) <
          0.1)
        expected.insert({a, b});
    }
  }
  BOOST_TEST(expected.size() > 20);
  BOOST_TEST((found == expected));
}

// 2-3-6 has a diagonal of 7.
BOOST_AUTO_TEST_CASE(a_shape_is_within_its_bounding_radius) {
  BOOST_TEST(bounding_radius(Sphere{0.5}) == 0.5);
  BOOST_TEST(bounding_radius(Capsule{0.25, 3}) == 1.75);
  BOOST_TEST(bounding_radius(Box{{2, 3, 6}}) == 3.5, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(std::isinf(bounding_radius(Plane{Vec3::UnitZ(), 0})));
}

// A corner that points at a face, 1 m from it: the face's normal alone is an axis along which they are apart so far.
BOOST_AUTO_TEST_CASE(a_corner_before_a_face_is_as_far_as_the_faces_normal_says) {
  const Shape cube = Box{{1, 1, 1}};
  const BodyPose at_rest{Vec3::Zero(), Quat::Identity()};
  const BodyPose corner{{0.5 + std::sqrt(0.75) + 1, 0, 0}, Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(-1, 0, 0))};
  BOOST_TEST(shape_gap(cube, at_rest, cube, corner) == 1, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(shape_gap(cube, corner, cube, at_rest) == 1, boost::test_tools::tolerance(1e-12));
}

// Crossed like two hairs, 10 µm long, and like two masts.
BOOST_AUTO_TEST_CASE(crossed_rods_of_any_size_are_as_far_as_their_middles) {
  for (const double size : {1e-5, 1e-2, 1.0, 1e3}) {
    const Shape one = Capsule{0.01 * size, size}, other = Capsule{0.02 * size, 3 * size};
    const BodyPose along_z{Vec3::Zero(), Quat::Identity()};
    const BodyPose along_x{{0, 0.5 * size, 0}, Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX())};
    BOOST_TEST(shape_gap(one, along_z, other, along_x) == 0.47 * size, boost::test_tools::tolerance(1e-9));
    BOOST_TEST(shape_gap(other, along_x, one, along_z) == 0.47 * size, boost::test_tools::tolerance(1e-9));
  }
}

// A body that has fallen through the ground is deep in it, however far; beyond the border there is no ground.
BOOST_AUTO_TEST_CASE(what_is_behind_a_surface_is_deep_in_it) {
  Heightfield field;
  field.size = {4, 4}, field.heights = {{0, 0.2, 0}, {0.1, 0, 0.1}, {0, 0.3, 0}};
  field.surface = height_surface(field.size, field.heights);
  const Shape ground = field, ball = Sphere{0.2}, box = Box{{0.3, 0.2, 0.1}};
  const BodyPose at_rest{Vec3::Zero(), Quat::Identity()};
  for (const Shape& shape : {ball, box}) {
    for (const double depth : {0.3, 1.0, 100.0}) {
      const double gap = shape_gap(shape, {{0.1, 0.2, -depth}, Quat::Identity()}, ground, at_rest);
      BOOST_TEST(gap < -0.8 * depth);
      BOOST_TEST(gap == shape_gap(ground, at_rest, shape, {{0.1, 0.2, -depth}, Quat::Identity()}));
    }
    BOOST_TEST(shape_gap(shape, {{3, 0.2, -1}, Quat::Identity()}, ground, at_rest) > 0);
  }
  // Above: the least distance that the ball can have, and near the ground its distance.
  const double far = shape_gap(ball, {{0, 0, 10}, Quat::Identity()}, ground, at_rest);
  BOOST_TEST((far > 9 && far <= 9.8));
  const Shape cube = Mesh{{closed_surface(unit_cube())}};
  for (int k = 0; k < 200; ++k) {
    const Vec3 p = random_vector(0.45);
    const double expected = p.cwiseAbs().maxCoeff() - 0.5 - 0.2;
    BOOST_TEST(shape_gap(ball, {p, Quat::Identity()}, cube, at_rest) == expected, boost::test_tools::tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_SUITE_END()
