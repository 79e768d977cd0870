// Limits of joints and motors of given speed, against closed forms, with methods that take joints.
#include "core/dynamics/integrators/joint_events.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_integrators_joint_events)

namespace {

constexpr double kHalfTurn = std::numbers::pi;

// A block of 2 kg on a rail along x.
Scene rail(double lower, double upper, double restitution) {
  Scene scene;
  scene.bodies = {test::body("block", 2, {0.1, 0.2, 0.3})};
  scene.joints = {{kWorld, 0, SliderJoint{Vec3::UnitX()}}};
  scene.joints[0].lower = lower, scene.joints[0].upper = upper, scene.joints[0].restitution = restitution;
  return scene;
}

// A wheel of 0.5 kg m² about an axis that lies across its own and W's, with a motor.
Scene wheel(const Motor& motor) {
  Scene scene;
  scene.bodies = {test::body("wheel", 2, {0.5, 0.5, 0.5}, {1, 2, 3})};
  scene.bodies[0].orientation = Quat(0.8, 0.2, -0.4, 0.4).normalized();
  scene.joints = {{kWorld, 0, HingeJoint{{1, 2, 3}, Vec3(1, 2, 2) / 3}}};
  scene.motors = {motor};
  return scene;
}

Motor motor_of_speed(double speed, double most) {
  Motor motor{};
  motor.speed = speed, motor.most = most;
  return motor;
}

struct Coordinate {
  double x, rate;
};
Coordinate coordinate(const Scene& scene, const BodyTable& state) {
  const auto value = JointCoordinate(scene, scene.joints[0]).at(state.columns());
  return {value.x, value.rate};
}
Coordinate after(const Scene& scene, const std::string& method, double dt, double end) {
  return coordinate(scene, test::state_after(scene, method, dt, end));
}

template <typename Visit>
void for_each_method_with_joints(const Visit& visit) {
  int methods = 0;
  for (const Integrator& row : integrators()) {
    if (!row.takes_joints) continue;
    ++methods;
    BOOST_TEST_CONTEXT(row.name) { visit(row); }
  }
  BOOST_TEST(methods >= 9);
}

// A quarter of a pendulum's period with an amplitude of theta, w0² = m g d / I about the hinge.
double quarter_period(double theta, double w0) { return std::comp_ellint_1(std::sin(theta / 2)) / w0; }

}  // namespace

// Without forces every method's motion is exact between impacts. Rounding of thirty of them in three steps.
BOOST_AUTO_TEST_CASE(a_block_goes_to_and_fro_between_two_stops) {
  Scene scene = rail(-0.5, 0.5, 1);
  scene.bodies[0].velocity = {10, 0, 0};
  for_each_method_with_joints([&](const Integrator& row) {
    const Coordinate at = after(scene, row.name, 1, 3);
    // 3 s: x = 30 m of way from 0, there and back in 2 m; the steps are of 1 s.
    BOOST_TEST(std::abs(at.x - 0) < 1e-11);
    BOOST_TEST(std::abs(at.rate - 10) < 1e-11);
  });
}

// Of speed v, e v, e² v … between stops 1 m apart: the third impact at 0.5/v + 1/(e v) + 1/(e² v).
BOOST_AUTO_TEST_CASE(each_impact_takes_its_share_of_the_speed) {
  Scene scene = rail(-0.5, 0.5, 0.8);
  scene.bodies[0].velocity = {-2, 0, 0};
  const double third = 0.25 + 1 / 1.6 + 1 / 1.28, left = 2 - third;
  for_each_method_with_joints([&](const Integrator& row) {
    const Coordinate at = after(scene, row.name, 0.1, 2);
    BOOST_TEST(std::abs(at.rate - 1.024) < 1e-12);
    BOOST_TEST(std::abs(at.x - (-0.5 + 1.024 * left)) < 1e-12);
  });
}

