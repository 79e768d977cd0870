// Joints and their limits among contacts: impacts and forces act through the mechanism, and a limit is a contact
// without friction.
#include <functional>
#include <numbers>

#include "core/dynamics/joints/joints.h"
#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/contact_runs.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_jointed_contact)

namespace {

constexpr double kG = 9.81;

class JointedRun {
 public:
  explicit JointedRun(const Scene& scene, const std::string& method = "dormand-prince",
                      std::map<std::string, std::string> options = {{"contact", "event"}})
      : world_(CoreEngine().load(scene, {.method = method, .options = std::move(options)})) {}

  BodyColumns step(double dt) {
    step_until(*world_, dt, dt);
    world_->read(snapshot_);
    return snapshot_.bodies();
  }
  const World& world() const { return *world_; }

 private:
  std::unique_ptr<World> world_;
  Snapshot snapshot_;
};

// A rod on a hinge with a stop at its lowest point, over a floor that it never meets.
Scene rod_at_stop() {
  Scene scene = suite_scene("joints/pendulum-at-stop");
  scene.bodies[0].collides = true;
  scene.bodies.push_back(floor_at(Vec3::UnitY(), -5));
  return scene;
}

// A flap, level on the lower stop of its hinge at the world's origin.
Scene flap(const ContactLaw& law) {
  Scene scene;
  scene.gravity = {0, -kG, 0};
  scene.bodies = {solid("flap", Box{{1, 0.05, 0.3}}, {0.5, 0, 0}), floor_at(Vec3::UnitY(), -2)};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}, .lower = 0, .upper = 0.6}};
  scene.contact_default = law;
  return scene;
}

double angle_about_z(BodyColumns state, std::size_t body) {
  return std::atan2(state.rotation(body)(1, 0), state.rotation(body)(0, 0));
}

// The largest rise of the energy above what it ever was, of its size at first, in steps of dt until t.
double largest_gain(
    const Scene& scene, JointedRun& run, double dt, double t,
    const std::function<void(BodyColumns)>& look = [](BodyColumns) {}) {
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  const double first = energy(scene, std::as_const(start).columns());
  double least = first, gain = 0;
  for (int n = 0; n < std::lround(t / dt); ++n) {
    const BodyColumns state = run.step(dt);
    const double now = energy(scene, state);
    gain = std::max(gain, now - least), least = std::min(least, now);
    look(state);
  }
  return gain / std::abs(first);
}

// An arm of 1 m and 1 kg, level on a hinge along z, that a motor lifts over a floor it never meets.
Scene lifted_arm(double speed, double most) {
  Scene scene;
  scene.gravity = {0, -kG, 0};
  scene.bodies = {solid("arm", Box{{1, 0.05, 0.05}}, {0.5, 0, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}, .damping = 0.1}};
  scene.motors = {{.joint = 0, .speed = speed, .most = most, .from = 0.1, .until = 1.3}};
  return scene;
}

Scene over_a_floor(Scene scene) {
  scene.bodies.push_back(floor_at(Vec3::UnitY(), -5));
  return scene;
}

// A pusher of 2 kg on rails along x, half a metre from a box of 1 kg that the floor brakes with 0.4 of its weight.
constexpr double kPusher = 2, kBox = 1, kBraked = 0.4, kSpeed = 1.5, kWay = 0.5;
Scene pushed_box(double most) {
  Scene scene = on_floor({solid("pusher", Box{{0.2, 0.2, 0.1}}, {0, 0, 0.1}, kPusher),
                          solid("box", Box{{0.2, 0.2, 0.2}}, {kWay + 0.2, 0, 0.1}, kBox)},
                         {0, kBraked});
  scene.bodies[0].velocity = {kSpeed, 0, 0};
  scene.joints = {{.a = kWorld, .b = 0, .type = SliderJoint{Vec3::UnitX()}}};
  scene.motors = {{.joint = 0, .speed = kSpeed, .most = most}};
  scene.contact_pairs = {{0, 1, {0, 0}}};
  return scene;
}

}  // namespace

