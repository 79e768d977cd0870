#include "core/scene/toml/body_reader.h"

#include <fmt/format.h>

#include <boost/test/unit_test.hpp>

#include "tests/core/scene/scene_of.h"
#include "tests/core/scene/toml/refusal.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_toml_body_reader)

namespace {

const std::vector<Refusal> kBadBodies = {
    {"[[scene.body]]\nmass = 1", "1:1: scene.body.name: missing", {}},
    {"[[scene.body]]\nname = ''", "2:8: scene.body.name: ", {"empty string"}},
    {"[[scene.body]]\nname = 'world'\nmass = 1", "2:8: scene.body.name: ", {"the world itself", "any other name"}},
    {"[[scene.body]]\nname = 'a'\nfixed = true\n[[scene.body]]\nname = 'a'\nfixed = true",
     "5:8: scene.body.name: ",
     {"already a body 'a', at s.toml:2:8"}},
    {"[[scene.body]]\nname = 'a'\nmas = 1", "3:1: scene.body.mas: unknown key", {"did you mean 'mass'?"}},
    {"[[scene.body]]\nname = 'a'", "1:1: scene.body.mass: missing", {}},
    {"[[scene.body]]\nname = 'a'\nmass = 0", "3:8: scene.body.mass: ", {"found 0", "greater than 0"}},
    {"[[scene.body]]\nname = 'a'\nmass = -1", "3:8: scene.body.mass: ", {"found -1", "greater than 0"}},
    {"[[scene.body]]\nname = 'a'\nmass = nan", "3:8: scene.body.mass: ", {"found nan"}},
    {"[[scene.body]]\nname = 'a'\nmass = '1'", "3:8: scene.body.mass: ", {"found a string"}},
    {"[[scene.body]]\nname = 'a'\nfixed = true\nmass = 0", "4:8: scene.body.mass: ", {"found 0"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1", "1:1: scene.body: ", {"neither an inertia nor a shape"}},
    {"[[scene.body]]\nname = 'a'\nfixed = 1", "3:9: scene.body.fixed: ", {"found 1", "true or false"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 1]",
     "4:11: scene.body.inertia: ",
     {"2 values", "3 or 6 numbers"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 1, nan]", "4:18: scene.body.inertia[2]: ", {"found nan"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 1, 0]",
     "4:11: scene.body.inertia: ",
     {"0, 1 and 1", "greater than 0"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 1, -1]", "4:11: scene.body.inertia: ", {"greater than 0"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 1, 1, 1, 0, 0]",
     "4:11: scene.body.inertia: ",
     {"greater than 0"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 3, 1]",
     "4:11: scene.body.inertia: ",
     {"1, 1 and 3", "the sum"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 2.0001, 1]", "4:11: scene.body.inertia: ", {"the sum"}},
    // Moments 1, 1 and 3, turned by 45° about z: only the principal ones tell.
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [2, 2, 1, 1, 0, 0]",
     "4:11: scene.body.inertia: ",
     {"1, 1 and 3", "the sum"}},
    {"[[scene.body]]\nname = 'a'\nfixed = true\norientation_wxyz = [0, 0, 0, 0]",
     "4:20: scene.body.orientation_wxyz: ",
     {"zero quaternion"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\nshape = { type = 'sphere', radius = 1 }\norientation_wxyz = [1, 0, 0]",
     "5:20: scene.body.orientation_wxyz: ",
     {"3 values", "4 numbers"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0]",
     "5:12: scene.body.position: ",
     {"3 numbers"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 1, 1]\nvelocity = [0, inf, 0]",
     "5:16: scene.body.velocity[1]: ",
     {"found inf"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\ninertia = [1, 1, 1]\nvelocty = [0, 0, 0]",
     "5:1: scene.body.velocty: ",
     {"'velocity'"}},
    {"[[scene.body]]\nname = 'a'\nfixed = true\nvelocity = [1, 0, 0]",
     "4:12: scene.body.velocity: ",
     {"does not move"}},
    {"[[scene.body]]\nname = 'a'\nfixed = true\nangular_velocity = [1, 0, 0]",
     "4:20: scene.body.angular_velocity: ",
     {"does not move"}},
    {"[[scene.body]]\nname = 'a'\nfixed = true\ncollides = true", "4:12: scene.body.collides: ", {"no shape"}},
    // Shapes.
    {"[[scene.body]]\nname = 'a'\nmass = 1\nshape = { type = 'sphere', radius = 1, position = [0, 0.25, 0] }",
     "4:9: scene.body.shape: ",
     {"found the centre of mass at [0, 0.25, 0] m", "at its origin"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\nshapes = [{ type = 'sphere', radius = 1 }]\nshape = { type = 'sphere', "
     "radius = 1 }",
     "4:10: scene.body.shapes: ",
     {"one of the two"}},
    {"[[scene.body]]\nname = 'a'\nshapes = { type = 'sphere', radius = 1 }", "3:10: scene.body.shapes: ", {"an array"}},
    {"[[scene.body]]\nname = 'a'\nshapes = [{ type = 'plane', normal = [0, 0, 1], offset = 0 }]",
     "3:11: scene.body.shapes[0]: ",
     {"cannot be one of several"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'plane', normal = [0, 0, 1], offset = 0, position = [0, 0, 1] }",
     "3:59: scene.body.shape.position: a plane has no such key",
     {}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'ellipsoid', radii = [1, 1, -1] }",
     "3:39: scene.body.shape.radii: ",
     {"not greater than 0"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'ellipsoid', radius = 1 }",
     "3:31: scene.body.shape.radius: an ellipsoid has no such key",
     {}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\nfixed = false\nshape = { type = 'heightfield', size = [1, 1], heights = "
     "[[0, 0], "
     "[0, 0]] }",
     "4:9: scene.body.fixed: ",
     {"a heightfield never moves"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'heightfield', size = [1, -1], heights = [[0, 0], [0, 0]] }",
     "3:40: scene.body.shape.size: ",
     {"not greater than 0"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'heightfield', size = [1, 1], heights = [[0, 0], [0]] }",
     "3:58: scene.body.shape.heights: ",
     {"row 2 has 1 heights, and row 1 has 2"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'heightfield', size = [1, 1], heights = [0, 0] }",
     "3:59: scene.body.shape.heights[0]: ",
     {"a row of heights"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'mesh', points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "
     "triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2]] }",
     "3:35: scene.body.shape.points: ",
     {"the mesh is open"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'mesh', points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "
     "triangles = [[0, 2, 1.5]] }",
     "3:94: scene.body.shape.triangles[0]: ",
     {"found 1.5", "three whole numbers"}},
    {"[[scene.body]]\nname = 'a'\nshapes = [{ type = 'mesh', file = '../ground.obj' }]",
     "3:35: scene.body.shapes[0].file: ",
     {}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'convex' }", "3:9: scene.body.shape.points: missing", {}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'convex', points = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }",
     "3:37: scene.body.shape.points: ",
     {"found 3 points", "at least 4"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'convex', points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]] }",
     "3:37: scene.body.shape.points: ",
     {"one plane"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'convex', points = [[0, 0, 0], [1, 0, nan], [0, 1, 0], [1, 1, 0]] }",
     "3:56: scene.body.shape.points[1][2]",
     {"nan"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'convex', file = '../rock.stl' }",
     "3:35: scene.body.shape.file: ",
     {"not in the case file's folder"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'convex', file = 'none.stl' }",
     "3:35: scene.body.shape.file: ",
     {"no such file"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'convex', scale = 2, points = [[0, 0, 0]] }",
     "3:36: scene.body.shape.scale: ",
     {"with the key file"}},
    {"[[scene.body]]\nname = 'a'\nshape = 'box'", "3:9: scene.body.shape: ", {"found a string, 'box'", "a table"}},
    {"[[scene.body]]\nname = 'a'\nshape = {}", "3:9: scene.body.shape.type: missing", {}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'shpere' }",
     "3:18: scene.body.shape.type: ",
     {"found 'shpere'", "'sphere'", "box, capsule, convex, cylinder, ellipsoid, heightfield, mesh, plane, sphere"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'sphere', radiu = 1 }",
     "3:28: scene.body.shape.radiu: unknown key",
     {"'radius'"}},
    {"[[scene.body]]\nname = 'a'\nshape = { sphere = 1 }",
     "3:11: scene.body.shape.sphere: unknown key",
     {"allowed: type, size, position, orientation_wxyz, radius, length, points, file, scale, radii, heights, "
      "triangles, normal, offset"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'sphere' }", "3:9: scene.body.shape.radius: missing", {}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'sphere', size = [1, 1, 1] }",
     "3:28: scene.body.shape.size: a sphere has no such key",
     {"type, radius"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'sphere', radius = -1 }",
     "3:37: scene.body.shape.radius: ",
     {"found -1"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'box', size = [1, 0, 1] }",
     "3:32: scene.body.shape.size: ",
     {"not greater than 0"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'capsule', radius = 1, length = 0 }",
     "3:50: scene.body.shape.length: ",
     {"found 0"}},
    {"[[scene.body]]\nname = 'a'\nshape = { type = 'plane', normal = [0, 0, 0], offset = 0 }",
     "3:36: scene.body.shape.normal: ",
     {"points nowhere"}},
    {"[[scene.body]]\nname = 'a'\nfixed = false\nshape = { type = 'plane', normal = [0, 1, 0], offset = 0 }",
     "3:9: scene.body.fixed: ",
     {"a plane never moves"}},
    {"[[scene.body]]\nname = 'a'\nposition = [0, 1, 0]\nshape = { type = 'plane', normal = [0, 1, 0], offset = 0 }",
     "3:12: scene.body.position: ",
     {"normal and offset"}},
    {"[[scene.body]]\nname = 'a'\norientation_wxyz = [1, 0, 0, 0]\nshape = { type = 'plane', normal = [0, 1, 0], "
     "offset = 0 }",
     "3:20: scene.body.orientation_wxyz: ",
     {"no orientation"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1e300\nshape = { type = 'sphere', radius = 1e200 }",
     "4:9: scene.body.shape: ",
     {"not finite"}},
    {"[[scene.body]]\nname = 'a'\nmass = 1\nshape = { type = 'sphere', radius = 1e-200 }",
     "4:9: scene.body.shape: ",
     {"greater than 0"}},
};

}  // namespace

BOOST_AUTO_TEST_CASE(each_body_that_cannot_be_is_refused) {
  for (const Refusal& row : kBadBodies) check_refusal(row, "s.toml", [&] { scene_of(row.text); });
}

BOOST_AUTO_TEST_CASE(a_body_is_read_with_all_it_says) {
  const Scene scene = scene_of(R"([scene]
gravity = [1, -9.8, 2]
[[scene.body]]
name = "a \"quoted\", ünïcode name"
mass = 3
inertia = [4, 5, 6, 0.1, 0.2, 0.3]
position = [1, 2, 3]
orientation_wxyz = [2, 0, 0, 2]
velocity = [4, 5, 6]
angular_velocity = [7, 8, 9]
shape = { type = "box", size = [1, 2, 3] }
collides = false)");
  const Body& body = scene.bodies.at(0);
  Mat3 inertia;
  inertia << 4, 0.1, 0.2, 0.1, 5, 0.3, 0.2, 0.3, 6;
  BOOST_TEST((scene.gravity == Vec3(1, -9.8, 2)));
  BOOST_TEST(body.name == "a \"quoted\", ünïcode name");
  BOOST_TEST(body.mass == 3);
  BOOST_TEST((body.inertia == inertia));
  BOOST_TEST((body.position == Vec3(1, 2, 3)));
  // (1, 0, 0, 1)/√2, to a few roundings of the division.
  BOOST_TEST((body.orientation.coeffs() - Eigen::Vector4d(0, 0, std::sqrt(0.5), std::sqrt(0.5))).norm() < 4e-16);
  BOOST_TEST((body.velocity == Vec3(4, 5, 6)));
  BOOST_TEST((body.angular_velocity == Vec3(7, 8, 9)));
  BOOST_TEST((std::get<Box>(body.shape.value()).size == Vec3(1, 2, 3)));
  BOOST_TEST(!body.collides);
  BOOST_TEST(!body.fixed);
}

BOOST_AUTO_TEST_CASE(what_a_body_leaves_out_has_its_default) {
  const Scene scene = scene_of(R"(scene.body = [
    { name = "cube", mass = 1, inertia = [1, 1, 1] },
    { name = "ball", mass = 2, shape = { type = "sphere", radius = 0.1 } },
    { name = "ground", shape = { type = "plane", normal = [0, 2, 0], offset = 0.5 } } ])");
  const Body &cube = scene.bodies.at(0), &ball = scene.bodies.at(1), &ground = scene.bodies.at(2);
  BOOST_TEST((cube.position == Vec3::Zero()));
  BOOST_TEST((cube.orientation.coeffs() == Quat::Identity().coeffs()));
  BOOST_TEST((cube.velocity == Vec3::Zero()));
  BOOST_TEST((cube.angular_velocity == Vec3::Zero()));
  BOOST_TEST(!cube.shape.has_value());
  BOOST_TEST(!cube.collides);
  BOOST_TEST(ball.collides);
  BOOST_TEST((ball.inertia == inertia_of(Sphere{0.1}, 2)));
  BOOST_TEST(ground.fixed);
  BOOST_TEST(ground.collides);
  BOOST_TEST((std::get<Plane>(ground.shape.value()).normal == Vec3(0, 1, 0)));
  BOOST_TEST(std::get<Plane>(ground.shape.value()).offset == 0.5);
}

BOOST_AUTO_TEST_CASE(every_shape_is_read) {
  const Scene scene = scene_of(R"(scene.body = [
    { name = "b", mass = 1, shape = { type = "box", size = [1, 2, 3] } },
    { name = "c", mass = 1, shape = { type = "capsule", radius = 0.5, length = 2 } },
    { name = "p", shape = { type = "plane", normal = [0, 0, 3], offset = -1 } },
    { name = "s", mass = 1, shape = { type = "sphere", radius = 0.5 } },
    { name = "y", mass = 1, shape = { type = "cylinder", radius = 0.5, length = 2 } },
    { name = "e", mass = 1, shape = { type = "ellipsoid", radii = [1, 2, 3] } },
    { name = "h", mass = 1, shape = { type = "convex", points = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]] } },
    { name = "d", mass = 1, shapes = [
      { type = "sphere", radius = 0.5, position = [1, 0, 0] },
      { type = "cylinder", radius = 0.1, length = 2, orientation_wxyz = [1, 0, 1, 0] },
      { type = "sphere", radius = 0.5, position = [-1, 0, 0] } ] } ])");
  BOOST_TEST(shape_name(scene.bodies[0].shape.value()) == "box");
  BOOST_TEST(std::get<Capsule>(scene.bodies[1].shape.value()).radius == 0.5);
  BOOST_TEST(std::get<Capsule>(scene.bodies[1].shape.value()).length == 2);
  BOOST_TEST(std::get<Plane>(scene.bodies[2].shape.value()).offset == -1);
  BOOST_TEST(std::get<Sphere>(scene.bodies[3].shape.value()).radius == 0.5);
  BOOST_TEST(std::get<Cylinder>(scene.bodies[4].shape.value()).length == 2);
  BOOST_TEST((std::get<Ellipsoid>(scene.bodies[5].shape.value()).radii == Vec3(1, 2, 3)));
  BOOST_TEST(std::get<Convex>(scene.bodies[6].shape.value()).hull->faces.size() == 4u);
  const Compound& dumbbell = std::get<Compound>(scene.bodies[7].shape.value());
  BOOST_TEST(dumbbell.parts.size() == 3u);
  BOOST_TEST((dumbbell.parts[2].pose.position == Vec3(-1, 0, 0)));
  BOOST_TEST(std::abs(dumbbell.parts[1].pose.orientation.y() - std::sqrt(0.5)) < 1e-15);
  BOOST_TEST((scene.bodies[7].inertia == inertia_of(dumbbell, 1)));
}

// With an inertia of its own, a body may have its shape anywhere.
BOOST_AUTO_TEST_CASE(a_shape_beside_the_centre_of_mass_needs_an_inertia) {
  const Scene scene = scene_of(R"([[scene.body]]
name = "tippe top"
mass = 1
inertia = [1, 1, 1]
shape = { type = "sphere", radius = 1, position = [0, 0, 0.2] })");
  BOOST_TEST((std::get<Compound>(scene.bodies[0].shape.value()).parts[0].pose.position == Vec3(0, 0, 0.2)));
}

BOOST_AUTO_TEST_CASE(a_hull_is_read_from_a_file_beside_the_case) {
  const Folder folder;
  folder.write("cube.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nv 2 2 0\nv 2 0 2\nv 0 2 2\nv 2 2 2\n");
  const std::string text =
      "scene.body = [{ name = 'a', fixed = true, shape = { type = 'convex', file = 'cube.obj', scale = 0.5 } }]";
  const TomlFile file = TomlFile::parse(text, (folder.path / "case.toml").string());
  const Scene scene = read_scene(file.root({"scene"}).at("scene"));
  BOOST_TEST(std::get<Convex>(*scene.bodies[0].shape).volume() == 1, boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(a_mesh_and_heights_are_read_for_bodies_that_stand) {
  const Folder folder;
  folder.write("ramp.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::string text =
      "scene.body = [{ name = 'a', position = [1, 2, 3], shape = { type = 'mesh', file = 'ramp.obj', scale = 0.5 } }, "
      "{ name = 'b', shape = { type = 'heightfield', size = [2, 1], heights = [[0, 1, 0], [0, 2, 0]] } }]";
  const TomlFile file = TomlFile::parse(text, (folder.path / "case.toml").string());
  const Scene scene = read_scene(file.root({"scene"}).at("scene"));
  BOOST_TEST((scene.bodies[0].fixed && scene.bodies[1].fixed && scene.bodies[0].collides));
  BOOST_TEST(volume_of(*scene.bodies[0].shape) == 1.0 / 6, boost::test_tools::tolerance(1e-14));
  const auto& field = std::get<Heightfield>(*scene.bodies[1].shape);
  BOOST_TEST((field.surface->points[4] == Vec3(0, 0.5, 2)));  // the middle of the second row
  BOOST_TEST(field.surface->triangles.size() == 4u);
}

BOOST_AUTO_TEST_CASE(an_inertia_may_touch_the_triangle_inequality) {
  for (const char* moments : {"[1, 2, 3]", "[3, 2, 1]", "[0.0333333, 0.133333, 0.166667]", "[1e-300, 2e-300, 3e-300]",
                              "[1e308, 1e308, 1e308]", "[2, 2, 2, 0.5, 0.5, 0.5]", "[1e-9, 1, 1]"}) {
    const std::string text = fmt::format("[[scene.body]]\nname = 'a'\nmass = 1\ninertia = {}", moments);
    BOOST_TEST_CONTEXT(moments) {
      BOOST_TEST(refusal_of([&] { scene_of(text); }) == "");
    }
  }
}

BOOST_AUTO_TEST_CASE(a_quaternion_of_any_length_is_made_a_unit_one) {
  for (const double scale : {1e-300, 0.1, 1.0, 1e300}) {
    const Scene scene = scene_of(fmt::format(
        "[[scene.body]]\nname = 'a'\nfixed = true\norientation_wxyz = [{}, {}, 0, {}]", scale, -2 * scale, 2 * scale));
    const Eigen::Vector4d expected(-2.0 / 3, 0, 2.0 / 3, 1.0 / 3);
    // A norm and a division: a few roundings.
    BOOST_TEST((scene.bodies[0].orientation.coeffs() - expected).norm() < 1e-15);
  }
  for (const char* extreme : {"1.7e308", "5e-324"}) {
    const Scene scene = scene_of(
        fmt::format("[[scene.body]]\nname = 'a'\nfixed = true\norientation_wxyz = [{0}, {0}, {0}, -{0}]", extreme));
    BOOST_TEST((scene.bodies[0].orientation.coeffs() - Eigen::Vector4d(0.5, 0.5, -0.5, 0.5)).norm() < 1e-15, extreme);
  }
}

BOOST_AUTO_TEST_SUITE_END()
