// The example engines of the npm registry, as package-lock.json names them. Each conforms. In single precision the
// error of each is that of its scheme and no larger.
#include <sys/wait.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "generated/tests/places.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_plugin_npm_engines, *boost::unit_test::enable_if<RIGOR_HTML_REPORT>())

namespace {

struct Answer {
  int code;
  std::string out;
};

Answer run(const Folder& folder, const std::string& words) {
  const std::string out = (folder.path / "stdout").string();
  const int status = std::system((RIGOR_PROGRAM " " + words + " >" + out + " 2>&1 </dev/null").c_str());
  std::ifstream file(out);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, {std::istreambuf_iterator<char>(file), {}}};
}

std::string plugin(const std::string& name) {
  return " --plugin 'node " RIGOR_BUILD_DIR "/plugins/npm/" + name + ".mjs'";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

struct NpmEngine {
  const char *file, *name;
  const char* broken = "";  // the one check of `conform` that fails
  double sub_steps = 1;     // into which it divides each step
};
// PhysX's bindings report no friction (PhysX issue 276). Havok brakes what is slower than 0.1 m/s, and no call of its
// bindings switches that off.
constexpr NpmEngine kEngines[] = {{"ammo", "ammo"},    {"cannon-es", "cannon-es"}, {"havok", "havok", "no-sleep", 4},
                                  {"jolt", "jolt"},    {"mujoco", "mujoco-js"},    {"physx", "physx", "contact-forces"},
                                  {"rapier", "rapier"}};

}  // namespace

// They are installed by npm, as what the HTML report's page is made of.
BOOST_AUTO_TEST_CASE(each_of_them_conforms) {
  const Folder folder;
  for (const NpmEngine& engine : kEngines) {
    const Answer answer = run(folder, "conform" + plugin(engine.file));
    const std::string failing = engine.broken;
    BOOST_TEST(answer.code == (failing.empty() ? 0 : 1), answer.out);
    BOOST_TEST(has(answer.out, std::string(engine.name) + (failing.empty() ? " conforms" : " does not conform")));
    const std::size_t broken = answer.out.find("BROKEN");
    BOOST_TEST((broken != std::string::npos) == !failing.empty());
    if (failing.empty()) continue;
    BOOST_TEST(has(answer.out, "BROKEN  " + failing), answer.out);
    BOOST_TEST(answer.out.find("BROKEN", broken + 1) == std::string::npos, answer.out);
  }
}

// x after one second of a brick of 10 kg under such a pull [N], with friction 0.4 and static friction 0.5.
double moved_by(double pull, const Folder& folder) {
  const std::string scene = folder.write("brick.toml", R"(title = "A brick that is pulled"
source = "a test"
[scene]
gravity = [0, 0, -9.81]
contact_default = { friction = 0.4, static_friction = 0.5 }
[[scene.body]]
name = "brick"
mass = 10
position = [0, 0, 0.1]
shape = { type = "box", size = [0.4, 0.4, 0.2] }
[[scene.body]]
name = "ground"
shape = { type = "plane", normal = [0, 0, 1], offset = 0 }
[[scene.force]]
body = "brick"
force = [)" + std::to_string(pull) + R"(, 0, 0]
[run]
duration = 1
dt = ["1/240"]
[truth]
kind = "pushed"
)");
  const Answer answer = run(folder, "trace " + scene + " --every 240 --engine physx" + plugin("physx"));
  BOOST_TEST_REQUIRE(answer.code == 0, answer.out);
  double x = -1;
  const std::size_t last = answer.out.rfind("1,brick,");
  BOOST_TEST_REQUIRE((last != std::string::npos && std::sscanf(answer.out.c_str() + last, "1,brick,%lf", &x) == 1));
  return x;
}

// 39.24 N are the friction of sliding, 49.05 N the static one; with 45 N PhysX lets the brick go. It needs some steps
// until the friction of a brick that slides is there.
BOOST_AUTO_TEST_CASE(physx_has_a_static_friction) {
  const Folder folder;
  BOOST_TEST(std::abs(moved_by(42, folder)) < 1e-3);
  BOOST_TEST(std::abs(moved_by(50, folder) - 0.5 * (50 - 39.24) / 10) < 0.02);
}

// A box and a ball that bounce, with friction that lets nothing slide.
BOOST_AUTO_TEST_CASE(forces_that_cannon_es_reports_explain_the_motion) {
  const Folder folder;
  const std::string scene = folder.write("bouncing.toml", R"(title = "A ball on a box"
source = "a test"
[scene]
gravity = [0, 0, -9.81]
contact_default = { restitution = 0.5, friction = "infinite" }
[[scene.body]]
name = "box"
mass = 2
position = [0, 0, 0.3]
velocity = [1, 0, 0]
shape = { type = "box", size = [0.4, 0.2, 0.2] }
[[scene.body]]
name = "ball"
mass = 1
position = [0, 0, 0.6]
velocity = [1, 0, 0]
shape = { type = "sphere", radius = 0.1 }
[[scene.body]]
name = "ground"
shape = { type = "plane", normal = [0, 0, 1], offset = 0 }
[run]
duration = 1
dt = ["1/240"]
[truth]
kind = "none"
[[gate]]
metric = "contact_balance"
max = 1e-9
because = "roundings of 1000 N"
)");
  const Answer answer = run(folder, "gate " + scene + " --engine cannon-es" + plugin("cannon-es"));
  BOOST_TEST(has(answer.out, "1 held, 0 failed"), answer.out);
}

BOOST_AUTO_TEST_CASE(each_steps_exactly_once_by_dt) {
  const Folder folder;
  for (const NpmEngine& engine : kEngines) {
    BOOST_TEST_CONTEXT(engine.name) {
      // Semi-implicit Euler falls g dt t / 2 = 0.16333 m too far in a second of 1/30 s steps. An engine that divides
      // its steps by four is a quarter of that off.
      const Answer fall = run(folder, "trace ballistic/free-fall --dt 1/30 --duration 1 --every 30 --engine " +
                                          std::string(engine.name) + plugin(engine.file));
      BOOST_TEST_REQUIRE(fall.code == 0, fall.out);
      const std::size_t last = fall.out.rfind('\n', fall.out.size() - 2);
      double time = 0, z = 0;
      BOOST_TEST_REQUIRE(std::sscanf(fall.out.c_str() + last + 1, "%lf,stone,%*f,%*f,%lf", &time, &z) == 2);
      BOOST_TEST(time == 1);
      // Thirty roundings of 500 m in single precision are 1e-3 m; there is one for each sub-step.
      BOOST_TEST(std::abs(z - (500 - 4.905 - 0.1635 / engine.sub_steps)) < 1e-3 * (1 + engine.sub_steps));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