// Each impact leaves e² of the energy above the lowest point, and e = 0.6.
BOOST_AUTO_TEST_CASE(a_rod_leaves_its_stop_with_the_energy_that_restitution_says) {
  const Scene scene = rod_at_stop();
  JointedRun run(scene);
  const double start = 0.5 * kG;  // J
  int impacts = 0;
  for (int n = 0; n < 4 * 240; ++n) {
    const BodyColumns state = run.step(1.0 / 240);
    const Vec3 v = state.velocity(0);
    const double w = state.angular_velocity(0).z();
    const double now =
        0.5 * v.squaredNorm() + 0.5 * scene.bodies[0].inertia(2, 2) * w * w + kG * (state.position(0).y() + 0.5);
    while (now < 0.9 * start * std::pow(0.6, 2 * impacts)) ++impacts;
    // A thousand steps, each held to 1e-12 of 4.9 J.
    BOOST_TEST_CONTEXT("step " << n << ", after " << impacts << " impacts")
    BOOST_TEST(std::abs(now - start * std::pow(0.6, 2 * impacts)) < 1e-9);
    BOOST_TEST(state.position(0).x() > -1e-9);
  }
  BOOST_TEST(impacts >= 3);
}

// The same stops as JointEvents has them, where nothing can touch.
BOOST_AUTO_TEST_CASE(limits_agree_with_those_of_scenes_without_contact) {
  const Scene scene = rod_at_stop(), smooth = suite_scene("joints/pendulum-at-stop");
  for (const auto& [method, bound] : {std::pair("dormand-prince", 1e-10), std::pair("rk4", 1e-7)}) {
    JointedRun by_contact(scene, method), by_stops(smooth, method, {});
    for (int n = 0; n < 4 * 240; ++n) {
      const BodyColumns one = by_contact.step(1.0 / 240), other = by_stops.step(1.0 / 240);
      // rk4 errs by some 1e-8 in either, in parts of a step that end at the same impacts.
      BOOST_TEST_CONTEXT(method << ", step " << n)
      BOOST_TEST(difference(one.body(0), other.body(0)).pose < bound);
    }
  }
}

// A body that falls on a stop and one that falls on a floor of the same restitution move alike until they rest.
BOOST_AUTO_TEST_CASE(a_sled_bounces_on_its_stop_as_a_ball_on_the_floor) {
  Scene scene =
      on_floor({solid("ball", Sphere{0.1}, {3, 0, 1.1}), solid("sled", Box{{0.2, 0.2, 0.2}}, {0, 0, 2.5})}, {0.5, 0});
  scene.joints = {{.a = kWorld, .b = 1, .type = SliderJoint{Vec3::UnitZ()}, .lower = -1, .restitution = 0.5}};
  JointedRun run(scene);
  for (int n = 0; n < 2 * 60; ++n) {
    const BodyColumns state = run.step(1.0 / 60);
    // The sequence ends 2 u/(g (1 - e)) early, from u = 1e-7 m/s on: 1e-15 m.
    BOOST_TEST(std::abs(state.position(0).z() - 0.1 - (state.position(1).z() - 1.5)) < 1e-12, "step " << n);
    if (n > 2 * 50) BOOST_TEST(std::abs(state.position(1).z() - 1.5) < 1e-12);
  }
}

// Two rows for one motion: neither doubles what the other does.
BOOST_AUTO_TEST_CASE(a_stop_and_a_wall_that_are_hit_at_once_act_as_one) {
  const Scene wall = suite_scene("joints/pendulum-at-wall");
  Scene both = wall;
  both.joints[0].lower = -std::numbers::pi / 3, both.joints[0].restitution = wall.contact_default.restitution;
  JointedRun one(wall), two(both);
  for (int n = 0; n < 3 * 60; ++n)
    BOOST_TEST(difference(one.step(1.0 / 60).body(0), two.step(1.0 / 60).body(0)).pose < 1e-11, "step " << n);
}

