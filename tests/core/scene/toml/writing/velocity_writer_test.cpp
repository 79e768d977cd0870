#include "core/scene/toml/writing/velocity_writer.h"

#include <boost/test/unit_test.hpp>

#include "tests/core/scene/scene_of.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_toml_writing_velocity_writer)

BOOST_AUTO_TEST_CASE(velocities_are_written_in_their_places_and_all_else_stays) {
  const std::string before = R"(title = "größer"  # a comment
[[scene.body]]
name = "a"  # the first
mass = 1
inertia = [1, 1, 1]
velocity = [1, 0, 0]  # m/s
[[scene.body]]
name = "b"
mass = 2
inertia = [1, 1, 1]
)";
  const TomlFile file = TomlFile::parse(before, "s.toml");
  const TomlValue value = file.root({"title", "scene"}).at("scene");
  Scene scene = read_scene(value);
  BOOST_TEST(with_velocities(file, value, scene) == before);
  scene.bodies[0].velocity = {0.5, 0, 0};
  scene.bodies[1].angular_velocity = {0, 0.25, 0};
  BOOST_TEST(with_velocities(file, value, scene) == R"(title = "größer"  # a comment
[[scene.body]]
name = "a"  # the first
mass = 1
inertia = [1, 1, 1]
velocity = [0.5, 0, 0]  # m/s
[[scene.body]]
name = "b"
angular_velocity = [0, 0.25, 0]
mass = 2
inertia = [1, 1, 1]
)");
}

BOOST_AUTO_TEST_CASE(a_body_on_one_line_stays_on_it) {
  const TomlFile file = TomlFile::parse("scene = { body = [{ name = 'ä', mass = 1, inertia = [1, 1, 1] }] }", "s.toml");
  const TomlValue value = file.root({"scene"}).at("scene");
  Scene scene = read_scene(value);
  scene.bodies[0].velocity = {0.1, 0, -3};
  BOOST_TEST(with_velocities(file, value, scene) ==
             "scene = { body = [{ name = 'ä', velocity = [0.1, 0, -3], mass = 1, inertia = [1, 1, 1] }] }");
}

BOOST_AUTO_TEST_SUITE_END()
