// The closed forms that contact by events must meet. If forces are constant between events, the method is exact with an
// integrator of second order. The tolerances are those of rounding, of the end of a bounce sequence (1e-7 m/s) and of a
// stop (1e-9 m/s).
#include <cmath>
#include <numbers>

#include "core/dynamics/model/energy.h"
#include "core/scene/turned.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_event)

namespace {

constexpr double kG = 9.81;

int steps_to(double t, double dt) { return static_cast<int>(std::lround(t / dt)); }

}  // namespace

BOOST_AUTO_TEST_CASE(bounces_keep_their_heights_and_end_at_the_right_instant) {
  const double h = 1, r = 0.1;
  for (const double dt : {1.0 / 30, 1.0 / 1000}) {
    for (const auto& [e, rest] : {std::pair(0.5, 1.354571), std::pair(0.8, 4.063713)}) {
      BOOST_TEST_CONTEXT("e = " << e << ", dt = " << dt) {
        ContactRun run(on_floor({solid("ball", Sphere{r}, {0, 0, h + r})}, {e, 0}), "event");
        const double first = std::sqrt(2 * h / kG);
        // The first apex, e² h, at first (1 + e): reached by a step of its own length.
        run.step(first * (1 + e));
        BOOST_TEST(std::abs(run.state().position(0).z() - r - e * e * h) < 1e-13);
        ContactRun again(on_floor({solid("ball", Sphere{r}, {0, 0, h + r})}, {e, 0}), "event");
        again.run(dt, steps_to(rest, dt) - 1);
        const double speed_left = again.state().velocity(0).norm();
        BOOST_TEST((speed_left > 0 || dt * (steps_to(rest, dt) - 1) > rest - 1e-6));
        while (again.time() < rest) again.step(dt);
        again.step(dt);
        BOOST_TEST(again.state().velocity(0).norm() < 1e-12);
        BOOST_TEST(std::abs(again.state().position(0).z() - r) < 1e-12);
        BOOST_TEST(again.solver_warning() == "");
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_hundred_elastic_bounces_keep_the_energy) {
  const Scene scene = on_floor({solid("ball", Sphere{0.1}, {0, 0, 1.1})}, {1, 0});
  for (const char* integrator : {"velocity-verlet", "rk4", "implicit-midpoint"}) {
    ContactRun run(scene, "event", integrator);
    const double start = rigor::energy(scene, run.state());
    run.run(1.0 / 30, steps_to(100 * 2 * std::sqrt(2 / kG), 1.0 / 30));
    // A root of the gap is right to some 1e-15 m, which at 4.4 m/s is worth 1e-15 m of height: 1e-13 over 100 bounces.
    BOOST_TEST(std::abs(rigor::energy(scene, run.state()) / start - 1) < 1e-12, integrator);
    BOOST_TEST(run.solver_warning() == "");
  }
}

BOOST_AUTO_TEST_CASE(a_sliding_box_stops_where_coulomb_says_in_every_direction) {
  const double v0 = 5, mu = 0.5, stop = v0 * v0 / (2 * mu * kG);
  for (const double dt : {1.0 / 30, 1.0 / 1000}) {
    for (int degrees = 0; degrees <= 90; degrees += 15) {
      const double angle = degrees * std::numbers::pi / 180;
      Body box = solid("box", Box{{0.4, 0.4, 0.2}}, {0, 0, 0.1});
      box.velocity = v0 * Vec3(std::cos(angle), std::sin(angle), 0);
      ContactRun run(on_floor({box}, {0, mu}), "event");
      run.run(dt, steps_to(1.2, dt));
      const Vec3 p = run.state().position(0);
      BOOST_TEST_CONTEXT("dt = " << dt << ", " << degrees << " degrees, solver_warning: " << run.solver_warning()) {
        BOOST_TEST((p - Vec3(stop * std::cos(angle), stop * std::sin(angle), 0.1)).norm() < 1e-9);
        BOOST_TEST(run.state().velocity(0).norm() < 1e-9);
        BOOST_TEST(angle_between(run.state().orientation(0), Quat::Identity()) < 1e-9);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_sliding_ball_comes_to_roll) {
  const double v0 = 10, mu = 0.3, r = 0.1;
  const double t_roll = 2 * v0 / (7 * mu * kG), x_roll = 12 * v0 * v0 / (49 * mu * kG);
  BOOST_TEST(std::abs(t_roll - 0.970827) < 1e-6);
  for (const double dt : {1.0 / 30, 1.0 / 1000}) {
    Body ball = solid("ball", Sphere{r}, {0, 0, r});
    ball.velocity = {v0, 0, 0};
    ContactRun run(on_floor({ball}, {0, mu}), "event");
    run.run(dt, steps_to(2, dt));
    const double expected = x_roll + 5.0 / 7 * v0 * (2 - t_roll);
    BOOST_TEST(std::abs(run.state().position(0).x() - expected) < 1e-9, dt);
    BOOST_TEST(std::abs(run.state().velocity(0).x() - 5.0 / 7 * v0) < 1e-9, dt);
    BOOST_TEST((run.state().angular_velocity(0) - Vec3(0, 5.0 / 7 * v0 / r, 0)).norm() < 1e-8, dt);
  }
}

BOOST_AUTO_TEST_CASE(on_a_slope_bodies_hold_slide_and_roll_as_they_must) {
  const double theta = std::atan(0.5), t = 2, dt = 1.0 / 30;
  const Vec3 gravity = kG * Vec3(std::sin(theta), 0, -std::cos(theta));
  for (const double mu : {0.2, 0.49, 0.50001, 0.7}) {
    ContactRun run(on_floor({solid("box", Box{{0.4, 0.4, 0.2}}, {0, 0, 0.1})}, {0, mu}, gravity), "event");
    run.run(dt, steps_to(t, dt));
    const double a = std::max(0.0, kG * (std::sin(theta) - mu * std::cos(theta)));
    BOOST_TEST(std::abs(run.state().position(0).x() - 0.5 * a * t * t) < 1e-10, "box, mu = " << mu);
  }
  for (const double mu : {0.05, 0.1, 0.15, 0.5}) {  // rolls from mu >= tan(theta) 2/7 = 0.1429 on
    ContactRun run(on_floor({solid("ball", Sphere{0.1}, {0, 0, 0.1})}, {0, mu}, gravity), "event");
    run.run(dt, steps_to(t, dt));
    const double a = std::max(5.0 / 7 * kG * std::sin(theta), kG * (std::sin(theta) - mu * std::cos(theta)));
    BOOST_TEST(std::abs(run.state().position(0).x() - 0.5 * a * t * t) < 1e-10, "ball, mu = " << mu);
  }
}

BOOST_AUTO_TEST_CASE(a_cradle_passes_the_impulse_through) {
  Scene scene;
  for (int i = 0; i < 5; ++i) scene.bodies.push_back(solid("ball " + std::to_string(i), Sphere{0.1}, {0.2 * i, 0, 0}));
  scene.bodies[0].position.x() = -0.5;
  scene.bodies[0].velocity = {2, 0, 0};
  scene.contact_default = {1, 0};
  ContactRun run(scene, "event");
  run.run(1.0 / 30, 30);
  const double hit = 0.5 / 2;  // s
  for (int i = 0; i < 4; ++i) BOOST_TEST(run.state().velocity(i).norm() < 1e-12, i);
  BOOST_TEST((run.state().velocity(4) - Vec3(2, 0, 0)).norm() < 1e-12);
  BOOST_TEST(std::abs(run.state().position(4).x() - (0.8 + 2 * (1 - hit))) < 1e-9);  // ten times the closed gap
}

BOOST_AUTO_TEST_CASE(pairs_part_with_their_restitution_and_keep_their_momenta) {
  for (const double e : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    Scene scene;
    scene.bodies = {solid("left", Sphere{0.5}, {-2, 0.1, 0}, 1), solid("right", Box{{1, 1, 1}}, {2, 0, 0.2}, 3)};
    scene.bodies[0].velocity = {1, 0, 0};
    scene.bodies[1].velocity = {-1, 0, 0};
    scene.bodies[1].angular_velocity = {0.3, 0, 0.5};
    scene.contact_default = {e, 0.4};
    ContactRun run(scene, "event");
    const Vec3 p = linear_momentum(scene, run.state());
    const Vec3 L = angular_momentum(scene, run.state(), Vec3::Zero());
    const double energy = rigor::energy(scene, run.state());
    while (run.state().velocity(0).x() == 1 && run.time() < 3) run.step(1e-3);
    BOOST_TEST((linear_momentum(scene, run.state()) - p).norm() < 1e-13, e);
    BOOST_TEST((angular_momentum(scene, run.state(), Vec3::Zero()) - L).norm() < 1e-9, e);  // the gap closed
    BOOST_TEST(rigor::energy(scene, run.state()) < energy * (1 + 1e-12), e);
    BOOST_TEST(run.state().velocity(0).x() < 0.9, e);  // they did meet
  }
}

BOOST_AUTO_TEST_CASE(a_thin_wall_stops_what_is_fast) {
  Scene scene;
  scene.bodies = {solid("bullet", Box{{1, 1, 1}}, {-7, 0.1, 0.2}), solid("wall", Box{{0.1, 10, 10}}, {0, 0, 0})};
  scene.bodies[0].velocity = {400, 0, 0};
  scene.bodies[1].fixed = true;
  scene.contact_default = {1, 0};
  ContactRun run(scene, "event");
  run.run(1.0 / 30, 3);
  BOOST_TEST(std::abs(run.state().velocity(0).x() + 400) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_stack_of_boxes_stands_still) {
  std::vector<Body> boxes;
  for (int i = 0; i < 5; ++i)
    boxes.push_back(solid("box " + std::to_string(i), Box{{0.4, 0.4, 0.4}}, {0, 0, 0.2 + 0.4 * i}));
  ContactRun run(on_floor(boxes, {0.3, 0.5}), "event");
  run.run(1.0 / 30, 60);
  for (int i = 0; i < 5; ++i) BOOST_TEST((run.state().position(i) - boxes[i].position).norm() < 1e-10, i);
  BOOST_TEST(run.solver_warning() == "");
}

BOOST_AUTO_TEST_CASE(a_stack_of_spheres_comes_to_rest_upright) {
  std::vector<Body> balls;
  for (int i = 0; i < 5; ++i) balls.push_back(solid("ball " + std::to_string(i), Sphere{1}, {0, 0, 1.05 + 2.05 * i}));
  ContactRun run(on_floor(balls, {0.3, 0.5}), "event");
  run.run(1.0 / 30, 300);
  // Gaps are closed to 1e-13 m; a position of nine metres has roundings of 2e-15. An upright tower is unstable: before it
  // lies still, a deviation grows with a rate of some sqrt(2 g / r) = 4.4 / s. In 2.4 s a rounding becomes 8e-11 m.
  for (int i = 0; i < 5; ++i) BOOST_TEST((run.state().position(i) - Vec3(0, 0, 1 + 2 * i)).norm() < 1e-10, i);
  BOOST_TEST(run.state().velocity(4).norm() < 1e-12);
  BOOST_TEST(run.solver_warning() == "");
}

// A board on balls that roll on the floor: each ball goes half as far as the board, F = (M + n (m + I / r²) / 4) a.
BOOST_AUTO_TEST_CASE(a_pushed_board_rolls_on_its_balls) {
  const double r = 0.1, push = 15;
  std::vector<Body> bodies = {solid("board", Box{{1.2, 1.2, 0.2}}, {0, 0, 0.3}, 10)};
  for (int i = 0; i < 9; ++i)
    bodies.push_back(solid("ball " + std::to_string(i), Sphere{r}, {0.22 * (i % 3 - 1), 0.22 * (i / 3 - 1), r}, 1));
  Scene scene = on_floor(bodies, {0, 0.8});
  scene.forces = {{.body = 0, .force = {push, 0, 0}}};
  ContactRun run(scene, "event");
  run.run(1.0 / 30, 9);
  const double a = push / (10 + 9 * 1.4 / 4);
  BOOST_TEST(std::abs(run.state().velocity(0).x() - 0.3 * a) < 1e-9);
  BOOST_TEST(std::abs(run.state().position(0).x() - 0.045 * a) < 1e-9);
  for (int i = 1; i <= 9; ++i) BOOST_TEST(std::abs(run.state().velocity(i).x() - 0.15 * a) < 1e-9, i);
}

BOOST_AUTO_TEST_CASE(what_overlaps_at_the_start_is_moved_apart_without_velocity) {
  ContactRun run(on_floor({solid("ball", Sphere{0.1}, {0, 0, 0.08})}, {1, 0.5}), "event");
  run.run(1.0 / 30, 10);
  BOOST_TEST(std::abs(run.state().position(0).z() - 0.1) < 1e-12);
  BOOST_TEST(run.state().velocity(0).norm() < 1e-12);
}

// Two balls of 0.2 m that graze each other by 0.1 mm, for a thousandth of a second in the middle of a step. They are
// apart at both its ends, and at sub-steps of a part of a ball's radius. The impact exchanges the parts of the
// velocities along the line of centres.
BOOST_AUTO_TEST_CASE(a_graze_inside_a_step_is_not_missed) {
  const double r = 0.1, offset = 0.1999, speed = 10, dt = 1.0 / 30;
  Scene scene;
  scene.gravity = Vec3::Zero();
  scene.contact_default = {1, 0};
  scene.bodies = {solid("left", Sphere{r}, {-0.16, 0, 0}), solid("right", Sphere{r}, {0, offset, 0})};
  scene.bodies[0].velocity = {speed, 0, 0};
  const double along = std::sqrt(4 * r * r - offset * offset);
  const Vec3 n = Vec3(along, offset, 0) / (2 * r), given = speed * n.x() * n;
  const double before = (0.16 - along) / speed, after = dt - before;
  ContactRun run(scene, "event");
  run.step(dt);
  BOOST_TEST((run.state().velocity(1) - given).norm() < 1e-9);  // the graze's angle is a root of the gap's rounding
  BOOST_TEST((run.state().velocity(0) - (Vec3(speed, 0, 0) - given)).norm() < 1e-9);
  BOOST_TEST((run.state().position(1) - (scene.bodies[1].position + after * given)).norm() < 1e-10);
  BOOST_TEST(run.solver_warning() == "");
}

// A ball thrown up falls back to its start within the step; in between it reaches 0.2 mm into a ceiling.
BOOST_AUTO_TEST_CASE(a_ceiling_that_is_touched_between_two_steps_is_felt) {
  const double dt = 1.0 / 30, speed = 0.5 * kG * dt, above = speed * speed / (2 * kG) - 2e-4;
  Scene scene = on_floor({solid("ball", Sphere{0.1}, {0, 0, 1})}, {1, 0});
  scene.bodies[0].velocity = {0, 0, speed};
  scene.bodies.push_back(floor_at(-Vec3::UnitZ(), -(1.1 + above)));
  ContactRun run(scene, "event");
  run.step(dt);
  // It turns back earlier by the time that the rest of the way up and down would have taken.
  const double saved = 2 * std::sqrt(2 * 2e-4 / kG);
  const double expected = 1 - saved * speed - 0.5 * kG * saved * saved;
  BOOST_TEST(std::abs(run.state().position(0).z() - expected) < 1e-12);
  BOOST_TEST(run.solver_warning() == "");
}

// A ball on a spring whose free swing takes one step: without the wall it would end each step where and as it began.
// Elastic, it comes back to the wall after 2 pi - 2 acos(d/R) of its swing's angle, and to where it began after as
// much.
BOOST_AUTO_TEST_CASE(a_ball_that_swings_into_a_wall_and_back_within_a_step_strikes_it) {
  const double dt = 1.0 / 30, frequency = 2 * std::numbers::pi / dt, R = 0.1, d = 0.05;
  Scene scene;
  scene.gravity = Vec3::Zero();
  scene.bodies = {solid("ball", Sphere{0.05}, {-R, 0, 0}), floor_at(-Vec3::UnitX(), -(d + 0.05))};
  scene.contact_default = {1, 0};
  scene.springs = {{.a = kWorld,
                    .b = 0,
                    .point_a = {-3, 0, 0},
                    .point_b = Vec3::Zero(),
                    .stiffness = frequency * frequency,
                    .damping = 0,
                    .rest_length = 3}};
  const double cycle = (2 * std::numbers::pi - 2 * std::acos(d / R)) / frequency;  // 2/3 of a step
  ContactRun run(scene, "event", "dormand-prince", {{"tolerance", "1e-13"}});
  for (int n = 1; n <= 10; ++n) {
    run.step(dt);
    const double t = std::remainder(n * dt, cycle);  // from the nearest instant at which it is furthest out
    // A thousand roundings and tolerances of 1e-13 m a step, at up to 19 m/s.
    BOOST_TEST(std::abs(run.state().position(0).x() + R * std::cos(frequency * t)) < 1e-8, n);
  }
  BOOST_TEST(run.solver_warning() == "");
}

// A rod that makes half a turn in a step, and lies at its end as at its start, sweeps a ball away on its way. The rod's
// side meets the ball where the ball's centre is both radii from the rod's axis, at s along it:
//   impulse = (1 + e) w s / (1/m_ball + 1/m_rod + s²/I).
BOOST_AUTO_TEST_CASE(a_rod_that_turns_by_half_a_turn_in_a_step_does_not_pass_through_a_ball) {
  const double dt = 1.0 / 30, w = std::numbers::pi / dt, r = 0.05, away = 0.9;
  Scene scene;
  scene.gravity = Vec3::Zero();
  scene.contact_default = {1, 0};
  scene.bodies = {solid("rod", Capsule{r, 2}, Vec3::Zero(), 3), solid("ball", Sphere{r}, {0, away, 0}, 0.5)};
  scene.bodies[0].orientation = Quat(std::sqrt(0.5), 0, std::sqrt(0.5), 0);  // its axis, z in B, along x
  scene.bodies[0].angular_velocity = {0, 0, w};
  const double s = std::sqrt(away * away - 4 * r * r), I = scene.bodies[0].inertia(0, 0);
  const double impulse = 2 * w * s / (1 / 0.5 + 1 / 3.0 + s * s / I);
  ContactRun run(scene, "event");
  run.step(dt);
  // The rod turns by a scheme of second order, which puts the blow elsewhere on the circle, not at another speed.
  BOOST_TEST(std::abs(run.state().velocity(1).norm() - impulse / 0.5) < 1e-6 * impulse / 0.5);
  BOOST_TEST((3 * run.state().velocity(0) + 0.5 * run.state().velocity(1)).norm() < 1e-9);
  BOOST_TEST(run.solver_warning() == "");
}

// The forces of a stack that leans feed back on themselves, the more the longer the step: parts of the step are taken.
BOOST_AUTO_TEST_CASE(a_stack_of_ten_boxes_stands_for_a_minute_and_settles_every_step) {
  std::vector<Body> boxes;
  for (int i = 0; i < 10; ++i)
    boxes.push_back(solid("box " + std::to_string(i), Box{{0.2, 0.2, 0.2}}, {0, 0, 0.1 + 0.2 * i}));
  ContactRun run(on_floor(boxes, {0, 0.5}), "event");
  run.run(1.0 / 30, 1800);
  // Velocities keep roundings of what a step's forces make of them, 1e-13 m/s and less; over a minute 1e-11 m.
  for (int i = 0; i < 10; ++i) BOOST_TEST((run.state().position(i) - boxes[i].position).norm() < 1e-10, i);
  BOOST_TEST(run.solver_warning() == "");
}

// 300 times the mass on top: sweeps from contact to contact do not settle, Newton's method in the velocities does.
BOOST_AUTO_TEST_CASE(heavy_stands_on_light) {
  std::vector<Body> boxes = {solid("low", Box{{1, 1, 1}}, {-0.55, 0, 0.5}),
                             solid("low too", Box{{1, 1, 1}}, {0.55, 0, 0.5}),
                             solid("heavy", Box{{1, 1, 1}}, {0, 0, 1.5}, 300)};
  ContactRun run(on_floor(boxes, {0, 0.5}), "event");
  run.run(1.0 / 30, 150);
  for (int i = 0; i < 3; ++i) BOOST_TEST((run.state().position(i) - boxes[i].position).norm() < 1e-10, i);
  BOOST_TEST(run.solver_warning() == "");
}

// A bounce on four corners that rocks from one to the other comes to rest too.
BOOST_AUTO_TEST_CASE(a_box_dropped_on_its_edge_comes_to_rest) {
  Body box = solid("box", Box{{0.4, 0.4, 0.4}}, {0, 0, 0.6}, 2);
  box.orientation = Quat(1, 0, 0.2679491924311227, 0).normalized();
  for (const double dt : {1.0 / 30, 1.0 / 240}) {
    ContactRun run(on_floor({box}, {0.5, 0.3}), "event");
    run.run(dt, steps_to(2.5, dt));
    BOOST_TEST(run.state().velocity(0).norm() < 1e-12, "velocity " << run.state().velocity(0).norm());
    const double off = std::abs(run.state().position(0).z() - 0.2);
    BOOST_TEST(off < 2e-10, "dt = " << dt << ": off by " << off);  // gaps of 1e-10 m count as closed
    BOOST_TEST(run.solver_warning() == "", dt);
  }
}

BOOST_AUTO_TEST_SUITE_END()