BOOST_AUTO_TEST_CASE(what_rests_on_its_stop_bears_what_rests_on_it) {
  Scene scene = flap({0, 0.5});
  scene.bodies.push_back(solid("box", Box{{0.2, 0.2, 0.2}}, {0.7, 0.125, 0}, 3));
  JointedRun run(scene), rk4(scene, "rk4");
  for (int n = 0; n < 60; ++n) {
    for (JointedRun* each : {&run, &rk4}) {
      const BodyColumns state = each->step(1.0 / 30);
      for (const std::size_t i : {0, 2}) {
        BOOST_TEST((state.position(i) - scene.bodies[i].position).norm() < 1e-12);
        BOOST_TEST(state.velocity(i).norm() < 1e-12);
      }
    }
  }
  // Without the stop nothing bears them.
  scene.joints[0].lower = -1;
  JointedRun falling(scene);
  for (int n = 0; n < 15; ++n) falling.step(1.0 / 30);
  BOOST_TEST(angle_about_z(falling.step(1.0 / 30), 0) < -0.1);
}

BOOST_AUTO_TEST_CASE(a_ball_that_beats_a_flap_on_its_stop_adds_no_energy) {
  for (const char* method : {"rk4", "dormand-prince", "velocity-verlet"}) {
    Scene scene = flap({0.4, 0.3});
    scene.joints[0].restitution = 0.3;
    scene.bodies.push_back(solid("ball", Sphere{0.05}, {0.7, 0.6, 0}, 0.3));
    JointedRun run(scene, method);
    double lowest = 0, highest = 0;
    const auto look = [&](BodyColumns state) {
      lowest = std::min(lowest, angle_about_z(state, 0)), highest = std::max(highest, angle_about_z(state, 0));
    };
    // rkmk4, which holds what velocity-verlet and rk4 do, errs by (w h)^5 = 1e-9 in a step of the flap's swing.
    BOOST_TEST(largest_gain(scene, run, 1.0 / 120, 3, look) < 1e-9, method);
    BOOST_TEST(lowest > -1e-12);
    BOOST_TEST(highest < 0.6 + 1e-12);
    const BodyColumns end = run.step(1.0 / 120);
    BOOST_TEST(end.velocity(0).norm() < 1e-9);
    BOOST_TEST(end.velocity(2).norm() < 1e-9);
    BOOST_TEST(std::abs(end.position(2).y() - 0.075) < 1e-7);  // on the flap
  }
}

// 20 rad at 15 rad/s, and back at half of it.
BOOST_AUTO_TEST_CASE(a_stop_three_turns_away_is_reached_after_three_turns) {
  Scene scene = flap({0, 0});
  scene.gravity.setZero();
  scene.joints[0].upper = 20, scene.joints[0].restitution = 0.5;
  scene.bodies[0].angular_velocity = {0, 0, 15};
  scene.bodies[0].velocity = {0, 7.5, 0};
  JointedRun run(scene);
  double angle = 0;
  for (int n = 1; n <= 75; ++n) {
    const double t = n / 30.0, hit = 20.0 / 15;
    angle = angle_about_z(run.step(1.0 / 30), 0);
    const double expected = t < hit ? 15 * t : 20 - 7.5 * (t - hit);
    BOOST_TEST(std::abs(std::remainder(angle - expected, 2 * std::numbers::pi)) < 1e-10, "at " << t);
  }
}

// Ten bodies, nine joints, four of them with limits, and springs.
BOOST_AUTO_TEST_CASE(a_doll_that_falls_keeps_its_joints_and_gains_nothing) {
  const Scene scene = suite_scene("mechanisms/ragdoll-on-floor");
  JointedRun run(scene, "rk4");
  // Springs swing at up to 30/s: rk4 errs by 1e-8 of the energy in a step of 1/240 s.
  BOOST_TEST(largest_gain(scene, run, 1.0 / 240, 1) < 1e-6);
  System system(scene);
  Joints joints(scene, system);
  Snapshot now;
  run.world().read(now);
  BOOST_TEST(joints.gap(now.bodies()) < 1e-12);
}

