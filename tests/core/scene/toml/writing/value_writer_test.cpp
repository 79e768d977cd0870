// Another number in a scene's text, by its path; what the reader then makes of it.
#include "core/scene/toml/writing/value_writer.h"

#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_toml_writing_value_writer)

namespace {

constexpr const char* kText = R"(title = "springs — with a dash"
[scene]
gravity = [0, -9.8, 0]   # m/s²
[[scene.body]]
name = "cube"
mass = 100
inertia = [1, 2, 2.5]
shape = { type = "sphere", radius = 0.1 }
[[scene.body]]
name = "ball"
mass = 2.5
inertia = [1, 1, 1]
[[scene.spring]]
a = "world"
b = "cube"
stiffness = 1e4
[[scene.contact]]
a = "cube"
b = "ball"
)";

Scene scene_of(const std::string& text) {
  return read_scene(TomlFile::parse(text, "t.toml").root({"title", "scene"}).at("scene"));
}
Scene with(const std::string& path, const std::string& value) { return scene_of(with_value(kText, path, value)); }

}  // namespace

BOOST_AUTO_TEST_CASE(a_value_is_found_by_its_path_and_nothing_else_changes) {
  BOOST_TEST(with("scene.body.cube.mass", "7").bodies[0].mass == 7);
  BOOST_TEST(with("scene.body.cube.mass", "7").bodies[1].mass == 2.5);
  BOOST_TEST(with("scene.body[1].mass", "0.25").bodies[1].mass == 0.25);
  BOOST_TEST(with("scene.gravity[1]", "-1.625").gravity.y() == -1.625);
  BOOST_TEST(with("scene.body.cube.inertia[2]", "1.5").bodies[0].inertia(2, 2) == 1.5);
  BOOST_TEST(with("scene.spring[0].stiffness", "1e-3").springs[0].stiffness == 1e-3);
  BOOST_TEST(std::get<Sphere>(*with("scene.body.cube.shape.radius", "4").bodies[0].shape).radius == 4);
  const std::string changed = with_value(kText, "scene.gravity[1]", "-9.8");
  BOOST_TEST(changed == kText);
}

BOOST_AUTO_TEST_CASE(the_equal_moments_of_a_cube_change_together) {
  const Scene scene = with("scene.body.ball.inertia", "0.75");
  BOOST_TEST((scene.bodies[1].inertia == 0.75 * Mat3::Identity()));
  BOOST_TEST(scene.bodies[0].inertia(0, 0) == 1);
  const auto is_refused = [](const std::string& text, const char* path) {
    BOOST_CHECK_EXCEPTION(with_value(text, path, "1"), InputError, [](const InputError& error) {
      return std::string(error.what()).find("is no single value") != std::string::npos;
    });
  };
  is_refused(kText, "scene.body.cube.inertia");                             // of several numbers
  is_refused(with_value(kText, "scene.gravity[1]", "0"), "scene.gravity");  // equal, but a vector
}

BOOST_AUTO_TEST_CASE(a_key_that_is_not_written_is_added_to_its_table) {
  BOOST_TEST(with("scene.spring[0].damping", "3").springs[0].damping == 3);
  BOOST_TEST(with("scene.contact[0].friction", "0.5").contact_pairs[0].law.friction == 0.5);
  BOOST_TEST(with("scene.contact_default.friction", "0.7").contact_default.friction == 0.7);
  const std::string twice = with_value(with_value(kText, "scene.contact_default.friction", "0.7"),
                                       "scene.contact_default.restitution", "0.2");
  BOOST_TEST(scene_of(twice).contact_default.friction == 0.7);
  BOOST_TEST(scene_of(twice).contact_default.restitution == 0.2);
}

BOOST_AUTO_TEST_CASE(a_path_that_leads_nowhere_is_refused_with_a_near_match) {
  struct Row {
    std::string path, expected;
  };
  const Row rows[] = {{"scene.sprin[0].stiffness", "did you mean 'spring'"},
                      {"scene.body.cub.mass", "did you mean 'cube'"},
                      {"scene.body[2].mass", "it has 2, counted from 0"},
                      {"scene.spring.first.stiffness", "rows have no names"},
                      {"scene.gravity", "is no single value"},
                      {"scene.body.cube", "is no single value"},
                      {"scene.body.cube.mass.unit", "leads no further"},
                      {"scene.gravity[3]", "it has 3, counted from 0"},
                      {"scene", "no path"},
                      {"scene.", "no path"},
                      {"scene..x", "no path"},
                      {"scene.spring[x].stiffness", "no path"},
                      {"scene.spring[0", "no path"},
                      {"scene.spring[-1].stiffness", "no path"},
                      {"run.duration", "no path"}};
  for (const Row& row : rows) {
    BOOST_CHECK_EXCEPTION(with_value(kText, row.path, "1"), InputError, [&](const InputError& error) {
      BOOST_TEST_MESSAGE(error.what());
      return std::string(error.what()).find(row.expected) != std::string::npos;
    });
  }
}

// Whether a scene may have the value, and the key, is the reader's to say: with its own near match and the line.
BOOST_AUTO_TEST_CASE(what_no_scene_has_is_refused_by_its_reader) {
  BOOST_CHECK_EXCEPTION(with("scene.body.cube.mass", "-1"), InputError, [](const InputError& error) {
    return std::string(error.what()).starts_with("t.toml:6:8: scene.body.mass: found -1");
  });
  BOOST_CHECK_EXCEPTION(with("scene.spring[0].stifness", "1"), InputError, [](const InputError& error) {
    return std::string(error.what()).find("did you mean 'stiffness'") != std::string::npos;
  });
}

BOOST_AUTO_TEST_SUITE_END()