// A rod released from the horizontal meets a stop at its lowest point: sin(theta_n/2) = e^n sin(theta_0/2), with
// quarter periods between the impacts and the tops.
BOOST_AUTO_TEST_CASE(a_pendulum_at_a_stop_keeps_the_closed_forms_times_and_energies) {
  Scene scene = test::suite_scene("joints/pendulum-90");
  scene.joints[0].lower = -kHalfTurn / 2, scene.joints[0].restitution = 0.6;
  const double I = 0.08354166666666667 + 0.25, w0 = std::sqrt(9.81 * 0.5 / I);
  double theta = kHalfTurn / 2, t = quarter_period(theta, w0);
  for (int n = 1; n <= 3; ++n) {
    const double e = 0.6;
    theta = 2 * std::asin(e * std::sin(theta / 2));
    const double top = t + quarter_period(theta, w0);
    const BodyTable state = test::state_after(scene, "dormand-prince", top / 50, top);
    const Coordinate at = coordinate(scene, state);
    // Inner steps of 1e-12 each, some hundred of them; the rate is that of a place where it turns.
    BOOST_TEST(std::abs(at.x - (theta - kHalfTurn / 2)) < 1e-10);
    BOOST_TEST(std::abs(at.rate) < 1e-9);
    const double lowest = -0.5 * 9.81, top_energy = 0.5 * 9.81 * -std::cos(theta);
    BOOST_TEST(std::abs(energy(scene, state.columns()) - top_energy) < 1e-10);
    BOOST_TEST(std::abs((energy(scene, state.columns()) - lowest) - std::pow(e, 2 * n) * -lowest) < 1e-10);
    t = top + quarter_period(theta, w0);
  }
}

// Events are located to 1e-15 of a step, so only the method's own error remains. Steps of other lengths at each event
// change the error's factor. Over two halvings the error must fall by at least half of what the order predicts.
BOOST_AUTO_TEST_CASE(methods_keep_their_order_across_an_impact) {
  Scene scene = test::suite_scene("joints/pendulum-90");
  scene.joints[0].lower = -kHalfTurn / 2, scene.joints[0].restitution = 0.6;
  const double w0 = std::sqrt(9.81 * 0.5 / (0.08354166666666667 + 0.25));
  const double theta = 2 * std::asin(0.6 * std::sin(kHalfTurn / 4));
  const double top = quarter_period(kHalfTurn / 2, w0) + quarter_period(theta, w0);
  for_each_method_with_joints([&](const Integrator& row) {
    if (row.adaptive) return;
    const auto error = [&](int steps) {
      const Coordinate at = after(scene, row.name, top / steps, top);
      return std::hypot(at.x - (theta - kHalfTurn / 2), at.rate);
    };
    const int steps = row.order == 1 ? 400 : row.order == 8 ? 10 : 80;
    const double coarse = error(steps), fine = error(4 * steps);
    BOOST_TEST_CONTEXT(coarse << " to " << fine) {
      BOOST_TEST((fine < 2 * coarse / std::pow(4, row.order) || fine < 1e-11));
    }
  });
}

// Under gravity along the rail it falls to the stop, bounces ever less, and stays there from
// sqrt(2 d/g) (1 + 2 e/(1 - e)) on.
BOOST_AUTO_TEST_CASE(bounces_come_to_rest_at_the_stop) {
  Scene scene = rail(-1, 10, 0.5);
  scene.gravity = {-9.81, 3, 0};
  const double rest = std::sqrt(2 / 9.81) * 3;
  for_each_method_with_joints([&](const Integrator& row) {
    // Explicit Euler goes on at a bounce's speed for the whole step that it is in, and so never comes to rest.
    if (row.name == "explicit-euler") return;
    const Coordinate at = after(scene, row.name, 0.01, 2);
    BOOST_TEST(rest < 1.4);
    BOOST_TEST(std::abs(at.x + 1) < 1e-11);
    BOOST_TEST(std::abs(at.rate) < 1e-10);
  });
}

// A body at rest on a stop is carried by it, and leaves as soon as a force pulls it away: here a force that begins at
// 0.5 s.
BOOST_AUTO_TEST_CASE(a_stop_carries_and_does_not_hold_back) {
  Scene scene = rail(0, 10, 0);
  scene.gravity = {-9.81, 0, 0};
  System system(scene);
  Joints joints(scene, system);
  JointStops stops(scene, system, system.loads, joints);
  BodyTable state(1);
  set_initial_state(scene, state.columns());
  stops.read(state.columns(), 0);
  BOOST_TEST(stops.settle(state.columns(), 0, 0));
  BOOST_TEST(std::abs(joints.coordinate_effort(0) - 2 * 9.81) < 1e-12);

  TimedForce pull;
  pull.body = 0, pull.force = {2 * 9.81 + 4, 0, 0}, pull.from = 0.5;
  scene.forces = {pull};
  const Coordinate at = after(scene, "dormand-prince", 0.1, 1.5);
  BOOST_TEST(std::abs(at.x - 1) < 1e-9);  // 2 m/s² for 1 s
  BOOST_TEST(std::abs(at.rate - 2) < 1e-9);
}