// The motors of JointEvents's tests, in a scene without contact: one that is strong enough, one that reaches its speed
// and loses it as the arm rises, one that never lifts the arm.
BOOST_AUTO_TEST_CASE(motors_agree_with_those_of_scenes_without_contact) {
  for (const auto& [speed, most] : {std::pair(2.0, 20.0), std::pair(-1.0, 5.2), std::pair(3.0, 5.2)}) {
    const Scene smooth = lifted_arm(speed, most), scene = over_a_floor(smooth);
    for (const auto& [method, bound] : {std::pair("dormand-prince", 1e-10), std::pair("rk4", 1e-7)}) {
      JointedRun by_contact(scene, method), by_stops(smooth, method, {});
      for (int n = 0; n < 2 * 120; ++n) {
        const BodyColumns one = by_contact.step(1.0 / 120), other = by_stops.step(1.0 / 120);
        // rk4 errs by some 1e-8 in either, in parts of a step that end at the same events.
        BOOST_TEST_CONTEXT(method << ", " << speed << " rad/s, " << most << " N m, step " << n)
        BOOST_TEST(difference(one.body(0), other.body(0)).pose < bound);
      }
    }
  }
}

// The motor has no part in the impact, after which both go at 2/3 of its speed. Then it pushes with all it has, until
// they have its speed, which it keeps with what the floor takes.
BOOST_AUTO_TEST_CASE(a_motor_comes_back_to_its_speed_after_an_impact) {
  const double hit = kWay / kSpeed, after = kSpeed * kPusher / (kPusher + kBox);
  constexpr double kMost = 7;  // N
  const double acceleration = (kMost - kBraked * kBox * kG) / (kPusher + kBox),
               again = hit + (kSpeed - after) / acceleration;
  const auto expected = [&](double t) {
    if (t < hit) return kSpeed * t;
    const double pushing = std::min(t, again) - hit;
    return kWay + after * pushing + 0.5 * acceleration * pushing * pushing + kSpeed * std::max(0.0, t - again);
  };
  for (const char* method : {"dormand-prince", "rk4", "velocity-verlet"}) {
    JointedRun run(pushed_box(kMost), method);
    for (int n = 1; n <= 40; ++n) {
      const double x = run.step(1.0 / 30).position(0).x();
      // Straight lines and parabolas: every method is exact, but for the instants of events, 1e-14 of a step.
      BOOST_TEST(std::abs(x - expected(n / 30.0)) < 1e-11, method << " at " << n / 30.0);
    }
    BOOST_TEST(again < 40 / 30.0);
  }
}

// 3 N do not overcome 3.9 N: both stop after the impact, and the motor goes on pressing.
BOOST_AUTO_TEST_CASE(a_motor_too_weak_for_friction_stalls) {
  constexpr double kMost = 3;
  const double hit = kWay / kSpeed, after = kSpeed * kPusher / (kPusher + kBox),
               braking = (kBraked * kBox * kG - kMost) / (kPusher + kBox), stop = after / braking;
  JointedRun run(pushed_box(kMost));
  double x = 0;
  for (int n = 1; n <= 30 * 5; ++n) x = run.step(1.0 / 30).position(0).x();
  BOOST_TEST(hit + stop < 5);
  BOOST_TEST(std::abs(x - kWay - 0.5 * after * stop) < 1e-10);
}

// A motor that would fold a flap into its stop stays there with what it has, and lets it fall when it is off.
BOOST_AUTO_TEST_CASE(a_motor_holds_what_it_drives_at_a_stop_until_it_is_off) {
  Scene scene = flap({0, 0});
  scene.motors = {{.joint = 0, .speed = 1.0, .most = 20, .until = 1}};
  JointedRun run(scene);
  for (int n = 1; n <= 60; ++n) {
    const double t = n / 30.0, angle = angle_about_z(run.step(1.0 / 30), 0);
    if (t < 0.55) BOOST_TEST(angle > 0.0);
    if (t > 0.65 && t <= 1) BOOST_TEST(std::abs(angle - 0.6) < 1e-11, "at " << t);
    if (t > 1.9) BOOST_TEST(std::abs(angle) < 1e-10, "at " << t);
  }
}

BOOST_AUTO_TEST_SUITE_END()
