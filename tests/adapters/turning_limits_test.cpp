// Limits of hinges that lie beyond half a turn, of every engine that says it takes them.
#include <numbers>

#include "tests/adapters/seam_runs.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_turning_limits)

namespace {

constexpr double kStep = 1.0 / 240, kSpeed = 3;  // s, rad/s

// A wheel that turns about its own centre; its angle as b's against a is at most `upper`, or the other way round at
// least -`upper`.
Scene wheel(double upper, bool is_b) {
  Scene scene;
  scene.gravity.setZero();
  scene.bodies = {test::body("wheel", 2, {0.5, 0.5, 0.5}, {0.2, 0.1, 0})};
  scene.bodies[0].angular_velocity = {0, 0, kSpeed};
  const HingeJoint axle{{0.2, 0.1, 0}, Vec3::UnitZ()};
  if (is_b)
    scene.joints = {{.a = kWorld, .b = 0, .type = axle, .upper = upper}};
  else
    scene.joints = {{.a = 0, .b = kWorld, .type = axle, .lower = -upper}};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_wheel_turns_until_its_limit_and_no_further) {
  for (const double upper : {3.1, 4.0, 2 * std::numbers::pi, 10.0}) {
    for (const bool is_b : {true, false}) {
      const Scene scene = wheel(upper, is_b);
      for_each_run(scene, kStep, [&](const Run& run) {
        if (run.settings.track == Track::stock) return;  // pushed back from what a step goes too far, wheels turn back
        const auto world = run.load(scene);
        Snapshot now;
        double turned = 0, rate = kSpeed;
        for (double t = kStep; t < upper / kSpeed + 0.5; t += kStep) {
          world->step(kStep);
          world->read(now);
          rate = now.bodies().angular_velocity(0).z();
          turned += kStep * rate;
          if (t < upper / kSpeed - 2 * kStep)
            BOOST_REQUIRE_MESSAGE(std::abs(rate - kSpeed) < 1e-3, "at " << t << ": " << rate);
        }
        // A limit may be found at the end of the step that passes it, or of the next. MuJoCo's lets 1e-4 through.
        BOOST_TEST(std::abs(turned - upper) < 2.1 * kStep * kSpeed, upper << ": " << turned);
        BOOST_TEST(std::abs(rate) < 1e-3 * kSpeed, upper << ": " << rate);
      });
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