// Up to a top that is 1 mm over the stop and back within one step of half a second.
BOOST_AUTO_TEST_CASE(what_goes_over_a_stop_and_back_within_a_step_has_hit_it) {
  Scene scene = rail(-10, 0.2, 1);
  scene.gravity = {-9.81, 0, 0};
  scene.bodies[0].velocity = {std::sqrt(2 * 9.81 * 0.201), 0, 0};
  const double hit = std::sqrt(2 * 9.81 * 0.001), t = (scene.bodies[0].velocity.x() - hit) / 9.81, left = 0.5 - t;
  const Coordinate at = after(scene, "dormand-prince", 0.5, 0.5);
  BOOST_TEST(std::abs(at.x - (0.2 - hit * left - 0.5 * 9.81 * left * left)) < 1e-10);
}

// 2 N m on 0.5 kg m² make 3 rad/s in 0.75 s; from 2 s on the wheel goes on by itself.
BOOST_AUTO_TEST_CASE(a_motor_comes_to_its_speed_and_keeps_it) {
  Motor motor = motor_of_speed(3, 2);
  motor.until = 2;
  const Scene scene = wheel(motor);
  const double x = 1.125 + 3 * (2.5 - 0.75) - 2 * kHalfTurn;
  for_each_method_with_joints([&](const Integrator& row) {
    const Coordinate at = after(scene, row.name, 0.05, 2.5);
    // Deviations from the motor's speed are errors of the method, 1.1 rad on the way up and 1.5 rad after it. For first
    // order half a step, 3 rad/s · 0.025 s; for the discrete rotation of moser-veselov at most (0.15 rad)²/6 of it, for
    // rk4 its fifth power.
    const double allowed = row.order == 1 ? 0.08 : row.name == "moser-veselov" ? 1e-2 : row.name == "rk4" ? 8e-5 : 1e-9;
    BOOST_TEST(std::abs(at.rate - 3) < 1e-9);
    BOOST_TEST(std::abs(at.x - x) < allowed);
  });
}

// A spring resists as the wheel rotates. The motor keeps 0.5 rad/s until k x = most, and then pushes with most against
// an oscillation about most/k of amplitude 0.5/w.
BOOST_AUTO_TEST_CASE(a_motor_that_is_too_weak_pushes_with_all_it_has) {
  Scene scene = wheel(motor_of_speed(0.5, 2));
  scene.joints[0].stiffness = 2;
  scene.bodies[0].angular_velocity = 0.5 * Vec3(1, 2, 2) / 3;
  const double w = std::sqrt(2 / 0.5), t = 2.7 - 2;  // it has its speed from the start, and needs all at x = 1, 2 s
  const Coordinate at = after(scene, "dormand-prince", 0.1, 2.7);
  BOOST_TEST(std::abs(at.x - (1 + 0.5 / w * std::sin(w * t))) < 1e-9);
  BOOST_TEST(std::abs(at.rate - 0.5 * std::cos(w * t)) < 1e-9);
}

// As a brake (speed 0) it holds a pendulum that weighs less than it, for ever and at its place.
// No step of its own looks for events then, and the motion is the same.
BOOST_AUTO_TEST_CASE(a_servo_without_a_bound_moves_as_one_that_never_reaches_its_bound) {
  const auto is_same = [](const std::string& method, double kd) {
    Motor free{};
    free.servo = Servo{.target = TimeTable::constant(1), .kp = 8, .kd = kd, .target_speed = 0.2};
    Motor bounded = free;
    bounded.servo->most = 1e6;
    const auto [x, rate] = after(wheel(free), method, 0.01, 2);
    const auto [other, other_rate] = after(wheel(bounded), method, 0.01, 2);
    BOOST_TEST(std::abs(x - other) < 1e-13);
    BOOST_TEST(std::abs(rate - other_rate) < 1e-12);
    BOOST_TEST(std::abs(x) > 0.1);
  };
  for_each_method_with_joints([&](const Integrator& method) { is_same(method.name, 0); });
  for (const char* method : {"dormand-prince", "rk4", "semi-implicit-euler"}) is_same(method, 0.5);
}

