// The verdict "tunnelled" on motions made by hand, of which it is known whether a body went through another.
#include "cases/metrics/measures/contact/tunnelling.h"

#include <boost/test/unit_test.hpp>

#include "cases/metrics/verdict.h"
#include "tests/cases/scripted_engine.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_contact_tunnelling)

namespace {

constexpr double kDt = 1.0 / 30;

using Motion = std::function<void(double t, MutableBodyColumns bodies)>;

// Bodies stand where the scene puts them, unless the motion says otherwise.
Trajectory run_of(const Scene& scene, int steps, const Motion& motion) {
  test::Script script;
  script.play = [&](int step, MutableBodyColumns bodies) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      bodies.set_body(i, {body.position, body.orientation, body.velocity, body.angular_velocity});
    }
    motion(step * kDt, bodies);
  };
  return simulate(test::ScriptedEngine(script), {}, scene, kDt, steps * kDt).trajectory;
}

// A ball of 1 m and 2 kg at `speed` [m/s] against a wall of 1 cm, without gravity; `motion` gives its place along x.
Stability verdict_at_wall(double speed, const std::function<double(double t)>& place) {
  Scene scene;
  scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {place(0), 0, 0}),
                  test::on_its_own("wall", Box{{0.01, 9, 9}}, 1, {0, 0, 0})};
  scene.bodies[0].velocity = {speed, 0, 0}, scene.bodies[1].fixed = true;
  const Trajectory run = run_of(scene, 30, [&](double t, MutableBodyColumns bodies) {
    constexpr double kJustBefore = 1e-6;  // s
    bodies.set_position(0, {place(t), 0, 0});
    bodies.set_velocity(0, {(place(t) - place(t - kJustBefore)) / kJustBefore, 0, 0});
  });
  return verdict_on({scene, run, nullptr, 0});
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_goes_through_a_thin_wall_between_samples_or_slowly_has_tunnelled) {
  // 400 m/s is 13 m a sample: no sample sees the wall. 3 m/s is 0.1 m a sample, and ten of them do.
  for (const double speed : {400.0, 3.0}) {
    const Stability through = verdict_at_wall(speed, [=](double t) { return speed * (t - 0.51); });
    BOOST_TEST_CONTEXT(through.why) {
      BOOST_TEST(word_of(through.verdict) == "tunnelled");
      BOOST_TEST(through.body == 0);
      BOOST_TEST(through.time > 0.5);
      BOOST_TEST(through.why.find("'ball' has passed through 'wall'") != std::string::npos);
    }
  }
  const Stability fast = verdict_at_wall(400, [](double t) { return 400 * (t - 0.51); });
  BOOST_TEST(phrase_of(fast) == "tunnelled 0.53 s");
}

BOOST_AUTO_TEST_CASE(what_bounces_stays_or_sinks_in_and_comes_back_has_not_tunnelled) {
  for (const double speed : {400.0, 3.0}) {
    const auto bounces = [=](double t) { return -0.505 - speed * std::abs(t - 0.51); };
    const auto stays = [=](double t) { return -0.505 - speed * std::max(0.0, 0.51 - t); };
    BOOST_TEST(word_of(verdict_at_wall(speed, bounces).verdict) == "stable");
    BOOST_TEST(word_of(verdict_at_wall(speed, stays).verdict) == "stable");
  }
  // By 0.3 m, thirty times the wall's thickness, and out again.
  const Stability deep = verdict_at_wall(3, [](double t) { return -0.205 - 3 * std::abs(t - 0.5); });
  BOOST_TEST(word_of(deep.verdict) == "overlapping");
  BOOST_TEST(deep.why.find("passed through") == std::string::npos);
}

// Two thin plates that meet, both moving, and one that turns edge over edge beside the other.
BOOST_AUTO_TEST_CASE(of_two_thin_bodies_that_move_either_may_pass_the_other) {
  Scene scene;
  scene.bodies = {test::on_its_own("one", Box{{0.02, 1, 1}}, 1, {-1, 0, 0}),
                  test::on_its_own("other", Box{{0.02, 1, 1}}, 1, {1, 0.1, 0})};
  const auto verdict = [&](double beside, bool bounces) {
    const Trajectory run = run_of(scene, 60, [&](double t, MutableBodyColumns bodies) {
      const double way = 3.7 * (t - 0.5), speed = 3.7 * (bounces && way > 0 ? -1 : 1);
      const double place = bounces ? -std::abs(way) - 0.01 : way;
      bodies.set_position(0, {place, 0, 0}), bodies.set_velocity(0, {speed, 0, 0});
      bodies.set_position(1, {-place, beside, 0}), bodies.set_velocity(1, {-speed, 0, 0});
    });
    return word_of(verdict_on({scene, run, nullptr, 0}).verdict);
  };
  BOOST_TEST(verdict(0.1, false) == "tunnelled");
  BOOST_TEST(verdict(0.1, true) == "stable");
  BOOST_TEST(verdict(1.1, false) == "stable");  // beside each other
}

// A step of 1/4 s, in which a ball bounces off one wall and then another: the straight line between both samples leads
// through the first one, and the path did not.
BOOST_AUTO_TEST_CASE(a_path_that_is_not_known_is_no_passage) {
  Scene scene;
  scene.bodies = {test::on_its_own("ball", Sphere{0.1}, 2, {0, 0, 1}),
                  test::on_its_own("pin", Sphere{0.1}, 1, {0, 0, 0})};
  scene.bodies[1].fixed = true;
  Trajectory run{0.25, {}};
  const auto add = [&](double z, double x_speed) {
    BodyTable table(2);
    table.columns().set_body(0, {{0, 0, z}, Quat::Identity(), {x_speed, 0, -8}, Vec3::Zero()});
    table.columns().set_body(1, {{0, 0, 0}, Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
    run.samples.push_back({0.25 * static_cast<double>(run.samples.size()), table});
  };
  add(1, 0), add(-1, 5);  // deflected by 5 m/s on the way
  BOOST_TEST(verdict_on({scene, run, nullptr, 0}).why.find("passed through") == std::string::npos);
  run.samples.pop_back(), add(-1, 0);  // as it was: nothing stopped it
  BOOST_TEST(word_of(verdict_on({scene, run, nullptr, 0}).verdict) == "tunnelled");
}

BOOST_AUTO_TEST_CASE(what_goes_through_triangles_has_tunnelled) {
  const Mesh wall{{closed_surface(scaled(unit_cube(), Vec3(0.01, 9, 9)))}};
  Scene scene;
  scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {-5, 0, 0}), test::on_its_own("wall", wall, 1, {0, 0, 0})};
  scene.bodies[1].fixed = true;
  for (const double speed : {400.0, 30.0}) {
    for (const bool is_stopped : {false, true}) {
      scene.bodies[0].velocity = {speed, 0, 0};
      const Trajectory run = run_of(scene, 30, [&](double t, MutableBodyColumns bodies) {
        const double x = is_stopped ? std::min(-5 + speed * t, -0.505) : -5 + speed * t;
        bodies.set_position(0, {x, 0, 0}), bodies.set_velocity(0, {is_stopped && x > -0.6 ? 0 : speed, 0, 0});
      });
      BOOST_TEST((word_of(verdict_on({scene, run, nullptr, 0}).verdict) == "tunnelled") == !is_stopped, speed);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
