// The truth by events against every closed form of the contact family, and what it refuses.
#include <algorithm>
#include <numbers>

#include "cases/case/case_reader.h"
#include "cases/runner/simulate.h"
#include "cases/truth/distance.h"
#include "core/base/error.h"
#include "core/scene/contact_laws.h"
#include "tests/cases/judged.h"
#include "tests/cases/suite/suite_checks.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_events)

namespace {

constexpr double kShort = 1;  // s: enough for impacts, stops and the end of slipping; many bodies roll on slowly

bool has_closed_form(const Case& c) {
  return anything_can_touch(c.scene) && c.truth != "none" && c.truth != "recording" && c.truth != "events" &&
         c.truth != "reference" && test::takes_contact_by_events(c.scene);
}

// A ball of 0.1 m, 1 m from a level hinge about z that it is as high as, and a wall that it touches where it hangs.
Scene ball_beside_wall() {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  Body ball = test::body("ball", 1, 0.004 * Vec3::Ones(), {-1, 0, 0});
  ball.shape = Sphere{0.1}, ball.collides = true;
  Body wall = test::body("wall", 1, Vec3::Ones(), Vec3::Zero());
  wall.shape = Plane{-Vec3::UnitX(), -0.1}, wall.fixed = wall.collides = true;
  scene.bodies = {ball, wall};
  scene.joints.push_back({.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}});
  return scene;
}

// An arm with products of inertia, a damper and a motor, and at its end a ball on a spring that strikes a tilted wall.
constexpr const char* kArmAtWall = R"(
title = "An arm strikes a wall"
[scene]
gravity = [0, -9.81, 0]
contact_default = { restitution = 0.6 }
[[scene.body]]
name = "arm"
mass = 1
inertia = [0.01, 0.1, 0.1, 0.002, 0.001, -0.003]
position = [0.5, 0, 0]
[[scene.body]]
name = "tip"
mass = 0.5
shape = { type = "sphere", radius = 0.1 }
position = [1.2, 0, 0]
[[scene.body]]
name = "wall"
shape = { type = "plane", normal = [0.2, 1, 0.1], offset = -0.8 }
[[scene.joint]]
name = "shoulder"
type = "hinge"
a = "world"
b = "arm"
anchor = [0, 0, 0]
axis = [0, 0, 1]
damping = 0.1
[[scene.joint]]
type = "ball"
a = "arm"
b = "tip"
anchor = [1, 0, 0]
[[scene.motor]]
joint = "shoulder"
torque = 2
from = 0.3
until = 0.5
[[scene.spring]]
a = "world"
point_a = [1, 1, 0]
b = "tip"
point_b = [0, 0.05, 0]
stiffness = 5
damping = 0.1
[[scene.force]]
body = "tip"
force = [0, 0, 0.4]
from = 0.1
until = 0.8
[run]
duration = 1.5
dt = ["1/1000", "1/4000"]
[truth]
kind = "events"
)";

// m: how far its bodies are from the truth's, at most.
double position_error(const Case& c, const std::string& run_name, double dt) {
  const RunName run = parse_run_name(run_name, infos_of(engines()));
  const auto truth = make_truth(c.truth, c.scene, c.duration);
  double largest = 0;
  for (const Sample& sample :
       simulate(find_engine(engines(), run.engine), run.settings, c.scene, dt, c.duration).trajectory.samples) {
    const BodyTable due = test::truth_at(*truth, sample.time, c.scene.bodies.size());
    for (std::size_t i = 0; i < c.scene.bodies.size(); ++i)
      largest = std::max(largest, (sample.bodies.columns().position(i) - due.columns().position(i)).norm());
  }
  return largest;
}

}  // namespace

// Engines that share nothing with it: of first order, 4.8e-3 m at 1/1000 s and 5.5e-4 m at 1/4000 s measured.
BOOST_AUTO_TEST_CASE(other_engines_come_to_it_among_joints) {
  const Case c = read_case_text(kArmAtWall, "arm.toml", "arm", test::words());
  BOOST_TEST(make_truth(c.truth, c.scene, c.duration)->error(c.duration) < 1e-8);
  for (const char* run : {"ode", "bullet:mlcp"}) {
    const double coarse = position_error(c, run, 1.0 / 1000), fine = position_error(c, run, 1.0 / 4000);
    BOOST_TEST(coarse < 6e-3, run << ": " << coarse);
    BOOST_TEST(fine < 7e-4, run << ": " << fine);
  }
}

BOOST_AUTO_TEST_CASE(its_error_bounds_the_distance_from_every_closed_form) {
  const std::vector<Case> cases = test::suite_cases(has_closed_form);
  BOOST_TEST_REQUIRE(!cases.empty());
  for (const Case& c : cases) {
    BOOST_TEST_CONTEXT(c.id) {
      const double duration = c.scene.bodies.size() > 20 ? std::min(c.duration, kShort) : c.duration;
      const auto events = make_truth("events", c.scene, duration), form = make_truth(c.truth, c.scene, duration);
      // The times that metrics need. One spring swings once in the longest step, which the first of the solutions
      // cannot follow.
      BOOST_TEST(events->error(duration) < (c.id == "contact/sprung-ball-in-step" ? 1e-5 : 1e-6));
      constexpr int kInstants = 101;
      for (int k = 0; k <= kInstants; ++k) {
        const double t = duration * k / kInstants;
        const BodyTable found = test::truth_at(*events, t, c.scene.bodies.size()),
                        expected = test::truth_at(*form, t, c.scene.bodies.size());
        const double off = distance_between(found.columns(), expected.columns());
        BOOST_TEST(off <= events->error(t) + form->error(t), "at " << t << " s it is off by " << off);
      }
    }
  }
}