BOOST_AUTO_TEST_CASE(a_motor_of_no_speed_is_a_brake) {
  Scene scene = test::suite_scene("joints/pendulum-90");
  for_each_method_with_joints([&](const Integrator& row) {
    scene.motors = {motor_of_speed(0, 5)};  // m g d = 4.905
    const Coordinate held = after(scene, row.name, 0.05, 5);
    // A velocity of the last bit of the speeds within a step, 0.2 m/s, may remain in each of a hundred steps.
    BOOST_TEST(std::abs(held.x) < 1e-13);
    BOOST_TEST(std::abs(held.rate) < 1e-13);
  });
  // One too weak slips: its work is missing from the energy, I w²/2 = m g d sin x - most x.
  scene.motors = {motor_of_speed(0, 2)};
  const Coordinate slips = after(scene, "dormand-prince", 0.05, 0.3);
  const double x = -slips.x, I = 0.08354166666666667 + 0.25;
  BOOST_TEST(x > 0.3);
  BOOST_TEST(std::abs(0.5 * I * slips.rate * slips.rate - (4.905 * std::sin(x) - 2 * x)) < 1e-10);
}

// Three and a half turns to a limit at 22 rad, against which the motor goes on to push.
BOOST_AUTO_TEST_CASE(limits_count_whole_turns) {
  Scene scene = wheel(motor_of_speed(5, 2));
  scene.joints[0].upper = 22;
  for_each_method_with_joints([&](const Integrator& row) {
    const Coordinate at = after(scene, row.name, 0.1, 6);
    BOOST_TEST(std::abs(at.x - (22 - 8 * kHalfTurn + 2 * kHalfTurn * (22 - 8 * kHalfTurn < -kHalfTurn))) < 1e-11);
    BOOST_TEST(std::abs(at.rate) < 1e-11);
  });
}

// In a loop the row of a coordinate may be one too many: a motor on each hinge of a four-bar, of which one is enough.
BOOST_AUTO_TEST_CASE(motors_on_more_joints_than_there_are_freedoms_do_not_break_the_joints) {
  Scene scene = test::suite_scene("mechanisms/four-bar");
  for (int k = 0; k < 4; ++k) {
    Motor motor = motor_of_speed(k == 0 ? 2 : -1.5, 1e4);
    motor.joint = k;
    scene.motors.push_back(motor);
  }
  const System system(scene);
  Joints joints(scene, system);
  const BodyTable end = test::state_after(scene, "rk4", 1e-3, 1);
  BOOST_TEST(joints.gap(end.columns()) < 1e-12);
}

// Three links with stops at each hinge: hundreds of impacts, many with another limit held, until they swing as one. The
// energy of a staggered method is off by m g v h/2; the others err by less than a ten-millionth of the 0.3 J in play.
BOOST_AUTO_TEST_CASE(stops_of_a_chain_never_give_energy) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  for (int i = 0; i < 3; ++i) {
    scene.bodies.push_back(test::body("link" + std::to_string(i), 0.1, {1e-5, 1e-4, 1e-4}, {0.1 * i + 0.05, 0, 0}));
    scene.joints.push_back({i - 1, i, HingeJoint{{0.1 * i, 0, 0}, Vec3::UnitZ()}});
    scene.joints[i].lower = i > 0 ? -0.5 : -2.5, scene.joints[i].upper = 0.5, scene.joints[i].restitution = 0.3;
  }
  for (const char* method : {"semi-implicit-euler", "velocity-verlet", "rk4"}) {
    const auto world = CoreEngine().load(scene, {.method = method, .options = {}});
    Snapshot now;
    double largest = -1;
    for (int n = 0; n < 1000; ++n) {
      world->step(0.005);
      BOOST_TEST_REQUIRE(world->solver_warning() == "");
      world->read(now);
      largest = std::max(largest, energy(scene, now.bodies()));
    }
    BOOST_TEST_CONTEXT(method) { BOOST_TEST(largest < (method == std::string("semi-implicit-euler") ? 5e-3 : 3e-8)); }
  }
}

