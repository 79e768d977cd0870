// Limits of hinges that lie beyond half a turn, of every engine that says it takes them.
#include <cmath>
#include <numbers>

#include "tests/adapters/seam_runs.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_turning_limits)

namespace {

constexpr double kStep = 1.0 / 240, kSpeed = 3;  // s, rad/s

// A wheel that turns about its own centre, between two angles. It is the joint's b, or its a, whose limits are the
// other way round.
Scene wheel(double lower, double upper, bool is_b) {
  Scene scene;
  scene.gravity.setZero();
  scene.bodies = {test::body("wheel", 2, {0.5, 0.5, 0.5}, {0.2, 0.1, 0})};
  scene.bodies[0].angular_velocity = {0, 0, kSpeed};
  const HingeJoint axle{{0.2, 0.1, 0}, Vec3::UnitZ()};
  if (is_b)
    scene.joints = {{.a = kWorld, .b = 0, .type = axle, .lower = lower, .upper = upper}};
  else
    scene.joints = {{.a = 0, .b = kWorld, .type = axle, .lower = -upper, .upper = -lower}};
  return scene;
}

// A wheel that has turned by -4 rad about W's z, pulled there by a spring or a servo.
void check_pulled(const Scene& scene, double at) {
  const Quat wanted(Eigen::AngleAxisd(at, Vec3::UnitZ()));
  for_each_run(scene, kStep, [&](const Run& run) {
    if (run.settings.track == Track::stock) return;  // Bullet falls asleep before it is there
    const auto world = run.load(scene);
    Snapshot now;
    double turned = 0;
    for (double t = kStep; t < 8; t += kStep) {
      world->step(kStep);
      world->read(now);
      turned += kStep * now.bodies().angular_velocity(0).z();
    }
    BOOST_TEST(now.bodies().orientation(0).angularDistance(wanted) < 1e-3);
    BOOST_TEST(std::abs(turned - at) < 0.1, turned << " for " << at);  // the speeds summed up, to first order in dt
  });
}

}  // namespace

// Behind it is another limit, nearer to the start.
BOOST_AUTO_TEST_CASE(a_wheel_turns_until_its_limit_and_no_further) {
  for (const double limit : {3.1, 4.0, 2 * std::numbers::pi, 10.0, -4.0}) {
    for (const bool is_b : {true, false}) {
      Scene scene = limit > 0 ? wheel(-0.4, limit, is_b) : wheel(limit, 0.4, is_b);
      const double speed = std::copysign(kSpeed, limit);
      scene.bodies[0].angular_velocity.z() = speed;
      for_each_run(scene, kStep, [&](const Run& run) {
        if (run.settings.track == Track::stock) return;  // pushed back from what a step goes too far, wheels turn back
        const auto world = run.load(scene);
        Snapshot now;
        double turned = 0, rate = speed;
        for (double t = kStep; t < limit / speed + 0.5; t += kStep) {
          world->step(kStep);
          world->read(now);
          rate = now.bodies().angular_velocity(0).z();
          turned += kStep * rate;
          if (t < limit / speed - 2 * kStep)
            BOOST_REQUIRE_MESSAGE(std::abs(rate - speed) < 1e-3, "at " << t << ": " << rate);
        }
        // A limit may be found at the end of the step that passes it, or of the next. MuJoCo's lets 1e-4 through.
        BOOST_TEST(std::abs(turned - limit) < 2.1 * kStep * kSpeed, limit << ": " << turned);
        BOOST_TEST(std::abs(rate) < 1e-3 * kSpeed, limit << ": " << rate);
      });
    }
  }
}

// 4 rad beyond the start, behind which the shorter way would lead to 2.28 rad. Damped, so that it comes to rest there.
BOOST_AUTO_TEST_CASE(springs_and_servos_between_limits_count_turns) {
  Scene scene = wheel(-4.5, 0.5, true);
  scene.bodies[0].angular_velocity.setZero();
  Scene servo = scene;
  scene.joints[0].stiffness = 2, scene.joints[0].damping = 2, scene.joints[0].rest = -4;
  check_pulled(scene, -4);
  servo.motors = {{.joint = 0, .servo = Servo{.target = TimeTable::constant(-4), .kp = 2, .kd = 2}}};
  check_pulled(servo, -4);
}

BOOST_AUTO_TEST_SUITE_END()
