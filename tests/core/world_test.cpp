#include "core/world.h"

#include <boost/test/unit_test.hpp>

#include <algorithm>

#include "adapters/core/core_engine.h"
#include "tests/folder.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_world)

namespace {

const char* const kThrown = R"(title = "A stone"
[scene]
gravity = [0, -10, 0]
[[scene.body]]
name = "stone"
mass = 2
inertia = [1, 1, 1]
velocity = [1, 0, 0]
)";

std::string why(const std::string& run, const Scene& scene = test::tumbling_body()) {
  try {
    load_world(scene, run);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_file_is_loaded_stepped_and_read) {
  const Folder folder;
  const auto world = load_world(read_scene_file(folder.write("thrown.toml", kThrown)));  // the scene ends here
  for (int i = 0; i < 1000; ++i) world->step(1e-3);
  Snapshot now;
  world->read(now);
  // The default method is exact to 1e-12 for a parabola; a thousand steps round.
  BOOST_TEST(now.time == 1, boost::test_tools::tolerance(1e-12));
  BOOST_TEST((now.bodies().position(0) - Vec3(1, -5, 0)).norm() < 1e-11);
  BOOST_TEST((now.bodies().velocity(0) - Vec3(1, -10, 0)).norm() < 1e-11);
}

BOOST_AUTO_TEST_CASE(every_method_gives_the_bits_of_the_engine) {
  const Scene scene = test::tumbling_body();
  BOOST_TEST_REQUIRE(core_info().methods.size() > 5u);
  for (const MethodInfo& method : core_info().methods) {
    const auto world = load_world(scene, "core:" + method.name), engine = CoreEngine().load(scene, {method.name, {}});
    Snapshot ours, theirs;
    for (int i = 0; i < 5; ++i) world->step(0.01), engine->step(0.01);
    world->read(ours), engine->read(theirs);
    for (int c = 0; c < 13; ++c)
      BOOST_TEST(ours.bodies().column(c)[0] == theirs.bodies().column(c)[0], method.name << ", column " << c);
  }
}

BOOST_AUTO_TEST_CASE(options_of_a_run_name_are_in_force) {
  const auto settings =
      load_world(test::tumbling_body(), "core:explicit-euler,orientation=matrix-additive")->settings_in_force();
  const std::pair<std::string, std::string> asked = {"orientation", "matrix-additive"};
  BOOST_TEST((std::find(settings.begin(), settings.end(), asked) != settings.end()));
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused_with_the_reason) {
  BOOST_TEST(why("core:rk5").find("did you mean 'rk4'") != std::string::npos, why("core:rk5"));
  BOOST_TEST(why("ode").find("there is no engine 'ode'") != std::string::npos, why("ode"));
  Scene jointed = test::tumbling_body();
  jointed.joints.push_back({.a = kWorld, .b = 0, .type = BallJoint{Vec3(1, 2, 3)}});
  BOOST_TEST(why("core:exponential-adams", jointed).find("core:exponential-adams has no joint:ball") == 0u,
             why("core:exponential-adams", jointed));
  const Folder folder;
  const std::string path = folder.write("bad.toml", "[scene]\ngravitation = [0, 0, 0]\n");
  BOOST_CHECK_EXCEPTION(read_scene_file(path), InputError, [&](const InputError& error) {
    return std::string(error.what()).find(path + ":2:1") == 0 &&
           std::string(error.what()).find("gravity") != std::string::npos;
  });
}

BOOST_AUTO_TEST_SUITE_END()
