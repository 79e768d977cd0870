// Each shape's volume, centre and inertia against a lattice, and hulls against closed forms.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "core/scene/shapes/mesh_file.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_shapes)

namespace {

bool is_inside(const Shape& shape, const Vec3& p) {
  return std::visit(
      ForShapes{
          [&](const Box& b) { return (p.cwiseAbs().array() <= 0.5 * b.size.array()).all(); },
          [&](const Capsule& c) {
            return (p - Vec3(0, 0, std::clamp(p.z(), -0.5 * c.length, 0.5 * c.length))).norm() <= c.radius;
          },
          [&](const Compound& c) {
            return std::any_of(c.parts.begin(), c.parts.end(), [&](const PlacedShape& part) {
              return is_inside(part.shape, part.pose.orientation.conjugate() * (p - part.pose.position));
            });
          },
          [&](const Convex& c) {
            return std::all_of(c.hull->faces.begin(), c.hull->faces.end(),
                               [&](const Hull::Face& face) { return face.normal.dot(p) <= face.offset; });
          },
          [&](const Cylinder& c) { return std::hypot(p.x(), p.y()) <= c.radius && std::abs(p.z()) <= 0.5 * c.length; },
          [&](const Ellipsoid& e) { return p.cwiseQuotient(e.radii).norm() <= 1; },
          [&](const SurfaceShape&) { return false; },  // see surface_test.cpp
          [&](const Plane& plane) { return plane.normal.dot(p) <= plane.offset; },
          [&](const Sphere& s) { return p.norm() <= s.radius; }},
      shape);
}

std::vector<Vec3> corners_of_box(const Vec3& size) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.push_back(size.cwiseProduct(Vec3(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5)));
  return corners;
}

std::vector<Vec3> random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int k = 0; k < count; ++k)
    points.push_back(Vec3(0.2, -0.1, 0.3) + Vec3(normal(random), normal(random), normal(random)).normalized());
  return points;
}

std::vector<Shape> all_solids() {
  const Quat turn = rotation_by(Vec3(0.3, -0.8, 0.5));
  return {Box{{0.5, 2, 1.1}},
          Capsule{0.6, 1.5},
          Compound{{{Box{{1, 0.4, 0.5}}, {{-0.6, 0.3, 0.2}, turn}}, {Cylinder{0.4, 0.7}, {{0.7, -0.2, 0.4}, turn}}}},
          Convex{hull_of(random_points(32, 1))},
          Cylinder{0.7, 1.6},
          Ellipsoid{{0.5, 1.3, 0.9}},
          Sphere{1.2}};
}

