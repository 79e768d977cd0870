// Surfaces of triangles: what follows from them, against a box; and meshes and heights that are none.
#include "core/scene/shapes/surface.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/error.h"
#include "core/scene/shape_types.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_surface)

namespace {

struct Triangles {
  std::vector<Vec3> points;
  std::vector<Corners> corners;
};

Triangles triangles_of(const TriangleMesh& mesh, const Vec3& scale) {
  Triangles made;
  for (const Vec3& point : mesh.points) made.points.push_back(point.cwiseProduct(scale));
  for (std::size_t k = 0; k < mesh.corners.size(); k += 3)
    made.corners.push_back({mesh.corners[k], mesh.corners[k + 1], mesh.corners[k + 2]});
  return made;
}

std::shared_ptr<const TriangleSurface> surface_of(const Triangles& given) {
  return closed_surface(given.points, given.corners);
}

std::string refusal_of(const Triangles& given) {
  try {
    surface_of(given);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string refusal_of(const std::vector<std::vector<double>>& heights) {
  try {
    height_surface({1, 1}, heights);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::shared_ptr<const TriangleSurface> waves() {
  std::vector<std::vector<double>> heights(30, std::vector<double>(20));
  for (std::size_t i = 0; i < 30; ++i)
    for (std::size_t k = 0; k < 20; ++k)
      heights[i][k] = std::sin(0.7 * static_cast<double>(i)) + 0.1 * static_cast<double>(k);
  return height_surface({3, 4}, heights);
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_mesh_of_a_box_has_its_volume_and_moments_edges_and_corners) {
  const Vec3 size(0.4, 1.1, 0.7);
  const auto surface = surface_of(triangles_of(unit_cube(), size));  // six faces with corners of their own
  BOOST_TEST(surface->points.size() == 8u);
  BOOST_TEST(surface->ridges.size() == 12u);  // no diagonal of a face
  BOOST_TEST(surface->peaks.size() == 8u);
  std::set<int> patches;
  for (const auto& triangle : surface->triangles) patches.insert(triangle.patch);
  BOOST_TEST(patches.size() == 6u);
  const Box box{size};
  BOOST_TEST(std::abs(surface->volume - box.volume()) < 1e-15);
  BOOST_TEST((Mesh{{surface}}.inertia(3) - box.inertia(3)).norm() < 1e-15);
  BOOST_TEST(surface->centre.norm() < 1e-15);
}

BOOST_AUTO_TEST_CASE(a_search_finds_the_triangles_that_a_look_at_all_finds) {
  const auto surface = waves();
  for (int k = 0; k < 50; ++k) {
    const Vec3 low(0.02 * k - 0.6, 0.03 * k - 1, 0.5 - 0.04 * k), high = low + Vec3(0.1, 0.3, 0.2);
    std::vector<int> found, expected;
    surface->find_near(low, high, found);
    for (std::size_t t = 0; t < surface->triangles.size(); ++t) {
      Vec3 least = Vec3::Constant(10), most = -least;
      for (const int corner : surface->triangles[t].corners) {
        least = least.cwiseMin(surface->points[static_cast<std::size_t>(corner)]);
        most = most.cwiseMax(surface->points[static_cast<std::size_t>(corner)]);
      }
      if ((least.array() <= high.array()).all() && (low.array() <= most.array()).all())
        expected.push_back(static_cast<int>(t));
    }
    std::sort(found.begin(), found.end());
    BOOST_TEST(found == expected);
  }
}

BOOST_AUTO_TEST_CASE(the_nearest_point_is_that_of_the_nearest_triangle) {
  const auto surface = waves();
  for (int k = 0; k < 200; ++k) {
    const Vec3 p(std::sin(1.3 * k) * 2.5, std::cos(2.1 * k) * 2.5, std::sin(0.7 * k) * 3 + 1);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& triangle : surface->triangles)
      least = std::min(least, (surface->nearest_on(triangle, p) - p).norm());
    BOOST_TEST((surface->nearest(p, 100) - p).norm() == least, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(std::isinf(surface->nearest(p, 0.99 * least).x()));
    // No point of the triangles' edges is nearer, nor one of their middles.
    for (const auto& triangle : surface->triangles) {
      const auto corner = [&](std::size_t i) { return surface->points[static_cast<std::size_t>(triangle.corners[i])]; };
      for (const double share : {0.0, 0.3, 0.6})
        BOOST_TEST_REQUIRE(((1 - share) * corner(0) + share * (0.5 * corner(1) + 0.5 * corner(2)) - p).norm() >
                           least - 1e-12);
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_closed_mesh_is_refused_with_its_triangle) {
  const Triangles cube = triangles_of(unit_cube(), Vec3::Ones());
  Triangles open = cube;
  open.corners.pop_back();
  BOOST_TEST(says(refusal_of(open), "the mesh is open there"));
  Triangles inwards = cube;
  for (Corners& corners : inwards.corners) std::swap(corners[0], corners[1]);
  BOOST_TEST(says(refusal_of(inwards), "look inwards"));
  Triangles flat = cube;
  for (Vec3& point : flat.points) point.z() = 0;
  BOOST_TEST(says(refusal_of(flat), "has no area"));  // its sides
  const std::vector<Vec3> three = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  BOOST_TEST(says(refusal_of({three, {{0, 1, 2}, {0, 2, 1}}}), "encloses no volume"));
  Triangles twice = cube;
  twice.corners.push_back(twice.corners.front());
  BOOST_TEST(says(refusal_of(twice), "triangle 13 has an edge that another one passes, too"));
  Triangles wrong = cube;
  wrong.corners[4][1] = 24;
  BOOST_TEST(says(refusal_of(wrong), "triangle 5 has corner 24; allowed: 0 to 23"));
  Triangles nowhere = cube;
  nowhere.points[3].y() = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(says(refusal_of(nowhere), "not finite"));
  // Two cubes, of which one stands in the other's side.
  Triangles crossed = cube;
  for (const Vec3& point : cube.points) crossed.points.push_back(point + Vec3(0.6, 0.3, 0.2));
  for (const Corners& corners : cube.corners)
    crossed.corners.push_back({corners[0] + 24, corners[1] + 24, corners[2] + 24});
  BOOST_TEST(says(refusal_of(crossed), "cut each other"));
  // A corner drawn through the opposite side.
  Triangles turned_out = cube;
  for (Vec3& point : turned_out.points)
    if (point.x() > 0 && point.y() > 0 && point.z() > 0) point = Vec3(-0.8, -0.1, -0.2);
  BOOST_TEST(says(refusal_of(turned_out), "cut each other"));
  BOOST_TEST(
      says(refusal_of(Triangles{cube.points, std::vector<Corners>(TriangleSurface::kMostTriangles + 1, {0, 1, 2})}),
           "allowed: 1 to 200000"));
}

BOOST_AUTO_TEST_CASE(heights_are_rows_of_one_length) {
  BOOST_TEST(refusal_of({{0, 0}, {0, 1}}) == "");
  BOOST_TEST(says(refusal_of({{0, 0, 1}}), "found 1 by 3 heights"));
  BOOST_TEST(says(refusal_of({{0, 0, 1}, {0, 0}}), "row 2 has 2 heights, and row 1 has 3"));
  BOOST_TEST(says(refusal_of({{0, 0}, {0, std::numeric_limits<double>::infinity()}}), "not finite"));
}

BOOST_AUTO_TEST_CASE(a_ridge_of_heights_sticks_out_and_a_valley_does_not) {
  const auto ridge = height_surface({2, 1}, {{0, 1, 0}, {0, 1, 0}}),
             valley = height_surface({2, 1}, {{1, 0, 1}, {1, 0, 1}});
  BOOST_TEST(ridge->ridges.size() == 1u);
  BOOST_TEST(ridge->peaks.size() == 2u);
  BOOST_TEST(valley->ridges.empty());
  BOOST_TEST(valley->peaks.empty());
  BOOST_TEST(
      std::all_of(ridge->triangles.begin(), ridge->triangles.end(), [](const auto& t) { return t.normal.z() > 0; }));
}

BOOST_AUTO_TEST_SUITE_END()