BOOST_AUTO_TEST_CASE(steps_back_in_time_are_refused) {
  const Scene scene = rail(-1, 1, 0.5);
  const auto world = CoreEngine().load(scene, {.method = "rk4", .options = {}});
  world->step(-0.1);
  BOOST_TEST((world->solver_warning().find("back in time") != std::string::npos));
}

// Released straight, it hits its limits until each hinge rests at its own. Some bounces end at once because the other
// limits hold; otherwise there would be a thousand in a step.
BOOST_AUTO_TEST_CASE(a_chain_with_limits_on_every_hinge_comes_to_rest_on_them) {
  constexpr double kLimit = 0.2, kLength = 0.2;  // rad, m
  for (const double restitution : {0.3, 0.6}) {
    Scene scene;
    scene.gravity = {0, -9.81, 0};
    double x = 0, y = 0, angle = 0;
    std::vector<Vec3> at_rest;
    for (int i = 0; i < 6; ++i) {
      scene.bodies.push_back(
          test::body("link " + std::to_string(i), 0.5, {1e-4, 2e-3, 2e-3}, {kLength * (i + 0.5), 0, 0}));
      scene.joints.push_back({i - 1, i, HingeJoint{{kLength * i, 0, 0}, Vec3::UnitZ()}});
      scene.joints[i].lower = -kLimit, scene.joints[i].upper = kLimit, scene.joints[i].restitution = restitution;
      angle -= kLimit;
      const double dx = kLength * std::cos(angle), dy = kLength * std::sin(angle);
      at_rest.emplace_back(x + 0.5 * dx, y + 0.5 * dy, 0);
      x += dx, y += dy;
    }
    for (const char* method : {"semi-implicit-euler", "rk4"}) {
      const BodyTable end = test::state_after(scene, method, 1.0 / 240, 1);  // a warning fails
      BOOST_TEST_CONTEXT(method << ", restitution " << restitution) {
        for (int i = 0; i < 6; ++i) {
          // Limits hold to 1e-11 rad each, and semi-implicit Euler's joints to as much of an arm.
          BOOST_TEST((end.columns().position(i) - at_rest[i]).norm() < 1e-10);
          BOOST_TEST(end.columns().angular_velocity(i).norm() < 1e-8);
        }
      }
    }
  }
}

// An arm swings up and falls onto its stops, elbow and shoulder in turn. Each impact of one throws the other off, less
// each time. These flights never end; their limit is rest at both.
BOOST_AUTO_TEST_CASE(two_stops_that_throw_each_other_off_come_to_rest) {
  Scene scene;
  scene.bodies = {test::body("upper", 0.15, Vec3::Constant(0.003), {0.25, 0, 0}),
                  test::body("lower", 7.97, Vec3::Constant(0.5997), {0.48, 0.39, 0})};
  const Vec3 spin(0, 0, 1.17);
  for (Body& body : scene.bodies) body.angular_velocity = spin, body.velocity = spin.cross(body.position);
  scene.joints = {{kWorld, 0, HingeJoint{Vec3::Zero(), Vec3::UnitZ()}}, {0, 1, HingeJoint{{0.5, 0, 0}, Vec3::UnitZ()}}};
  for (Joint& joint : scene.joints) joint.lower = 0, joint.upper = 1;
  scene.gravity = {0, -9.81, 0};
  for (const char* method : {"rk4", "dormand-prince"}) {
    const BodyTable end = test::state_after(scene, method, 1.0 / 240, 3);
    const Vec3 elbow(0.5, 0, 0), lower = elbow + rotation_by({0, 0, 1}) * (scene.bodies[1].position - elbow);
    BOOST_TEST((end.columns().position(0) - scene.bodies[0].position).norm() < 1e-9);
    BOOST_TEST((end.columns().position(1) - lower).norm() < 1e-9);
    for (std::size_t i = 0; i < 2; ++i) BOOST_TEST(end.columns().velocity(i).norm() < 1e-9);
  }
}

BOOST_AUTO_TEST_SUITE_END()