std::string refusal(const std::vector<Vec3>& points) {
  try {
    hull_of(points);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string mesh_refusal(const std::string& text, const std::string& name) {
  try {
    parse_mesh(text, name);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

// A second derivation: means over points spread evenly through a cube (Roberts, The unreasonable effectiveness of
// quasirandom sequences, 2018). Of a million points the means are off by up to two in a thousand.
BOOST_AUTO_TEST_CASE(volume_centre_and_inertia_are_those_of_many_points) {
  constexpr int kPoints = 1'000'000;
  constexpr double kEdge = 3.2;  // m, of the cube
  for (const Shape& shape : all_solids()) {
    double count = 0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (int k = 1; k <= kPoints; ++k) {
      const Vec3 x = k * Vec3(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
      const Vec3 p = kEdge * (x - x.array().floor().matrix() - Vec3::Constant(0.5));
      if (is_inside(shape, p)) ++count, first += p, second += p * p.transpose();
    }
    const Vec3 centre = first / count;
    const Mat3 spread = second / count - centre * centre.transpose();
    const Mat3 inertia = inertia_of(shape, 7);
    BOOST_TEST_CONTEXT(shape_name(shape)) {
      BOOST_TEST(volume_of(shape) == count / kPoints * kEdge * kEdge * kEdge, boost::test_tools::tolerance(3e-3));
      BOOST_TEST((centre_of(shape) - centre).norm() < 3e-3);
      BOOST_TEST((7 * (spread.trace() * Mat3::Identity() - spread) - inertia).norm() < 6e-3 * inertia.norm());
    }
  }
}

// The point furthest along n has every point of the drawing behind it, and lies within the bounding radius.
BOOST_AUTO_TEST_CASE(support_and_drawing_belong_to_the_same_shape) {
  for (const Shape& shape : all_solids()) {
    const TriangleMesh mesh = drawn_mesh(shape);
    BOOST_TEST(mesh.corners.size() >= 12u);
    for (const Vec3& n : random_points(50, 3)) {
      const Vec3 at = support(shape, n);
      BOOST_TEST(at.norm() <= bounding_radius(shape) * (1 + 1e-12), shape_name(shape));
      for (const Vec3& point : mesh.points) BOOST_TEST(n.dot(point) <= n.dot(at) + 1e-12, shape_name(shape));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_hull_of_a_cuboid_is_the_cuboid) {
  const Vec3 size(0.3, 0.5, 0.8);
  std::vector<Vec3> points = corners_of_box(size);
  points.push_back(Vec3(0.01, 0.02, -0.1)), points.push_back(points[3]);  // inside, and twice the same
  const Convex convex{hull_of(points)};
  BOOST_TEST(convex.hull->points.size() == 8u);
  BOOST_TEST(convex.hull->faces.size() == 6u);
  BOOST_TEST(convex.hull->edges.size() == 12u);
  BOOST_TEST(convex.volume() == size.prod(), boost::test_tools::tolerance(1e-14));
  BOOST_TEST(convex.centre().norm() < 1e-16);
  BOOST_TEST((convex.inertia(3) - Box{size}.inertia(3)).norm() < 1e-15);
  BOOST_TEST(convex.inradius() == 0.15, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(convex.bounding_radius() == 0.5 * size.norm(), boost::test_tools::tolerance(1e-14));
}

// A right-angled tetrahedron with legs a, b, c along the axes: volume abc/6, centre (a, b, c)/4, and the second moment
// about its corner has a²V/10 on the diagonal and abV/20 beside it.
BOOST_AUTO_TEST_CASE(a_tetrahedron_has_its_closed_form) {
  const double a = 0.5, b = 0.7, c = 1.1, V = a * b * c / 6;
  const Convex convex{hull_of({{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}})};
  const Vec3 legs(a, b, c);
  Mat3 about_corner = V / 20 * legs * legs.transpose();
  about_corner.diagonal() *= 2;
  const Mat3 spread = about_corner - V / 16 * legs * legs.transpose();
  BOOST_TEST(convex.volume() == V, boost::test_tools::tolerance(1e-14));
  BOOST_TEST((convex.centre() - legs / 4).norm() < 1e-15);
  BOOST_TEST((convex.inertia(V) - (spread.trace() * Mat3::Identity() - spread)).norm() < 1e-15);
}

BOOST_AUTO_TEST_CASE(a_hull_is_a_closed_polyhedron_around_its_points) {
  const std::vector<Vec3> points = random_points(200, 9);
  const std::shared_ptr<const Hull> kept = hull_of(points);
  const Hull& hull = *kept;
  BOOST_TEST(hull.points.size() - hull.edges.size() + hull.faces.size() == 2u);  // Euler
  for (const Hull::Face& face : hull.faces) {
    BOOST_TEST(face.corners.size() == face.edges.size());
    for (const Vec3& point : points) BOOST_TEST(face.normal.dot(point) <= face.offset + 1e-14);
  }
  for (const Hull::Edge& edge : hull.edges) {
    const Vec3 along = hull.points[edge.to] - hull.points[edge.from];
    // Anticlockwise faces: the cross product of the normals looks along the edge.
    BOOST_TEST(hull.faces[edge.left].normal.cross(hull.faces[edge.right].normal).dot(along) >= 0);
  }
}

BOOST_AUTO_TEST_CASE(a_scaled_shape_is_similar) {
  for (const Shape& shape : all_solids()) {
    const Shape larger = scaled_shape(shape, 3);
    BOOST_TEST_CONTEXT(shape_name(shape)) {
      BOOST_TEST(volume_of(larger) == 27 * volume_of(shape), boost::test_tools::tolerance(1e-13));
      BOOST_TEST((centre_of(larger) - 3 * centre_of(shape)).norm() < 1e-14);
      BOOST_TEST((inertia_of(larger, 2) - 9 * inertia_of(shape, 2)).norm() < 1e-12);
      BOOST_TEST(bounding_radius(larger) == 3 * bounding_radius(shape), boost::test_tools::tolerance(1e-14));
    }
  }
  const std::shared_ptr<const Hull> kept = hull_of(random_points(20, 4));
  const Hull& hull = *kept;
  const Vec3 mirror(-1, 1, 1);
  BOOST_TEST((mirrored_hull(hull)->centre - mirror.cwiseProduct(hull.centre)).norm() < 1e-14);
  BOOST_TEST(mirrored_hull(hull)->volume == hull.volume, boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_CASE(points_without_a_hull_are_refused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(refusal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).find("3 points") != std::string::npos);
  BOOST_TEST(refusal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}).find("one plane") != std::string::npos);
  BOOST_TEST(refusal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-14}}).find("one plane") != std::string::npos);
  BOOST_TEST(refusal({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).find("one plane") != std::string::npos);
  BOOST_TEST(refusal(std::vector<Vec3>(9, Vec3::Ones())).find("one plane") != std::string::npos);
  BOOST_TEST(refusal({{0, 0, 0}, {1, 0, 0}, {0, nan, 0}, {0, 0, 1}}).find("not finite") != std::string::npos);
  BOOST_TEST(refusal(std::vector<Vec3>(Hull::kMostPoints + 1)).find("at most 200000") != std::string::npos);
  BOOST_TEST(refusal(random_points(3000, 5)).find("3000 corners; allowed: at most 2000") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(obj_and_stl_files_are_read) {
  const MeshFile obj = parse_mesh("# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0 # last\nv 0 1 0\nf 1/1 2//3 3 -1\n", "a.OBJ");
  BOOST_TEST(obj.points.size() == 4u);
  BOOST_TEST((obj.triangles == std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
  const std::string facet =
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid";
  BOOST_TEST((parse_mesh(facet, "a.stl").triangles == std::vector<std::array<int, 3>>{{0, 1, 2}}));
  std::string binary(84 + 50, '\0');
  binary[80] = 1;
  const float x = 2;
  std::memcpy(binary.data() + 84 + 24, &x, 4);  // the second corner's x
  BOOST_TEST((parse_mesh(binary, "a.stl").points[1] == Vec3(2, 0, 0)));
}

BOOST_AUTO_TEST_CASE(a_broken_mesh_file_is_refused_with_its_line) {
  BOOST_TEST(mesh_refusal("v 0 0\n", "a.obj").starts_with("a.obj:1: found fewer than three"));
  BOOST_TEST(mesh_refusal("v 0 0 0\nv 0 0 nan\n", "a.obj").starts_with("a.obj:2: found 'nan'"));
  BOOST_TEST(mesh_refusal("v 0 0 0\nf 1 2 3\n", "a.obj").starts_with("a.obj:2: found the corner '2'"));
  BOOST_TEST(mesh_refusal("v 0 0 0\nf 1 1\n", "a.obj").starts_with("a.obj:2: found a face"));
  BOOST_TEST(mesh_refusal("hello", "a.obj").starts_with("a.obj: found no point"));
  BOOST_TEST(mesh_refusal("vertex 0 0 0\nendloop\n", "a.stl").starts_with("a.stl:2: found a facet"));
  BOOST_TEST(mesh_refusal("x", "a.ply").find("allowed: .obj and .stl") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_file_may_not_leave_the_case_s_folder) {
  BOOST_TEST(path_beside("/cases/a/case.toml", "rock.stl") == "/cases/a/rock.stl");
  BOOST_TEST(path_beside("/cases/a/case.toml", "shapes/../rock.stl") == "/cases/a/rock.stl");
  for (const char* outside : {"../rock.stl", "/etc/passwd", "shapes/../../b/rock.stl"})
    BOOST_CHECK_THROW(path_beside("/cases/a/case.toml", outside), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