// Between two nodes it is a cubic, or a step where something happens: neither leaves the path.
BOOST_AUTO_TEST_CASE(its_velocities_are_those_of_its_path) {
  const Case c = select_cases({"contact/bounce-backspin"}, default_suite_dir(), test::words()).at(0);
  const auto truth = make_truth("events", c.scene, c.duration);
  constexpr double kStep = 1e-5;  // s; a second difference of 10 m/s² leaves 1e-9 m/s of the middle's velocity
  int compared = 0;
  for (double t = 0.013; t < c.duration - kStep; t += 0.031) {
    const BodyTable low = test::truth_at(*truth, t - kStep, 2), middle = test::truth_at(*truth, t, 2),
                    high = test::truth_at(*truth, t + kStep, 2);
    const Vec3 rate = (high.columns().position(0) - low.columns().position(0)) / (2 * kStep);
    const double jump = (high.columns().velocity(0) - low.columns().velocity(0)).norm();
    if (jump > 1e-3) continue;  // an impact lies between
    BOOST_TEST((rate - middle.columns().velocity(0)).norm() < 1e-6);
    ++compared;
  }
  BOOST_TEST(compared > 50);
}

// The truth ends where the motion magnifies the difference of the solutions: a ball among pins forgets its origin.
BOOST_AUTO_TEST_CASE(its_horizon_ends_where_the_solutions_part) {
  Scene scene;
  scene.gravity = Vec3::Zero();
  scene.contact_default = {1, 0};
  for (int i = 0; i < 3; ++i) {
    Body pin = test::body("pin", 1, 0.1 * Vec3::Ones(), Vec3(std::cos(2.1 * i), std::sin(2.1 * i), 0) * 1.2);
    pin.name += std::to_string(i), pin.shape = Sphere{1}, pin.fixed = pin.collides = true;
    scene.bodies.push_back(pin);
  }
  Body ball = test::body("ball", 1, 0.001 * Vec3::Ones(), {0.03, 0.05, 0});
  ball.shape = Sphere{0.05}, ball.collides = true, ball.velocity = {1, 0.3, 0};
  scene.bodies.push_back(ball);
  const auto truth = make_truth("events", scene, 20);
  const double end = horizon(*truth, 1e-6, 20);
  BOOST_TEST(end > 0.5);
  BOOST_TEST(end < 20);
  for (double t = 0.1; t < 20; t += 0.1) BOOST_TEST(truth->error(t) >= truth->error(t - 0.1));
}

BOOST_AUTO_TEST_CASE(what_it_is_not_for_it_refuses_in_words) {
  BOOST_CHECK_EXCEPTION(make_truth("events", test::fixed_spring(), 1), InputError,
                        test::says("nothing can touch: take 'reference'"));
  // Of a hinge that may turn round and round before it comes to its one limit.
  Scene jointed = ball_beside_wall();
  jointed.joints[0].upper = 1;
  BOOST_CHECK_EXCEPTION(make_truth("events", jointed, 1), InputError, test::says("two limits within half a turn"));
}

// A pendulum that strikes a frictionless plane at its lowest point is compared with its limit there. A limit is a
// contact, too; the two scenes share nothing else.
BOOST_AUTO_TEST_CASE(a_limit_and_a_wall_at_one_place_are_one_motion) {
  Scene at_wall = ball_beside_wall(), at_limit = ball_beside_wall();
  at_limit.contact_default.restitution = at_wall.contact_default.restitution = 0.5;
  at_limit.bodies[1].shape = Plane{Vec3::UnitY(), -5};
  at_limit.joints[0].lower = -2, at_limit.joints[0].upper = 0.5 * std::numbers::pi;
  at_limit.joints[0].restitution = 0.5;
  constexpr double kEnd = 2;  // s: four blows
  const auto wall = make_truth("events", at_wall, kEnd), limit = make_truth("events", at_limit, kEnd);
  BOOST_TEST(wall->error(kEnd) < 1e-6);
  BOOST_TEST(limit->error(kEnd) < 1e-6);
  for (double t = 0; t <= kEnd; t += 0.037) {
    const BodyTable a = test::truth_at(*wall, t, 2), b = test::truth_at(*limit, t, 2);
    const double off = distance_between(a.columns(), b.columns());
    BOOST_TEST(off <= wall->error(t) + limit->error(t), "at " << t << " s it is off by " << off);
  }
}

// In these cases many points touch at once, and forces can be shared in many ways. Runs by contact=impulse miss their
// truth by 3e-4 to 2e-2 m, runs by contact=event must not.
BOOST_AUTO_TEST_CASE(runs_of_stacks_and_dominoes_agree_with_their_truth) {
  constexpr double kAgreed = 1e-8;  // m and rad
  for (const auto& [name, duration] :
       {std::pair("contact/corbel-arch", 5.0), {"contact/stack-of-ten", 5.0}, {"contact/domino-wave", 1.2}}) {
    const Scene scene = select_cases({name}, default_suite_dir(), test::words()).at(0).scene;
    const auto truth = make_truth("events", scene, duration);
    const Settings settings{"dormand-prince", {{"contact", "event"}}, {}};
    const Simulation run = simulate(engines().find("core"), settings, scene, 1.0 / 30, duration,
                                    {.steps_per_sample = 1, .is_timed = false});
    BOOST_TEST(!run.reduced_order.has_value());
    for (const Sample& sample : run.trajectory.samples) {
      const BodyTable due = test::truth_at(*truth, sample.time, scene.bodies.size());
      const double apart = distance_between(sample.bodies.columns(), due.columns());
      BOOST_TEST(apart <= truth->error(sample.time) + kAgreed, name << " at " << sample.time << " s: " << apart);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
